/* A Modbus server on the empty port, with the inverter behind it: it links everywhere and does nothing. */
#include "hal/hal.h"
#include "inverter.h"
#include "modbus/mb.h"

int main(void)
{
    hal_init();
    inv_init();
    mb_port.bit_per_s = 19200;
    mb_port.format = HAL_8E1;
    mb_port.mode = MB_RTU;
    mb_port.address = 1;
    mb_open();
    hal_irq_restore(HAL_IRQ_ON);
    for (;;) {
        mb_poll();
        inv_poll();
        hal_wdog_kick();
        hal_idle();
    }
}
