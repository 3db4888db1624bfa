/* Types of the RISC-V port. */
#ifndef FIELDLING_HAL_ARCH_H
#define FIELDLING_HAL_ARCH_H

#include <stdint.h>

typedef uint32_t hal_dur_t; /* counts of mtime: TIMER_HZ in uart.h */

#endif
