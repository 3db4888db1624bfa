/* The Modbus server with everything it has, for the empty port. */
#include "modbus/mb_all_functions.h"

#define MB_FUNCTIONS(ROW) MB_ALL_FUNCTIONS(ROW)
