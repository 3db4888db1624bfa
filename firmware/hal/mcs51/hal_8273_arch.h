/* 8051: the 8273 is memory mapped at CHIP_ADDRESS of the board's wiring.h, its data registers (/TxDACK, /RxDACK) at 4
 * and 8 behind it. */
#ifndef FIELDLING_HAL_8273_ARCH_H
#define FIELDLING_HAL_8273_ARCH_H

#include "wiring.h"

static volatile __xdata uint8_t __at(CHIP_ADDRESS) hal_8273_registers[9];

#define hal_8273_read(reg)         (hal_8273_registers[reg])
#define hal_8273_write(reg, value) (hal_8273_registers[reg] = (value))

#endif
