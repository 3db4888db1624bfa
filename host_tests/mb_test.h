/* The Modbus server of the unit tests: every function, and two user functions ([A] 5.1: 65..72, 100..110). */
#include "modbus/mb_all_functions.h"

#include "check.h"

uint8_t fixture_lock(void);
void fixture_unlock(uint8_t state);
#define MB_WITH_LUMPS    1
#define MB_LOCK()        fixture_lock()
#define MB_UNLOCK(state) fixture_unlock(state)

#define MB_FUNCTIONS(ROW)                                                                                    \
    MB_ALL_FUNCTIONS(ROW)                                                                                    \
    ROW(65, user_sum, 2, MB_COUNTED | MB_BROADCAST) /* octets: how many, then they; answer: their sum */     \
    ROW(110, user_busy, 1, MB_LEAST)                /* answers exception 06 */
