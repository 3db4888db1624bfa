/* The inverter's Modbus server: everything there is. All of the inverter lives in main: there is nothing to
 * lock. */
#ifndef INVERTER_MB_H
#define INVERTER_MB_H

#include "modbus/mb_all_functions.h"

#define MB_FUNCTIONS(ROW) MB_ALL_FUNCTIONS(ROW)
#ifndef MB_WITH_LUMPS /* 0 where the line is a wire and not a pty */
#define MB_WITH_LUMPS     1
#endif
#define MB_LOCK()         0u
#define MB_UNLOCK(state)  (void)(state)

#endif
