/* A station on the empty port: it links everywhere and does nothing. A new board starts from a copy. */
#include "board.h"
#include "ddlm/ddlm.h"
#include "dp_test01_app.h"
#include "hal/hal.h"

uint8_t board_input(uint8_t module)
{
    (void)module;
    return 0; /* read a port or a converter */
}

void board_output(uint8_t module, uint8_t value)
{
    (void)module; /* write a port */
    (void)value;
}

int main(void)
{
    hal_init();
    dp_test01_init(hal_switches(), DDLM_BAUD_AUTO);
    hal_irq_restore(HAL_IRQ_ON);
    for (;;) {
        dp_test01_poll();
        hal_wdog_kick();
        hal_idle();
    }
}
