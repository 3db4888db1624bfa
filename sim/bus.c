#include "sim/bus.h"

#include "sim/random.h"

static struct {
    enum flt kind;
    unsigned one_in, hits;
    uint64_t random;
} fault;

void bus_fault(enum flt kind, unsigned one_in, uint64_t seed)
{
    fault.kind = kind;
    fault.one_in = one_in;
    fault.random = seed | 1;
    fault.hits = 0;
}

unsigned bus_faults(void)
{
    return fault.hits;
}

static bool struck(void)
{
    if (fault.kind == FLT_NONE || sim_below(&fault.random, fault.one_in) != 0)
        return false;
    fault.hits++;
    return true;
}

/* ---- requests ----------------------------------------------------------------------------------------- */

/* The line is the master's until t; what it hears before is not an answer. */
static void busy_until(struct bus_master *b, hv_time t)
{
    if (t > b->deaf_until)
        b->deaf_until = t;
    ini_sends_until(&b->dp.ini, b->deaf_until);
}

static void send_chars(struct bus_master *b, hv_time t, const struct flt_char *chars, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        t += chars[i].idle * b->party.bit;
        seg_send(&b->cable, t, &chars[i].octet, 1, &chars[i].err);
        t += 11 * b->party.bit;
    }
    busy_until(b, t);
}

static void send_good(struct bus_master *b, struct seg_party *from, hv_time t, const uint8_t *octets,
                      unsigned n)
{
    seg_send(from, t, octets, n, 0);
    busy_until(b, t + n * 11 * b->party.bit);
}

/* Somebody else before the request or with it. -> when the request itself starts. */
static hv_time send_stranger(struct bus_master *b, hv_time t)
{
    uint8_t octets[TG_MAX];
    const unsigned n = flt_stranger(fault.kind, &fault.random, octets);
    if (n == 0)
        return t;
    b->stranger.bit = b->party.bit * (fault.kind == FLT_OTHER_RATE ? 2 : 1);
    seg_send(&b->stranger, t, octets, n, 0);
    busy_until(b, t + n * 11 * b->stranger.bit);
    return fault.kind == FLT_COLLISION ? t : b->deaf_until + 40 * b->party.bit;
}

static void send_faulty(struct bus_master *b, const uint8_t *octets, unsigned n)
{
    struct flt_char chars[FLT_CHARS];
    const hv_time t = send_stranger(b, hv_now());
    const int len = flt_request(fault.kind, &fault.random, octets, n, chars);
    if (len >= 0)
        send_chars(b, t, chars, (unsigned)len);
    else
        send_good(b, fault.kind == FLT_COLLISION ? &b->cable : &b->party, t, octets, n);
}

static void on_send(void *of, const uint8_t *octets, unsigned n)
{
    struct bus_master *const b = of;
    b->answer_fault = FLT_NONE;
    b->answer_i = 0;
    if (b->cut)
        return;
    const bool hit = struck();
    if (hit && !flt_hits_answer(fault.kind)) {
        send_faulty(b, octets, n);
        return;
    }
    if (hit) {
        b->answer_fault = fault.kind;
        b->answer_hit = sim_below(&fault.random, 6);
    }
    send_good(b, &b->party, hv_now(), octets, n);
}

/* ---- polling ------------------------------------------------------------------------------------------ */

static void poll(void *of, uint32_t unused);

static void arm(struct bus_master *b)
{
    hv_time due = dpm_due(&b->dp);
    if (due == 0)
        due = hv_now() + 50 * b->party.bit; /* it has nothing to do, or may go on */
    if (due >= b->next)
        return;
    b->next = due < hv_now() ? hv_now() : due;
    hv_at(b->next, poll, b, 0);
}

static void poll(void *of, uint32_t unused)
{
    struct bus_master *const b = of;
    (void)unused;
    if (hv_now() != b->next)
        return; /* overtaken by an earlier one */
    b->next = HV_NEVER;
    dpm_poll(&b->dp, hv_now());
    arm(b);
    if (b->dp.ring) {
        struct bus_master *const other = b->dp.ring->ini.of;
        arm(other);
    }
}

static void on_octet(struct seg_party *party, uint8_t octet, uint8_t err)
{
    struct bus_master *const b = party->of;
    if (b->cut || hv_now() <= b->deaf_until)
        return;
    /* Even a master that cannot read the answer waits until the line is idle: collision is a fault of its own. */
    if (flt_answer(b->answer_fault, b->answer_hit, b->answer_i++, &octet, &err))
        dpm_hear(&b->dp, hv_now(), octet, err);
    else
        ini_activity(&b->dp.ini, hv_now());
    arm(b);
}

static void attach(struct bus_master *b, struct seg_party *p, const char *name, bool judged)
{
    *p = (struct seg_party){.name = name, .judged = judged, .of = b};
    seg_attach(p);
}

void bus_attach(struct bus_master *b)
{
    attach(b, &b->cable, "cable", false);
    attach(b, &b->stranger, "stranger", false);
    attach(b, &b->party, "master", true);
    b->party.hears = on_octet;
    b->dp.ini.bit = b->party.bit;
    b->dp.ini.slot = (seg_max_t_sdr() + 22) * b->party.bit;
    b->dp.ini.gap = 33 * b->party.bit;
    b->dp.ini.send = on_send;
    b->dp.ini.of = b;
    b->next = HV_NEVER;
    b->deaf_until = 0;
    b->answer_fault = FLT_NONE;
    dpm_begin(&b->dp);
    arm(b);
}

bool bus_ask(struct bus_master *b, struct dp_job *job)
{
    dpm_ask(&b->dp, job);
    while (job->state == DP_JOB_WAITS)
        hv_run_for(1000 * b->party.bit);
    return job->state == DP_JOB_DONE;
}
