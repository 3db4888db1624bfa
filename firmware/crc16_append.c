/* crc16_append() for any processor. */
#include "crc16.h"

void crc16_append(uint8_t XDATA *octets, uint_fast8_t n)
{
    uint16_t crc = CRC16_START;
    do
        crc = crc16_add(crc, *octets++);
    while (--n);
    octets[0] = (uint8_t)crc;
    octets[1] = (uint8_t)(crc >> 8);
}
