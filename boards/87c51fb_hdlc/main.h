/* main() of a remote module; MODULE is its type (main_di.c, ...). */
#include "hal/hal.h"
#include "hal/mcs51/machine_8273.h" /* the vectors */
#include "remote_module.h"

void board_tick_isr(void) IN_ISR
{
    rm_tick_isr();
}

void main(void)
{
    hal_init();
    rm_init(MODULE, hal_switches(), 0);
    hal_irq_restore(HAL_IRQ_ON);
    for (;;) {
        rm_poll();
        hal_wdog_kick();
        hal_idle();
    }
}
