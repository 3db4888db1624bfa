/* The 87C51FB in s51: characters take their time, and time is simulated. */
#ifndef CONTRACT_MACHINE_H
#define CONTRACT_MACHINE_H

#include "hal/mcs51/mcs51.h"

#define CONTRACT_UART_TIMED 1
#define CONTRACT_LOOP       1
#define CONTRACT_NV         1
#define CONTRACT_LATE_MS    1u
#define CONTRACT_LIMIT_MS   60u /* 16 bits of machine cycles: 65 ms */
/* s51 raises TI at the end of the character, the real part with its stop bit: what is written within that bit leaves
 * no gap there, and makes 200 characters at most 200 bits longer here. */
#define CONTRACT_TI_LATE_MS 20u
#define CONTRACT_BEGIN()    (hal_init(), hal_irq_restore(HAL_IRQ_ON))
#define CONTRACT_STEP()     hal_idle()
#define CONTRACT_SPEND()    (void)hal_ticks()

#endif
