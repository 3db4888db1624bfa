/* The values of a request, for callbacks. */
#include "modbus/mb.h"

uint16_t mb_span_get(uint16_t i)
{
    if (mb_span.table > MB_INPUTS)
        return get_u16be(mb_span.octets + 2u * i);
    return (mb_span.octets[i >> 3] >> (i & 7u)) & 1u;
}

void mb_span_put(uint16_t i, uint16_t value)
{
    const uint8_t bit = (uint8_t)(1u << (i & 7u));
    if (mb_span.table > MB_INPUTS)
        put_u16be(mb_span.octets + 2u * i, value);
    else if (value)
        mb_span.octets[i >> 3] |= bit;
    else
        mb_span.octets[i >> 3] &= (uint8_t)~bit;
}
