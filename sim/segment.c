#include "sim/segment.h"

#include <stdio.h>
#include <string.h>

#define KEPT 16u

static struct {
    hv_time bit;
    uint8_t address;
    unsigned min_t_sdr, max_t_sdr;
    struct seg_party *parties;
    struct seg_party station;
    hv_time quiet_since;
    bool ever;          /* something has been on the line */
    bool asked;         /* the last telegram was a good request that wants an answer */
    bool asked_station; /* ... from the station */
    bool driver;
    unsigned count[SEG_RULES];
    struct seg_violation kept[KEPT];
    unsigned kept_n, told;
} seg;

struct seg_said seg_said;
void (*seg_trace)(const char *who, hv_time start, const uint8_t *octets, unsigned n);

static const char *const rule_text[SEG_RULES] = {
    "collision",
    "answered earlier than min_T_SDR",
    "answered later than max_T_SDR",
    "request without T_SYN",
    "gap inside a telegram",
    "driver on without a telegram",
    "spoke without being asked",
    "malformed telegram",
};

static void violation(enum seg_rule rule, const struct seg_party *p, hv_time ticks)
{
    if (!p->judged)
        return;
    seg.count[rule]++;
    if (seg.kept_n < KEPT)
        seg.kept[seg.kept_n++] = (struct seg_violation){rule, p->name, hv_now(), ticks / seg.bit};
}

/* ---- the judge ---------------------------------------------------------------------------------------- */

static void judge_answer_time(const struct seg_party *p)
{
    if (p->idle_before < seg.min_t_sdr * seg.bit)
        violation(SEG_EARLY, p, p->idle_before);
    if (p->idle_before > seg.max_t_sdr * seg.bit)
        violation(SEG_LATE, p, p->idle_before);
}

static void judge_first_octet(struct seg_party *p)
{
    const hv_time now = hv_now();
    p->idle_before = !seg.ever ? HV_S : now < seg.quiet_since ? 0 : now - seg.quiet_since;
    p->asked = seg.asked;
    p->frame_start = now;
    if (p != &seg.station)
        return;
    seg_said.start = now;
    seg_said.t_sdr = p->idle_before;
    if (!seg.asked_station)
        violation(SEG_UNASKED, p, p->idle_before);
    else
        judge_answer_time(p);
}

static void judge_telegram(struct seg_party *p, const struct tg *t)
{
    const bool answer = t->sd == TG_SC || (t->sd != TG_SD4 && !(t->fc & TG_REQUEST));
    if (!answer && p->idle_before < 33 * seg.bit)
        violation(SEG_NO_SYN, p, p->idle_before);
    if (answer && p != &seg.station && p->asked)
        judge_answer_time(p);
    if (!answer && p == &seg.station)
        violation(SEG_UNASKED, p, p->idle_before);
    seg.asked = tg_wants_answer(t);
    seg.asked_station = seg.asked && t->da == seg.address;
}

static void frame_done(struct seg_party *p)
{
    if (seg_trace)
        seg_trace(p->name, p->frame_start, p->frame, p->n);
    if (p == &seg.station) {
        memcpy(seg_said.octets, p->frame, p->n);
        seg_said.n = p->n;
        seg_said.end = hv_now();
        seg_said.telegrams++;
    }
    p->n = 0;
}

static void judge_octet(struct seg_party *p, uint8_t octet, uint8_t err)
{
    struct tg t;
    p->frame[p->n++] = octet;
    const enum tg_verdict v = err ? TG_BAD : tg_decode(p->frame, p->n, &t);
    if (v == TG_SHORT && p->n <= TG_MAX)
        return;
    if (v == TG_GOOD) {
        judge_telegram(p, &t);
    } else {
        violation(SEG_MALFORMED, p, 0);
        seg.asked = seg.asked_station = false;
    }
    frame_done(p);
}

/* Before the next octet of p: is it one telegram without a gap? */
static void judge_gap(struct seg_party *p)
{
    const hv_time now = hv_now();
    if (p->n == 0 || now == p->char_end)
        return;
    violation(SEG_GAP, p, now - p->char_end);
    if (now - p->char_end >= 33 * seg.bit)
        frame_done(p); /* cut short; a new one starts */
}

/* ---- levels: a wrong rate, or a test that writes them ------------------------------------------------- */

static void hear(void *party, uint32_t wave);

