/* Console input of a port: a small buffer between its interrupt and hal_con_get(), which con_in.c implements. */
#ifndef FIELDLING_HAL_CON_IN_H
#define FIELDLING_HAL_CON_IN_H

#include "hal/hal.h"

/* An octet has come from the console; dropped when the buffer is full. isr. */
void con_in_isr(uint8_t octet);

#endif
