/* Types of the F2808 port. */
#ifndef FIELDLING_HAL_ARCH_H
#define FIELDLING_HAL_ARCH_H

#include <stdint.h>

typedef uint32_t hal_dur_t; /* clocks of the CPU: TIMER_HZ in uart.h */

#endif
