#include "sim/hdlc_master.h"

#include <string.h>

#define BITS_PER_MS 7u /* at 7200 bit/s, and a bit */

struct hp hm_primary;
unsigned hm_frames;

static struct {
    const struct hm_plan *plan;
    unsigned plans;
    uint8_t octets[HB_OCTETS];
    unsigned n; /* to be sent, 0: nothing */
    enum hm_fault fault;
    unsigned at; /* bits of the frame that have gone by, for the fault */
    bool station_sends;
    uint8_t copy[HB_OCTETS];
    unsigned copy_n; /* an answer that will come once more */
} hm;

const char *hm_reason(enum hm_fault kind)
{
    static const char *const reasons[HM_KINDS] = {
#define HM_REASON(name, reason) reason,
        HM_FAULTS(HM_REASON)
#undef HM_REASON
    };
    return reasons[kind];
}

static void send(struct hp *p, const uint8_t *octets, unsigned n)
{
    (void)p;
    memcpy(hm.octets, octets, n);
    hm.n = n;
}

static enum hm_fault planned(void)
{
    enum hm_fault kind = HM_NONE;
    for (unsigned i = 0; i < hm.plans; i++)
        if (hm.plan[i].frame == hm_frames)
            kind = hm.plan[i].kind;
    hm_frames++;
    hm.at = 0;
    return kind;
}

static unsigned now_ms(void)
{
    return (unsigned)(hbus.now * 10u / 72u);
}

static bool spoil(bool level, bool to_station)
{
    if (to_station)
        return level;
    if (hal_8273_chip.rts && !hm.station_sends)
        hm.fault = planned();
    hm.station_sends = hal_8273_chip.rts;
    if (!hal_8273_chip.rts)
        return level;
    hm.at++;
    switch (hm.fault) {
    case HM_LOST:
        return true;
    case HM_BIT:
        return level ^ (hm.at == 20);
    case HM_CUT:
        return level || hm.at > 30;
    case HM_SLIP: /* as near as it gets bit by bit: one is doubled, the next one gone */
        return level ^ (hm.at == 23 || hm.at == 24);
    default:
        return level;
    }
}

void hm_begin(const struct hm_plan *plan, unsigned n)
{
    memset(&hm, 0, sizeof hm);
    hm.plan = plan;
    hm.plans = n;
    hm_frames = 0;
    hp_init(&hm_primary);
    hm_primary.send = send;
    hbus.spoil = spoil;
}

/* The command goes out, as its fault wants it. */
static void say(void)
{
    static struct hb_line line;
    const enum hm_fault fault = planned();
    line.n = line.ones = line.inserted = 0;
    hb_frame(&line, hm.octets, hm.n);
    if (fault == HM_LOST)
        memset(line.bit, 1, line.n);
    if (fault == HM_BIT)
        line.bit[20] ^= 1u;
    if (fault == HM_CUT)
        memset(line.bit + 30, 1, line.n - 30);
    if (fault == HM_SLIP) {
        memmove(line.bit + 24, line.bit + 25, line.n - 25);
        line.n--;
    }
    hm.n = 0;
    hbus_say_bits(&line);
    hp_sent(&hm_primary, now_ms());
    if (hm.copy_n)
        hp_frame(&hm_primary, hm.copy, hm.copy_n, now_ms());
    hm.copy_n = 0;
}

static void step(void)
{
    const unsigned before = hbus.answers;
    hp_poll(&hm_primary, now_ms());
    if (hm.n)
        say();
    hbus_run(BITS_PER_MS);
    if (hbus.answers == before)
        return;
    hp_frame(&hm_primary, hbus.answer, hbus.answer_n, now_ms());
    if (hm.fault == HM_TWICE)
        hp_frame(&hm_primary, hbus.answer, hbus.answer_n, now_ms());
    if (hm.fault == HM_LATE) {
        hm.copy_n = hbus.answer_n;
        memcpy(hm.copy, hbus.answer, hbus.answer_n);
    }
    hm.fault = HM_NONE;
}

void hm_run(unsigned ms)
{
    const unsigned end = now_ms() + ms;
    while (now_ms() < end)
        step();
}

static bool idle(void)
{
    if (hm_primary.waiting || hm_primary.queued)
        return false;
    for (unsigned i = 0; i < hm_primary.modules; i++)
        if (hm_primary.module[i].has_request)
            return false;
    return true;
}

bool hm_run_until_idle(unsigned limit_ms)
{
    const unsigned end = now_ms() + limit_ms;
    while (now_ms() < end && !idle())
        step();
    return idle();
}
