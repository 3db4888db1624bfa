#include "telegram.h"

#include <string.h>

#define EXTENDED 0x80u

/* DA SA FC [DSAP SSAP] data: the part LE counts and FCS sums. */
static unsigned body(const struct tg *t, uint8_t *out)
{
    unsigned n = 3;
    out[0] = (uint8_t)(t->da | (t->dsap == TG_NO_SAP ? 0 : EXTENDED));
    out[1] = (uint8_t)(t->sa | (t->ssap == TG_NO_SAP ? 0 : EXTENDED));
    out[2] = t->fc;
    if (t->dsap != TG_NO_SAP)
        out[n++] = (uint8_t)t->dsap;
    if (t->ssap != TG_NO_SAP)
        out[n++] = (uint8_t)t->ssap;
    memcpy(out + n, t->data, t->n);
    return n + t->n;
}

static uint8_t fcs(const uint8_t *octets, unsigned n)
{
    unsigned sum = 0;
    for (unsigned i = 0; i < n; i++)
        sum += octets[i];
    return (uint8_t)(sum & 0xFF);
}

unsigned tg_encode(const struct tg *t, uint8_t out[TG_MAX])
{
    uint8_t text[TG_DATA_MAX + 5];
    if (t->sd == TG_SC || t->sd == TG_SD4) {
        out[0] = t->sd;
        out[1] = t->da;
        out[2] = t->sa;
        return t->sd == TG_SC ? 1 : 3;
    }
    const unsigned n = body(t, text);
    const unsigned sd = t->sd ? t->sd : n == 3 ? TG_SD1 : n == 11 ? TG_SD3 : TG_SD2;
    if (n > 249 || (sd == TG_SD1 && n != 3) || (sd == TG_SD3 && n != 11) || (sd == TG_SD2 && n < 4))
        return 0;
    unsigned at = 0;
    out[at++] = (uint8_t)sd;
    if (sd == TG_SD2) {
        out[at++] = (uint8_t)n;
        out[at++] = (uint8_t)n;
        out[at++] = TG_SD2;
    }
    memcpy(out + at, text, n);
    at += n;
    out[at++] = fcs(text, n);
    out[at++] = TG_ED;
    return at;
}

/* Where the body starts and how long it is, as far as the octets tell. */
static enum tg_verdict outline(const uint8_t *o, unsigned n, unsigned *start, unsigned *len)
{
    if (n == 0)
        return TG_SHORT;
    *start = 1;
    *len = o[0] == TG_SD1 ? 3 : 11;
    if (o[0] == TG_SD1 || o[0] == TG_SD3)
        return TG_GOOD;
    if (o[0] != TG_SD2)
        return TG_BAD;
    if (n < 4)
        return (n >= 3 && o[1] != o[2]) || (n >= 2 && (o[1] < 4 || o[1] > 249)) ? TG_BAD : TG_SHORT;
    *start = 4;
    *len = o[1];
    return o[1] != o[2] || o[1] < 4 || o[1] > 249 || o[3] != TG_SD2 ? TG_BAD : TG_GOOD;
}

static bool fields(const uint8_t *b, unsigned len, struct tg *t)
{
    unsigned at = 3;
    t->da = b[0] & 0x7F;
    t->sa = b[1] & 0x7F;
    t->fc = b[2];
    t->dsap = t->ssap = TG_NO_SAP;
    if (b[0] & EXTENDED)
        t->dsap = at < len ? b[at++] : -2;
    if (b[1] & EXTENDED)
        t->ssap = at < len ? b[at++] : -2;
    if (t->dsap == -2 || t->ssap == -2)
        return false;
    t->n = (uint8_t)(len - at);
    memcpy(t->data, b + at, t->n);
    return true;
}

enum tg_verdict tg_decode(const uint8_t *o, unsigned n, struct tg *t)
{
    unsigned start = 0, len = 0;
    memset(t, 0, sizeof *t);
    t->dsap = t->ssap = TG_NO_SAP;
    t->sd = n ? o[0] : 0;
    if (t->sd == TG_SC)
        return n == 1 ? TG_GOOD : TG_BAD;
    if (t->sd == TG_SD4) {
        if (n < 3)
            return TG_SHORT;
        t->da = o[1];
        t->sa = o[2];
        return n == 3 ? TG_GOOD : TG_BAD;
    }
    const enum tg_verdict v = outline(o, n, &start, &len);
    if (v != TG_GOOD)
        return v;
    if (n < start + len + 2)
        return TG_SHORT;
    if (n > start + len + 2 || o[n - 1] != TG_ED || o[n - 2] != fcs(o + start, len))
        return TG_BAD;
    return fields(o + start, len, t) ? TG_GOOD : TG_BAD;
}

bool tg_wants_answer(const struct tg *t)
{
    if (t->sd == TG_SC || t->sd == TG_SD4 || !(t->fc & TG_REQUEST) || t->da == 127)
        return false;
    const uint8_t function = t->fc & 0x0F;
    return function != TG_SDN_L && function != TG_SDN_H;
}
