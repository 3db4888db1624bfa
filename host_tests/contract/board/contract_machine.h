/* A board in QEMU: the transmitter takes no time, and the host may be busy. */
#ifndef CONTRACT_MACHINE_H
#define CONTRACT_MACHINE_H

#include "hal/hal.h"

#define CONTRACT_UART_TIMED 0
#define CONTRACT_LATE_MS    60u
#define CONTRACT_BEGIN()    (hal_init(), hal_irq_restore(HAL_IRQ_ON))
#define CONTRACT_STEP()     hal_idle()
#define CONTRACT_SPEND()    (void)hal_ticks()

#endif
