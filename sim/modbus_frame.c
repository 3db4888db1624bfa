/* Modbus frames, the other side's way (modbus_frame.h). */
#include "sim/modbus_frame.h"

#include <string.h>

uint16_t mbc_crc(const uint8_t *octets, unsigned n)
{
    unsigned crc = 0xFFFF;
    while (n--) {
        crc ^= *octets++;
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1u ? (crc >> 1) ^ 0xA001u : crc >> 1;
    }
    return (uint16_t)crc;
}

uint8_t mbc_lrc(const uint8_t *octets, unsigned n)
{
    unsigned sum = 0;
    while (n--)
        sum += *octets++;
    return (uint8_t)(0x100u - (sum & 0xFFu));
}

static unsigned put_hex(uint8_t *to, uint8_t octet)
{
    static const char digits[] = "0123456789ABCDEF";
    to[0] = (uint8_t)digits[octet >> 4];
    to[1] = (uint8_t)digits[octet & 15];
    return 2;
}

unsigned mbc_frame(const struct mbc_coding *c, const uint8_t *body, unsigned n, uint16_t check_xor,
                   uint8_t *frame)
{
    unsigned out = 0;
    if (c->mode == MBC_RTU) {
        const unsigned crc = mbc_crc(body, n) ^ check_xor;
        memcpy(frame, body, n);
        frame[n] = (uint8_t)crc;
        frame[n + 1] = (uint8_t)(crc >> 8);
        return n + 2;
    }
    frame[out++] = ':';
    for (unsigned i = 0; i < n; i++)
        out += put_hex(frame + out, body[i]);
    out += put_hex(frame + out, (uint8_t)(mbc_lrc(body, n) ^ check_xor));
    frame[out++] = '\r';
    frame[out++] = c->delimiter;
    return out;
}

static int hex_value(uint8_t c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

unsigned mbc_unframe(const struct mbc_coding *c, const uint8_t *frame, unsigned n, uint8_t *body)
{
    unsigned out = 0;
    if (c->mode == MBC_RTU) {
        if (n < 4 || n > 256 || mbc_crc(frame, n - 2) != (frame[n - 2] | frame[n - 1] << 8))
            return 0;
        memcpy(body, frame, n - 2);
        return n - 2;
    }
    if (n < 9 || n > 513 || n % 2 == 0 || frame[0] != ':' || frame[n - 2] != '\r' ||
        frame[n - 1] != c->delimiter)
        return 0;
    for (unsigned i = 1; i < n - 2; i += 2) {
        const int high = hex_value(frame[i]), low = hex_value(frame[i + 1]);
        if (high < 0 || low < 0)
            return 0;
        body[out++] = (uint8_t)(high << 4 | low);
    }
    out--;
    return mbc_lrc(body, out) == body[out] ? out : 0;
}
