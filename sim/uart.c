#include "uart.h"

void uart_levels(uint8_t octet, uint8_t level[11])
{
    uint8_t parity = 0;
    level[0] = 0;
    for (unsigned i = 0; i < 8; i++) {
        level[1 + i] = (octet >> i) & 1u;
        parity ^= level[1 + i];
    }
    level[9] = parity;
    level[10] = 1;
}

static uint8_t level_at(const struct uart_wave *w, uint64_t t)
{
    const uint64_t i = t / w->bit;
    return i < w->n ? w->level[i] : 1;
}

/* The next time from `t` on at which the line is at `level`; false: not before the wave ends. */
static bool next_level(const struct uart_wave *w, uint8_t level, uint64_t *t)
{
    if (level_at(w, *t) == level)
        return true;
    for (uint64_t i = *t / w->bit + 1; i < w->n; i++)
        if (w->level[i] == level) {
            *t = i * w->bit;
            return true;
        }
    return false;
}

bool uart_next(const struct uart_wave *w, uint64_t from, uint64_t rx_bit, struct uart_octet *o)
{
    uint64_t t = from;
    for (;;) {
        if (t / w->bit >= w->n || !next_level(w, 0, &t))
            return false;
        if (level_at(w, t + rx_bit / 2) == 0)
            break;
        t += rx_bit / 2; /* a spike, not a start bit */
    }
    uint8_t parity = 0;
    o->octet = 0;
    for (unsigned i = 0; i < 8; i++) {
        const uint8_t bit = level_at(w, t + rx_bit / 2 + (1 + i) * rx_bit);
        o->octet = (uint8_t)(o->octet | bit << i);
        parity ^= bit;
    }
    o->parity_error = level_at(w, t + rx_bit / 2 + 9 * rx_bit) != parity;
    o->framing_error = level_at(w, t + rx_bit / 2 + 10 * rx_bit) == 0;
    o->end = t + 11 * rx_bit;
    o->resume = t + rx_bit / 2 + 10 * rx_bit;
    if (o->framing_error && !next_level(w, 1, &o->resume))
        o->resume = w->n * w->bit;
    return true;
}
