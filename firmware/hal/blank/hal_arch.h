/* Types of the empty port. */
#ifndef FIELDLING_HAL_ARCH_H
#define FIELDLING_HAL_ARCH_H

#include <stdint.h>

typedef uint16_t hal_dur_t; /* timer counts; wide enough for 255 T_bit at the slowest rate */

#endif
