/* The port in virtual time: exact. */
#ifndef CONTRACT_MACHINE_H
#define CONTRACT_MACHINE_H

#include "hal_virtual.h"

void contract_begin(void);

#define CONTRACT_UART_TIMED 1
#define CONTRACT_LOOP       1
#define CONTRACT_NV         1
#define CONTRACT_LATE_MS    0u
#define CONTRACT_BEGIN()    contract_begin()
#define CONTRACT_STEP()     hv_run_for(HV_MS / 10u)
#define CONTRACT_SPEND()    hv_spend(HV_MS / 10u)

#endif
