/* Registers of the F2808: those of the model. */
#ifndef F2808_REG_H
#define F2808_REG_H

#include "sim/f2808_sci.h"

#define reg_get(address)        f2808_read((uint16_t)(address))
#define reg_set(address, value) f2808_write((uint16_t)(address), (uint16_t)(value))

#endif
