/* DP-TEST01 for boards with a console: what its modules read and drive is seen and set there. */
#include "board.h"
#include "dp_console.h"
#include "dp_test01_app.h"
#include "ddlm/ddlm.h"
#include "hal/hal.h"

uint8_t board_input(uint8_t module)
{
    return dp_console_input(module);
}

void board_output(uint8_t module, uint8_t value)
{
    dp_console_output(module, value);
}

int main(void)
{
    hal_init();
    dp_test01_init(hal_switches(), DDLM_BAUD_AUTO);
    hal_irq_restore(HAL_IRQ_ON);
    for (;;) {
        dp_test01_poll();
        dp_console_poll();
        hal_wdog_kick();
        hal_idle();
    }
}
