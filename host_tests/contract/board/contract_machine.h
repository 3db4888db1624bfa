/* A board in QEMU: the transmitter takes no time; what its model lacks is said by the fragment that builds it. */
#ifndef CONTRACT_MACHINE_H
#define CONTRACT_MACHINE_H

#include "hal/hal.h"

#define CONTRACT_UART_TIMED 0
#define CONTRACT_LATE_MS    10u
#define CONTRACT_BEGIN()    (hal_init(), hal_irq_restore(HAL_IRQ_ON))
#define CONTRACT_STEP()     hal_idle()
#define CONTRACT_SPEND()    (void)hal_ticks()

#endif
