/* What a machine tells the contract test about itself, in a header "contract_machine.h" of its own:
 *
 *   CONTRACT_UART_TIMED  1: characters take their time on the line; 0: they are out at once, as in QEMU
 *   CONTRACT_LOOP, CONTRACT_NV  0 where a model, other than the real part, has no loop or cannot write its flash
 *   CONTRACT_LATE_MS     how late an upcall may be seen: 1 where time is simulated, much more where the host may be busy
 *   CONTRACT_LIMIT_MS    100, or less where hal_dur_t saturates before
 *   CONTRACT_TI_LATE_MS  0, or where a model says too late that a character is out: by how much in 200 characters
 *   CONTRACT_BEGIN()     first call of main(): hal_init() and interrupts on
 *   CONTRACT_STEP()      let time go by: hal_idle() where the machine runs by itself
 *   CONTRACT_SPEND()     the same in main code that does not sleep: hal_ticks()
 *
 * The line has a peer that sends back what it has heard, 30 ms or more after the last octet of it (the echo), and nothing
 * else. Runs on the host (virtual time), in s51, under QEMU and on the model of the F2808's SCI.
 */
#ifndef HAL_CONTRACT_H
#define HAL_CONTRACT_H

#include "contract_machine.h"
#include "hal/hal.h"
#include "unity.h"

#define CONTRACT_ECHO_MS 30u

#ifndef CONTRACT_LIMIT_MS
#define CONTRACT_LIMIT_MS 100u
#endif
#ifndef CONTRACT_TI_LATE_MS
#define CONTRACT_TI_LATE_MS 0u
#endif

#endif
