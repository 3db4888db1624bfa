/* The inverter's Modbus server: everything there is. */
#ifndef INVERTER_MB_H
#define INVERTER_MB_H

#include "modbus/mb_all_functions.h"

#define MB_FUNCTIONS(ROW) MB_ALL_FUNCTIONS(ROW)

#endif
