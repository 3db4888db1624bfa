#include "sim/hdlc_bits.h"

#include <string.h>

uint16_t hb_crc_bit(uint16_t crc, unsigned bit)
{
    const bool out = ((crc ^ bit) & 1u) != 0;
    crc = (uint16_t)(crc >> 1);
    return out ? crc ^ 0x8408u : crc;
}

static uint16_t crc_of(const uint8_t *octets, unsigned n)
{
    uint16_t crc = 0xFFFF;
    for (unsigned i = 0; i < 8u * n; i++)
        crc = hb_crc_bit(crc, (octets[i / 8u] >> (i % 8u)) & 1u);
    return crc;
}

uint16_t hb_fcs(const uint8_t *octets, unsigned n)
{
    return (uint16_t)~crc_of(octets, n);
}

static void put(struct hb_line *line, unsigned bit)
{
    if (line->n < HB_BITS)
        line->bit[line->n++] = (uint8_t)bit;
}

void hb_raw(struct hb_line *line, uint32_t bits, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        put(line, (bits >> i) & 1u);
    line->ones = 0;
}

void hb_flag(struct hb_line *line)
{
    hb_raw(line, 0x7E, 8);
}

void hb_stuffed(struct hb_line *line, const uint8_t *octets, unsigned n)
{
    for (unsigned i = 0; i < 8u * n; i++) {
        const unsigned bit = (octets[i / 8u] >> (i % 8u)) & 1u;
        put(line, bit);
        line->ones = bit ? line->ones + 1u : 0;
        if (line->ones == 5u) {
            put(line, 0);
            line->inserted++;
            line->ones = 0;
        }
    }
}

void hb_frame(struct hb_line *line, const uint8_t *octets, unsigned n)
{
    const uint16_t fcs = hb_fcs(octets, n);
    const uint8_t tail[2] = {(uint8_t)fcs, (uint8_t)(fcs >> 8)};
    hb_flag(line);
    hb_stuffed(line, octets, n);
    hb_stuffed(line, tail, 2);
    hb_flag(line);
}

/* A flag is over. Its 0 and first five ones were taken for data: 6 bits too many. */
static enum hb_event close_frame(struct hb_decoder *d)
{
    const bool was_in_frame = d->in_frame;
    const unsigned bits = d->bits < 6u ? 0 : d->bits - 6u;
    d->in_frame = true;
    d->bits = 0;
    if (!was_in_frame || bits == 0)
        return HB_NOTHING;
    if (bits < 32u)
        return HB_SHORT;
    if (bits % 8u)
        return HB_UNALIGNED;
    d->n = bits / 8u - 2u;
    return crc_of(d->octets, bits / 8u) == HB_RESIDUE ? HB_FRAME : HB_BAD_FCS;
}

static enum hb_event one(struct hb_decoder *d)
{
    const bool inside = d->in_frame && d->bits > 5u; /* more than these ones since the flag */
    if (d->ones < 7u)
        return HB_NOTHING;
    d->in_frame = false;
    return d->ones == 7u && inside ? HB_ABORT : d->ones == 15u ? HB_IDLE : HB_NOTHING;
}

enum hb_event hb_decode(struct hb_decoder *d, unsigned bit)
{
    const unsigned ones = d->ones;
    d->ones = bit ? (ones < 15u ? ones + 1u : 16u) : 0;
    if (bit && d->ones > 5u)
        return one(d);
    if (!bit && ones == 6u)
        return close_frame(d);
    if (!bit && ones == 5u) /* an inserted zero */
        return HB_NOTHING;
    if (!d->in_frame)
        return HB_NOTHING;
    if (d->bits == 8u * (HB_OCTETS + 3u)) {
        d->in_frame = false;
        return HB_LONG;
    }
    if (d->bits % 8u == 0)
        d->octets[d->bits / 8u] = 0;
    d->octets[d->bits / 8u] |= (uint8_t)(bit << (d->bits % 8u));
    d->bits++;
    return HB_NOTHING;
}
