/* Everything: all functions, RTU and ASCII. */
#include "modbus/mb_all_functions.h"

#define MB_FUNCTIONS(ROW) MB_ALL_FUNCTIONS(ROW)
