/* Types of the x86 port. */
#ifndef FIELDLING_HAL_ARCH_H
#define FIELDLING_HAL_ARCH_H

#include <stdint.h>

typedef uint32_t hal_dur_t; /* clocks of the 8254, 0.838 us */

#endif
