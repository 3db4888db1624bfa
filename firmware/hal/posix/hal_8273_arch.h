/* On a host the 8273 is a model (hal_8273_model.c). */
#ifndef FIELDLING_HAL_8273_ARCH_H
#define FIELDLING_HAL_8273_ARCH_H

#include <stdint.h>

uint8_t hal_8273_read(uint8_t reg);
void hal_8273_write(uint8_t reg, uint8_t value);

#endif
