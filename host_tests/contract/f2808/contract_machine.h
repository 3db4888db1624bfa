/* The port on the model of the F2808: simulated clocks. */
#ifndef CONTRACT_MACHINE_H
#define CONTRACT_MACHINE_H

#include "hal/hal.h"

void contract_begin(void);

#define CONTRACT_UART_TIMED 1
#define CONTRACT_LOOP       1
#define CONTRACT_NV         0
#define CONTRACT_LATE_MS    0u
#define CONTRACT_BEGIN()    contract_begin()
#define CONTRACT_STEP()     hal_idle()
#define CONTRACT_SPEND()    (void)hal_ticks()

#endif
