/* Registers of the F2808: the memory itself. Both are one access of 16 bits. */
#ifndef F2808_REG_H
#define F2808_REG_H

#include <stdint.h>

#define reg_get(address)        (*(volatile uint16_t *)(uintptr_t)(address))
#define reg_set(address, value) ((void)(*(volatile uint16_t *)(uintptr_t)(address) = (uint16_t)(value)))

#endif