/* Look for the next start bit that the station's receiver sees. */
static void listen(struct seg_party *p)
{
    struct uart_octet o;
    p->rx_bit = hv_bit();
    p->hearing = p->rx_bit && uart_next(&p->wave, p->resume, p->rx_bit, &o);
    if (p->hearing)
        hv_at(p->wave_start + o.end, hear, p, p->waves);
    else
        p->resume = p->wave.n * p->wave.bit;
}

/* A character is over at the station's receiver. */
static void hear(void *party, uint32_t wave)
{
    struct seg_party *const p = party;
    struct uart_octet o;
    if (wave != p->waves)
        return;                  /* the talker changed its rate meanwhile */
    if (p->rx_bit != hv_bit()) { /* re-opened meanwhile: listens from here */
        p->resume = hv_now() - p->wave_start;
    } else if (uart_next(&p->wave, p->resume, p->rx_bit, &o)) {
        p->resume = o.resume;
        hv_receive(o.octet, (uint8_t)((o.parity_error ? HAL_ERR_PARITY : 0u) |
                                      (o.framing_error ? HAL_ERR_FRAMING : 0u)));
    }
    listen(p);
}

/* Levels heard are forgotten when room is needed: a receiver at 9600 bit/s takes 13750 levels of a talker at
 * 12 Mbit/s for one character. */
static void make_room(struct seg_party *p, hv_time n)
{
    if (p->wave.n + n <= SEG_LEVELS)
        return;
    const unsigned heard = (unsigned)(p->resume / p->bit);
    p->wave.n -= heard;
    p->wave_start += heard * p->bit;
    p->resume -= heard * p->bit;
    memmove(p->level, p->level + heard, p->wave.n);
    if (p->wave.n + n > SEG_LEVELS)
        hv_on_failure("segment: no room for levels");
}

static void add_levels(struct seg_party *p, const uint8_t *level, unsigned n)
{
    if (!p->hearing || p->wave.bit != p->bit) {
        p->waves++;
        p->hearing = false;
        p->wave = (struct uart_wave){p->level, 0, p->bit};
        p->wave_start = hv_now();
        p->resume = 0;
    }
    const hv_time idle = (hv_now() - p->wave_start) / p->bit - p->wave.n;
    make_room(p, idle + n);
    memset(p->level + p->wave.n, 1, (size_t)idle);
    p->wave.n += (unsigned)idle;
    memcpy(p->level + p->wave.n, level, n);
    p->wave.n += n;
    if (!p->hearing)
        listen(p);
}

/* ---- characters --------------------------------------------------------------------------------------- */

static void collide(struct seg_party *p)
{
    for (struct seg_party *q = seg.parties; q; q = q->next) {
        if (q == p || !(q->pending || (q == &seg.station && seg.driver)))
            continue;
        p->spoilt = q->spoilt = true;
        violation(SEG_COLLISION, p, 0);
        violation(SEG_COLLISION, q, 0);
    }
}

/* The character on its way is over, if its time has come. */
static void finish(struct seg_party *p)
{
    if (!p->pending || p->char_end != hv_now())
        return;
    const uint8_t err = p->spoilt ? HAL_ERR_PARITY | HAL_ERR_FRAMING : p->err;
    p->pending = p->spoilt = false;
    seg.quiet_since = hv_now();
    seg.ever = true;
    judge_octet(p, p->octet, err);
    for (struct seg_party *q = seg.parties; q; q = q->next)
        if (q != p && q->hears)
            q->hears(q, p->octet, err);
    if (p != &seg.station && !p->by_level)
        hv_receive(p->octet, err);
}

static void char_end(void *party, uint32_t unused)
{
    (void)unused;
    finish(party);
}

static void char_start(struct seg_party *p, uint8_t octet, uint8_t err, hv_time end)
{
    uint8_t level[11];
    for (struct seg_party *q = seg.parties; q; q = q->next)
        finish(q);
    collide(p);
    judge_gap(p);
    if (p->n == 0)
        judge_first_octet(p);
    p->octet = octet;
    p->err = err;
    p->pending = true;
    p->char_end = end;
    p->by_level = p != &seg.station && (p->hearing || p->bit != hv_bit());
    if (p->by_level) {
        uart_levels(octet, level);
        level[9] ^= (err & HAL_ERR_PARITY) != 0;
        level[10] ^= (err & HAL_ERR_FRAMING) != 0;
        add_levels(p, level, sizeof level);
    }
    hv_at(end, char_end, p, 0);
}

