/* Types of the host port (real time and virtual time). */
#ifndef FIELDLING_HAL_ARCH_H
#define FIELDLING_HAL_ARCH_H

#include <stdint.h>

typedef uint32_t hal_dur_t; /* nanoseconds in real time, 1/576 us in virtual time */

#endif
