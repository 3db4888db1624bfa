#include "dp_trace.h"
#include "console.h"
#include "dp_words.h"
#include "hal_host.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#define NOTES    32u    /* telegrams in one turn of the main loop; more are counted */
#define STALE_US 20000u /* our choice: a telegram without an end is shown then      */

struct note {
    bool sent, good;
    uint64_t us;
    uint16_t n;
    uint8_t octets[TG_MAX + 1u];
};

static struct note notes[NOTES];
static unsigned notes_n, lost;
static uint64_t start_us; /* of the trace */
static uint8_t asked;     /* FC of the last request */

/* A telegram being received, which may come in several runs. bad: octets that are none, until the run is
 * over. */
static struct note now;
static bool bad;

static uint64_t now_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

static void put_away(bool good)
{
    if (now.n != 0 && notes_n < NOTES) {
        now.good = good;
        notes[notes_n++] = now;
    } else if (now.n != 0) {
        lost++;
    }
    now.n = 0;
    bad = false;
}

static void octet(uint8_t value, uint8_t err)
{
    struct tg t;
    enum tg_verdict v;

    if (now.n == sizeof now.octets)
        put_away(false);
    if (now.n == 0)
        now.us = now_us();
    now.octets[now.n++] = value;
    v = bad || err ? TG_BAD : tg_decode(now.octets, now.n, &t);
    bad = v == TG_BAD;
    if (v == TG_GOOD)
        put_away(true);
}

static void tap(const uint8_t *octets, const uint8_t *err, uint16_t n)
{
    if (now.n != 0 && now.sent != (err == NULL))
        put_away(false);
    now.sent = err == NULL;
    for (uint16_t i = 0; i < n; i++)
        octet(octets[i], err ? err[i] : 0);
    if (bad)
        put_away(false);
}

void dp_trace_set(bool on)
{
    hal_host_tap = on ? tap : NULL;
    start_us = now_us();
    notes_n = lost = now.n = 0;
    bad = false;
}

static void say(const struct note *n, uint8_t state)
{
    static char text[2u * sizeof n->octets + 256u];
    struct tg t;
    int at = snprintf(text, sizeof text, "trace=%s t=%.6f phy=", n->sent ? "tx" : "rx",
                      (double)(n->us - start_us) * 1e-6);

    for (uint16_t i = 0; i < n->n; i++)
        at += snprintf(text + at, sizeof text - (size_t)at, "%02X", n->octets[i]);
    text[at++] = ' ';
    if (n->good && tg_decode(n->octets, n->n, &t) == TG_GOOD) {
        dp_fdl_words(&t, text + at, sizeof text - (size_t)at);
        at += (int)strlen(text + at);
        snprintf(text + at, sizeof text - (size_t)at, " ddlm=%s state=%s", dp_service(&t, asked),
                 dp_state_word(state));
        if (t.fc & TG_REQUEST)
            asked = t.fc;
    } else {
        snprintf(text + at, sizeof text - (size_t)at, "fdl=invalid state=%s", dp_state_word(state));
    }
    console_line(text);
}

void dp_trace_poll(uint8_t state)
{
    char text[40];

    if (now.n != 0 && now_us() - now.us >= STALE_US)
        put_away(false);

    for (unsigned i = 0; i < notes_n; i++)
        say(&notes[i], state);
    if (lost) {
        snprintf(text, sizeof text, "trace=lost telegrams=%u", lost);
        console_line(text);
    }
    notes_n = lost = 0;
}