static void party_char(void *party, uint32_t value)
{
    struct seg_party *const p = party;
    finish(p);
    if (p->pending)
        hv_on_failure("segment: a party talks over itself");
    char_start(p, (uint8_t)value, (uint8_t)(value >> 8), hv_now() + 11 * p->bit);
}

/* ---- the station -------------------------------------------------------------------------------------- */

static void station_octet(uint8_t octet, hv_time start, hv_time end)
{
    seg.station.bit = (end - start) / 11;
    char_start(&seg.station, octet, 0, end);
}

static void station_driver(bool on)
{
    struct seg_party *const p = &seg.station;
    finish(p);
    seg.driver = on;
    if (on) {
        collide(p);
    } else if (p->pending) { /* in the middle of a character */
        p->pending = false;
        p->n = 0;
        violation(SEG_MALFORMED, p, 0);
    } else if (hv_now() > p->char_end) {
        violation(SEG_DRIVER, p, hv_now() - p->char_end);
    }
}

const struct hv_wire seg_wire = {station_octet, station_driver};

/* ---- the test's side ---------------------------------------------------------------------------------- */

void seg_send(struct seg_party *from, hv_time t, const uint8_t *octets, unsigned n, const uint8_t *err)
{
    if (t < hv_now())
        t = hv_now();
    for (unsigned i = 0; i < n; i++)
        hv_at(t + i * 11 * from->bit, party_char, from,
              (uint32_t)octets[i] | (err ? (uint32_t)err[i] << 8 : 0));
}

void seg_send_levels(struct seg_party *from, const uint8_t *level, unsigned n)
{
    add_levels(from, level, n);
    seg.quiet_since = hv_now() + n * from->bit;
    seg.asked = seg.asked_station = false;
}

void seg_attach(struct seg_party *party)
{
    if (!party->bit)
        party->bit = seg.bit;
    party->next = seg.parties;
    party->n = 0;
    party->pending = party->spoilt = party->hearing = false;
    seg.parties = party;
}

void seg_station_off(void)
{
    seg.station.pending = false;
    seg.station.n = 0;
    seg.station.char_end = hv_now();
    seg.driver = false;
}

void seg_set_rate(uint32_t bit_per_s)
{
    static const struct {
        uint32_t rate;
        unsigned max_t_sdr;
    } table[] = {{9600, 60},    {19200, 60},    {45450, 60},    {93750, 60},    {187500, 60},
                 {500000, 100}, {1500000, 150}, {3000000, 250}, {6000000, 450}, {12000000, 800}};
    seg.bit = hv_bit_of(bit_per_s);
    seg.max_t_sdr = 60;
    for (unsigned i = 0; i < sizeof table / sizeof table[0]; i++)
        if (table[i].rate == bit_per_s)
            seg.max_t_sdr = table[i].max_t_sdr;
}

void seg_set_address(uint8_t station_address)
{
    seg.address = station_address;
}

void seg_set_min_t_sdr(unsigned tbit)
{
    seg.min_t_sdr = tbit;
}

unsigned seg_max_t_sdr(void)
{
    return seg.max_t_sdr;
}

void seg_begin(uint32_t bit_per_s, uint8_t station_address)
{
    memset(&seg, 0, sizeof seg);
    memset(&seg_said, 0, sizeof seg_said);
    seg_trace = 0;
    seg_set_rate(bit_per_s);
    seg.min_t_sdr = 11;
    seg.address = station_address;
    seg.station.name = "station";
    seg.station.judged = true;
    seg_attach(&seg.station);
    hv_set_wire(&seg_wire);
}

hv_time seg_quiet_since(void)
{
    return seg.quiet_since;
}

unsigned seg_count(enum seg_rule rule)
{
    return seg.count[rule];
}

const char *seg_verdict(void)
{
    static char text[120];
    for (struct seg_party *p = seg.parties; p; p = p->next)
        if (p->n && hv_now() > p->char_end)
            violation(SEG_MALFORMED, p, 0), p->n = 0;
    if (seg.driver && hv_now() > seg.station.char_end) {
        violation(SEG_DRIVER, &seg.station, hv_now() - seg.station.char_end);
        seg.driver = false;
    }
    if (seg.told >= seg.kept_n)
        return NULL;
    const struct seg_violation *const v = &seg.kept[seg.told];
    seg.told = seg.kept_n;
    snprintf(text, sizeof text, "%s: %s at %llu us (%llu T_bit)", v->who, rule_text[v->rule],
             (unsigned long long)(v->at / HV_US), (unsigned long long)v->tbit);
    return text;
}
