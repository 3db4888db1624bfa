/* PROFIBUS telegrams as the other side writes and reads them. Shares nothing with firmware/ on purpose: two
 * readings of the standard that agree are worth more than one used twice.
 *
 * Source: EN 50170-2 part 4, 4.7 (formats), 4.4 (FCS), 4.6 (FC and address octets); spec A3.
 */
#ifndef SIM_TELEGRAM_H
#define SIM_TELEGRAM_H

#include <stdbool.h>
#include <stdint.h>

#define TG_MAX      255 /* longest telegram: 6 + LE 249 */
#define TG_DATA_MAX 246
#define TG_NO_SAP   (-1)

/* Start delimiters. */
enum { TG_SD1 = 0x10, TG_SD2 = 0x68, TG_SD3 = 0xA2, TG_SD4 = 0xDC, TG_SC = 0xE5, TG_ED = 0x16 };

/* FC of a request is 0x40 + FCB + FCV + function; of an answer, the function alone (station type slave). */
enum { TG_REQUEST = 0x40, TG_FCB = 0x20, TG_FCV = 0x10 };
enum {
    TG_SDA_L = 3,
    TG_SDN_L = 4,
    TG_SDA_H = 5,
    TG_SDN_H = 6,
    TG_STATUS = 9,
    TG_SRD_L = 12,
    TG_SRD_H = 13,
    TG_IDENT = 14,
    TG_LSAP = 15
};
enum { TG_OK = 0, TG_UE = 1, TG_RR = 2, TG_RS = 3, TG_DL = 8, TG_NR = 9, TG_DH = 10 };

struct tg {
    uint8_t sd; /* set by tg_decode(); tg_encode() takes 0 as "the shortest that fits" (SD3 for 8 octets) */
    uint8_t da, sa; /* 0..127, without the extension bit */
    uint8_t fc;
    int16_t dsap, ssap; /* or TG_NO_SAP */
    uint8_t n;
    uint8_t data[TG_DATA_MAX];
};

enum tg_verdict { TG_GOOD, TG_SHORT /* more octets must follow */, TG_BAD };

/* Octets of the telegram. -> how many; 0 if it does not fit its format. */
unsigned tg_encode(const struct tg *t, uint8_t out[TG_MAX]);

/* What octets[0..n-1] are; t is filled when they are TG_GOOD. */
enum tg_verdict tg_decode(const uint8_t *octets, unsigned n, struct tg *t);

/* Does the telegram ask for an answer? SDN, tokens, answers and broadcasts do not. */
bool tg_wants_answer(const struct tg *t);

#endif
