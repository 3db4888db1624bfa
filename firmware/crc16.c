/* Tables of crc16.h. The CRC is linear: an entry is the exclusive or of the entries of its single bits, so
 * the compiler works them out from eight (or four) constants. */
#include "crc16.h"

#define BIT(i, b, value) ((((i) >> (b)) & 1) ? (value) : 0)
#define ROW4(f, i)       f(i), f((i) + 1), f((i) + 2), f((i) + 3)
#define ROW16(f, i)      ROW4(f, i), ROW4(f, (i) + 4), ROW4(f, (i) + 8), ROW4(f, (i) + 12)

#if CRC16_ENTRIES >= 256

#define ROW64(f, i) ROW16(f, i), ROW16(f, (i) + 16), ROW16(f, (i) + 32), ROW16(f, (i) + 48)
#define ALL256(f)   ROW64(f, 0), ROW64(f, 64), ROW64(f, 128), ROW64(f, 192)

#define ENTRY(i)                                                                                             \
    (uint16_t)(BIT(i, 0, 0xC0C1) ^ BIT(i, 1, 0xC181) ^ BIT(i, 2, 0xC301) ^ BIT(i, 3, 0xC601) ^               \
               BIT(i, 4, 0xCC01) ^ BIT(i, 5, 0xD801) ^ BIT(i, 6, 0xF001) ^ BIT(i, 7, 0xA001))

#if CRC16_ENTRIES == 256

const uint16_t CODE crc16_octet[256] = {ALL256(ENTRY)};

#else

#define LOW(i)  (uint8_t)ENTRY(i)
#define HIGH(i) (uint8_t)(ENTRY(i) >> 8)

const uint8_t CODE crc16_low[256] = {ALL256(LOW)};
const uint8_t CODE crc16_high[256] = {ALL256(HIGH)};

#endif

#else

#define ENTRY(i) (uint16_t)(BIT(i, 0, 0xCC01) ^ BIT(i, 1, 0xD801) ^ BIT(i, 2, 0xF001) ^ BIT(i, 3, 0xA001))

const uint16_t CODE crc16_nibble[16] = {ROW16(ENTRY, 0)};

#endif
