/* Octets -> frames. A burst is what comes without a silence that ends it; it may hold a request and its answer. */
#include "sim/mon.h"

#include <string.h>

#define BURST 2048u

struct mon_settings mon = {MON_DP, 500000, 0, false};

static struct mon_octet burst[BURST];
static unsigned burst_n;
static uint64_t last_end; /* [ns] of the frame before */
static unsigned long frames;

static unsigned char_bits(void)
{
    switch (mon.protocol) {
    case MON_PA:
    case MON_HDLC:
        return 8;
    case MON_MODBUS_ASCII:
        return 10;
    default:
        return 11;
    }
}

uint64_t mon_char(void)
{
    if (mon.untimed)
        return 0;
    return (char_bits() * 1000000000ULL + mon.rate / 2) / mon.rate;
}

double mon_tbit(uint64_t ns)
{
    return (double)ns * mon.rate / 1e9;
}

double mon_us(uint64_t ns)
{
    return (double)ns / 1e3;
}

/* The silence that ends a burst: T_SYN (EN 50170-2 part 4, 4.1.7); 3.5 characters of 11 bits, above 19200 bit/s
 * 1.75 ms (Modbus over serial line 2.5.1.1). PA and HDLC frames come one by one from modem or chip. */
static uint64_t gap(void)
{
    if (mon.gap)
        return mon.gap;
    if (mon.protocol == MON_MODBUS_RTU)
        return mon.rate > 19200 ? 1750000 : mon_char() * 7 / 2;
    if (mon.protocol == MON_MODBUS_ASCII)
        return 1000000000;
    return mon.protocol == MON_DP ? 33 * 1000000000ULL / mon.rate : mon_char() / 2;
}

/* ---- one DP telegram ---------------------------------------------------------------------------------- */

static unsigned expected(const uint8_t *o, unsigned n)
{
    switch (o[0]) {
    case TG_SD1:
        return 6;
    case TG_SD2:
        return n > 1 ? o[1] + 6u : 9;
    case TG_SD3:
        return 14;
    case TG_SD4:
        return 3;
    default:
        return 1;
    }
}

static void judge_sd2_head(const uint8_t *o, unsigned n, char *text, size_t size)
{
    if (n > 1 && (o[1] < 4 || o[1] > 249))
        snprintf(text, size, "LE is %u, allowed is 4 to 249", o[1]);
    else if (n > 2 && o[1] != o[2])
        snprintf(text, size, "LE %02X is not LEr %02X", o[1], o[2]);
    else if (n > 3 && o[3] != TG_SD2)
        snprintf(text, size, "second SD is %02X, not 68", o[3]);
}

static void judge_end(const uint8_t *o, unsigned n, char *text, size_t size)
{
    const unsigned start = o[0] == TG_SD2 ? 4 : 1;
    unsigned sum = 0;
    for (unsigned i = start; i < n - 2; i++)
        sum += o[i];
    if (o[n - 2] != (sum & 0xFF))
        snprintf(text, size, "FCS is %02X, right is %02X", o[n - 2], sum & 0xFF);
    else if (o[n - 1] != TG_ED)
        snprintf(text, size, "end delimiter is %02X, not 16", o[n - 1]);
}

void mon_judge_dp(const uint8_t *o, const uint8_t *err, unsigned n, char *text, size_t size)
{
    text[0] = '\0';
    for (unsigned i = 0; err && i < n && !text[0]; i++)
        if (err[i])
            snprintf(text, size, "%s error in octet %u", err[i] & MON_FRAMING ? "framing" : "parity", i + 1);
    if (text[0])
        return;
    if (o[0] != TG_SD1 && o[0] != TG_SD2 && o[0] != TG_SD3 && o[0] != TG_SD4 && o[0] != TG_SC) {
        snprintf(text, size, "%02X is no start delimiter", o[0]);
        return;
    }
    if (o[0] == TG_SD2)
        judge_sd2_head(o, n, text, size);
    if (text[0])
        return;
    if (n < expected(o, n))
        snprintf(text, size, "cut short: %u of %u octets", n, expected(o, n));
    else if (n > expected(o, n))
        snprintf(text, size, "%u octets more than the telegram has", n - expected(o, n));
    else if (o[0] != TG_SC && o[0] != TG_SD4)
        judge_end(o, n, text, size);
}

/* ---- bursts ------------------------------------------------------------------------------------------- */

