/* DP-TEST01 on an 8052 core: no console, the one serial port is the line. */
#include "hal/hal.h"
#include "hal/mcs51/mcs51.h" /* the vectors */
#include "ddlm/ddlm.h"
#include "dp_test01_app.h"

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
