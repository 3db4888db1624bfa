#include "fdl/pa_frame.h"
#include "bytes.h"

#define CRC_START 0xFFFFu
#define CRC_LEN   2u
#define HEADER    4u /* SDL2 LE LEr SDL2 */
#define LE_MIN    4u

/* i(x) * x^16 mod 1DCFH for the sixteen values of half an octet. */
static const uint16_t CODE nibble[16] = {
    0x0000, 0x1DCF, 0x3B9E, 0x2651, 0x773C, 0x6AF3, 0x4CA2, 0x516D,
    0xEE78, 0xF3B7, 0xD5E6, 0xC829, 0x9944, 0x848B, 0xA2DA, 0xBF15,
};

uint16_t pa_crc_add(uint16_t crc, uint8_t octet)
{
    crc = (uint16_t)((crc << 4) ^ nibble[((crc >> 12) ^ (octet >> 4)) & 0x0Fu]);
    return (uint16_t)((crc << 4) ^ nibble[((crc >> 12) ^ octet) & 0x0Fu]);
}

static uint16_t crc_of(const uint8_t XDATA *octets, uint16_t n)
{
    uint16_t crc = CRC_START;

    while (n--)
        crc = pa_crc_add(crc, *octets++);
    return crc;
}

/* Is len a body length of that format? */
static bool suits(uint8_t sdl, uint8_t len)
{
    switch (sdl) {
    case PA_SDL1:
        return len == 3;
    case PA_SDL2:
        return len >= LE_MIN && len <= PA_BODY_MAX;
    case PA_SDL3:
        return len == 11;
    case PA_SDL4:
        return len == 2;
    case PA_SDL5:
        return len == 0;
    default:
        return false;
    }
}

uint8_t pa_body_at(uint8_t sdl)
{
    return sdl == PA_SDL2 ? HEADER : 1;
}

uint8_t pa_encode(uint8_t sdl, const uint8_t XDATA *body, uint8_t len, uint8_t XDATA *frame)
{
    uint8_t at = pa_body_at(sdl);
    uint8_t i;

    if (!suits(sdl, len))
        return 0;
    frame[0] = sdl;
    if (sdl == PA_SDL2) {
        frame[1] = len;
        frame[2] = len;
        frame[3] = sdl;
    }
    for (i = 0; i < len; i++)
        frame[at++] = body[i];
    put_u16be(frame + at, (uint16_t)~crc_of(frame, at));
    return (uint8_t)(at + CRC_LEN);
}

uint8_t pa_decode(const uint8_t XDATA *frame, uint16_t n, uint8_t XDATA *body_len)
{
    uint8_t sdl, around;

    if (n == 0)
        return PA_BAD_LENGTH;
    sdl = frame[0];
    around = (uint8_t)(pa_body_at(sdl) + CRC_LEN);
    if (sdl != PA_SDL1 && sdl != PA_SDL2 && sdl != PA_SDL3 && sdl != PA_SDL4 && sdl != PA_SDL5)
        return PA_BAD_SDL;
    if (n < around || n > PA_FRAME_MAX || !suits(sdl, (uint8_t)(n - around)))
        return PA_BAD_LENGTH;
    if (sdl == PA_SDL2 && (frame[1] != frame[2] || frame[3] != sdl || frame[1] != n - around))
        return PA_BAD_LENGTH;
    if (crc_of(frame, n) != PA_RESIDUE)
        return PA_BAD_CRC;
    *body_len = (uint8_t)(n - around);
    return PA_GOOD;
}
