/* Octet order in one place. PROFIBUS and Modbus send the high octet of a 16-bit value first. */
#ifndef FIELDLING_BYTES_H
#define FIELDLING_BYTES_H

#include "check.h"

static inline uint16_t get_u16be(const uint8_t XDATA *p)
{
    return (uint16_t)(p[0] * 256u + p[1]);
}

static inline void put_u16be(uint8_t XDATA *p, uint16_t value)
{
    p[0] = (uint8_t)(value >> 8);
    p[1] = (uint8_t)value;
}

#endif
