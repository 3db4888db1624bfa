/* 8051: durations are machine cycles (12 clocks), counted by the 16 bits of Timer 0. */
#ifndef FIELDLING_HAL_ARCH_H
#define FIELDLING_HAL_ARCH_H

#include <stdint.h>

typedef uint16_t hal_dur_t;

#endif
