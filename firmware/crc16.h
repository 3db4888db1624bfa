/* CRC-16 of Modbus: polynomial A001H (reflected 8005H), start FFFFH, low octet sent first. Over a whole good
 * frame, its CRC included, it is 0. Source: Modbus over serial line V1.02, 2.5.1.2 and 6.2.2.
 *
 * One function, three shapes: CRC16_ENTRIES 256 (512 octets of table, for speed; the default), 512 (the same
 * in two tables of octets, for 8-bit processors that keep the low octet first) or 16 (32 octets). It is inline
 * because main and interrupts both need it, and on an 8051 no function may serve both.
 */
#ifndef FIELDLING_CRC16_H
#define FIELDLING_CRC16_H

#include "check.h"

#ifndef CRC16_ENTRIES
#define CRC16_ENTRIES 256
#endif

#define CRC16_START 0xFFFFu

#if CRC16_ENTRIES == 256

extern const uint16_t CODE crc16_octet[256];

/* The CRC after one more octet. Any context. */
static inline uint16_t crc16_add(uint16_t crc, uint8_t octet)
{
    return (uint16_t)((crc >> 8) ^ crc16_octet[(uint8_t)(crc ^ octet)]);
}

#elif CRC16_ENTRIES == 512

extern const uint8_t CODE crc16_low[256], crc16_high[256];

static inline uint16_t crc16_add(uint16_t crc, uint8_t octet)
{
    octet ^= (uint8_t)crc;
    return (uint16_t)((uint16_t)crc16_high[octet] << 8 | (crc16_low[octet] ^ (uint8_t)(crc >> 8)));
}

#elif CRC16_ENTRIES == 16

extern const uint16_t CODE crc16_nibble[16];

static inline uint16_t crc16_add(uint16_t crc, uint8_t octet)
{
    crc ^= octet;
    crc = (uint16_t)((crc >> 4) ^ crc16_nibble[crc & 15u]);
    return (uint16_t)((crc >> 4) ^ crc16_nibble[crc & 15u]);
}

#else
#error "CRC16_ENTRIES is 16, 256 or 512"
#endif

/* Put the CRC of octets[0..n-1], n = 1..255, behind them. In its own file, which a port may replace. main. */
void crc16_append(uint8_t XDATA *octets, uint_fast8_t n);

/* One more octet into a CRC that is kept in fast memory. Any context. */
static inline void crc16_take(uint16_t HOT *crc, uint8_t octet)
{
#if CRC16_ENTRIES == 512
    uint8_t HOT *const half = (uint8_t HOT *)crc; /* low, high */
    octet = (uint8_t)(octet ^ half[0]);
    half[0] = (uint8_t)(crc16_low[octet] ^ half[1]);
    half[1] = crc16_high[octet];
#else
    *crc = crc16_add(*crc, octet);
#endif
}

#endif
