/* The empty port's 8273: nine octets of memory. A real memory mapped chip differs by its address only. */
#ifndef FIELDLING_HAL_8273_ARCH_H
#define FIELDLING_HAL_8273_ARCH_H

#include "check.h"

extern volatile uint8_t XDATA hal_8273_registers[9];

static inline uint8_t hal_8273_read(uint8_t reg)
{
    return hal_8273_registers[reg];
}

static inline void hal_8273_write(uint8_t reg, uint8_t value)
{
    hal_8273_registers[reg] = value;
}

#endif
