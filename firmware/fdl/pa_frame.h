/* PROFIBUS-PA frames (MBP, 31.25 kbit/s, IEC 61158-2): the octets between start and end delimiter of the line.
 *
 * The information field [DA SA FC ...] is that of DP; what differs is the protection: no start, stop and parity bit
 * around an octet, and a 16-bit CRC instead of FCS and ED.
 *
 *   SDL1  10 DA SA FC CRC CRC                      SDL4  DC DA SA CRC CRC   token
 *   SDL2  68 LE LEr 68 DA SA FC ... CRC CRC        SDL5  E5 CRC CRC         short acknowledge
 *   SDL3  A2 DA SA FC 8 data octets CRC CRC
 *
 * CRC: x^16+x^12+x^11+x^10+x^8+x^7+x^6+x^3+x^2+x+1 (1DCFH), start FFFFH, sent inverted, high octet first. Over a
 * whole good frame the register ends at E394H. Source: facts, section 6; spec D3.
 * our choice: the CRC covers everything from the SDL on. The clause that says so (EN 50170-2 part 9) was not at
 * hand; the short acknowledge has nothing else to cover, and only so are SDL, LE and LEr protected, which have no
 * parity bits here.
 *
 * Coding, preamble and delimiters of the line are the modem's. Context: any, one at a time (no state is kept).
 */
#ifndef FIELDLING_PA_FRAME_H
#define FIELDLING_PA_FRAME_H

#include "check.h"

enum pa_sdl { PA_SDL1 = 0x10, PA_SDL2 = 0x68, PA_SDL3 = 0xA2, PA_SDL4 = 0xDC, PA_SDL5 = 0xE5 };

#define PA_BODY_MAX  249u /* DA SA FC + 246 octets */
#define PA_FRAME_MAX (PA_BODY_MAX + 6u)
#define PA_RESIDUE   0xE394u

enum pa_verdict {
    PA_GOOD,
    PA_BAD_SDL,    /* none of the five delimiters                                        */
    PA_BAD_LENGTH, /* LE != LEr, LE not 4..249, second SDL2 missing, too few or many octets */
    PA_BAD_CRC,
};

/* Encode body[0..len-1], from DA on, into frame[0..PA_FRAME_MAX-1]. len: 3 for SDL1, 4..249 for SDL2, 11 for SDL3,
 * 2 for SDL4, 0 for SDL5. -> octets of the frame, 0: len does not suit sdl, or no such sdl. */
uint8_t pa_encode(uint8_t sdl, const uint8_t XDATA *body, uint8_t len, uint8_t XDATA *frame);

/* Judge frame[0..n-1]: one whole frame as the modem delimits it. -> enum pa_verdict. When PA_GOOD, the body is
 * frame[pa_body_at(frame[0])...], *body_len octets; nothing is written otherwise. */
uint8_t pa_decode(const uint8_t XDATA *frame, uint16_t n, uint8_t XDATA *body_len);
uint8_t pa_body_at(uint8_t sdl);

/* The register after one more octet; start with FFFFH. */
uint16_t pa_crc_add(uint16_t crc, uint8_t octet);

#endif