/* No idle is allowed inside a telegram (EN 50170-2 part 4, 4.7). What comes in lumps (mon.gap set) cannot tell. */
static void judge_idle_inside(struct mon_frame *f, unsigned from)
{
    for (unsigned i = 1; i < f->n && !mon.gap && !f->wrong[0]; i++) {
        const uint64_t span = burst[from + i].start - burst[from + i - 1].start;
        if (mon_tbit(span) > 11 + 3)
            snprintf(f->wrong, sizeof f->wrong, "idle of %.0f T_bit before octet %u", mon_tbit(span) - 11,
                     i + 1);
    }
}

/* Octets [from, to) of the burst are a frame. */
static void give(unsigned from, unsigned to, mon_sink *sink)
{
    struct mon_frame f = {0};
    uint8_t err[MON_FRAME_MAX];
    f.n = to - from > MON_FRAME_MAX ? MON_FRAME_MAX : to - from;
    for (unsigned i = 0; i < f.n; i++) {
        f.octets[i] = burst[from + i].octet;
        err[i] = burst[from + i].err;
    }
    f.seq = frames++;
    f.start = burst[from].start;
    f.end = burst[to - 1].start + mon_char();
    f.idle = f.seq && f.start > last_end ? f.start - last_end : 0;
    last_end = f.end;
    if (mon.protocol == MON_DP) {
        mon_judge_dp(f.octets, err, f.n, f.wrong, sizeof f.wrong);
        judge_idle_inside(&f, from);
        f.good = !f.wrong[0] && tg_decode(f.octets, f.n, &f.tg) == TG_GOOD;
        if (!f.good && !f.wrong[0])
            snprintf(f.wrong, sizeof f.wrong, "no room for the SAPs that the addresses announce");
    } else {
        mon_judge_other(&f);
    }
    sink(&f);
}

/* Octets of a good telegram at burst[at]; 0: there is none; *short_ when it may still become one. */
static unsigned telegram_at(unsigned at, bool *short_)
{
    uint8_t o[TG_MAX];
    struct tg t;
    *short_ = false;
    for (unsigned n = 0; n < TG_MAX && at + n < burst_n;) {
        if (burst[at + n].err)
            return 0;
        o[n] = burst[at + n].octet;
        n++;
        const enum tg_verdict v = tg_decode(o, n, &t);
        if (v == TG_GOOD)
            return n;
        if (v == TG_BAD)
            return 0;
        *short_ = at + n == burst_n;
    }
    return 0;
}

/* Where the octets of a bad telegram end: at a silence longer than a character inside the burst, or where a good
 * telegram of SD1 to SD3 starts. Anything may look like a token or an acknowledge, so those do not count. */
static unsigned bad_until(unsigned at)
{
    bool unused;
    for (unsigned i = at + 1; i < burst_n; i++) {
        const uint8_t sd = burst[i].octet;
        if (burst[i].start > burst[i - 1].start + 2 * mon_char())
            return i;
        if ((sd == TG_SD1 || sd == TG_SD2 || sd == TG_SD3) && telegram_at(i, &unused))
            return i;
    }
    return burst_n;
}

static void forget(unsigned n)
{
    burst_n -= n;
    memmove(burst, burst + n, burst_n * sizeof burst[0]);
}

/* Give out what is whole; when the burst is over, all of it. */
static void take_dp(bool over, mon_sink *sink)
{
    unsigned at = 0;
    while (at < burst_n) {
        bool unfinished;
        const unsigned n = telegram_at(at, &unfinished);
        if (!over && (unfinished || n == 0))
            break;
        const unsigned to = n ? at + n : bad_until(at);
        give(at, to, sink);
        at = to;
    }
    forget(at);
}

static void take_ascii(bool over, mon_sink *sink)
{
    unsigned at = 0;
    for (unsigned i = 0; i < burst_n; i++)
        if (burst[i].octet == '\n' || (over && i + 1 == burst_n)) {
            give(at, i + 1, sink);
            at = i + 1;
        }
    forget(at);
}

static void take(bool over, mon_sink *sink)
{
    if (burst_n == 0)
        return;
    if (mon.protocol == MON_DP) {
        take_dp(over, sink);
    } else if (mon.protocol == MON_MODBUS_ASCII) {
        take_ascii(over, sink);
    } else if (over) {
        give(0, burst_n, sink);
        burst_n = 0;
    }
}

void mon_split(const struct mon_octet *o, mon_sink *sink)
{
    if (burst_n)
        mon_split_idle(o->start, sink);
    if (burst_n == BURST)
        take(true, sink);
    burst[burst_n++] = *o;
    take(false, sink);
}

void mon_split_idle(uint64_t now, mon_sink *sink)
{
    if (burst_n && now >= burst[burst_n - 1].start + mon_char() + gap())
        take(true, sink);
}

void mon_split_end(mon_sink *sink)
{
    take(true, sink);
}
