/* DP-TEST01 on the 87C51FB. */
#include "hal/hal.h"
#include "hal/mcs51/mcs51.h" /* the vectors */
#include "board.h"
#include "ddlm/ddlm.h"
#include "dp_test01_app.h"

static volatile XDATA uint8_t __at(IO_ADDRESS) io[2];

uint8_t board_input(uint8_t module)
{
    return io[module >> 1];
}

void board_output(uint8_t module, uint8_t value)
{
    io[module >> 1] = value;
}

void main(void)
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
