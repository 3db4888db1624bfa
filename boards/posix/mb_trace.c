#include "mb_trace.h"
#include "console.h"
#include "hal_host.h"
#include "sim/modbus_frame.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#define NOTES 32u /* frames in one turn of the main loop; more are counted */

struct note {
    bool sent;
    struct timespec first, last;
    uint16_t n;
    uint8_t octets[MBC_FRAME_MAX];
};

static struct note notes[NOTES], now;
static unsigned notes_n, lost;
static struct timespec start;

static void put_away(void)
{
    if (now.n != 0 && notes_n < NOTES)
        notes[notes_n++] = now;
    else if (now.n != 0)
        lost++;
    now.n = 0;
}

static void tap(const uint8_t *octets, const uint8_t *err, uint16_t n)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    if (now.sent != (err == NULL))
        put_away();
    now.sent = err == NULL;
    for (uint16_t i = 0; i < n; i++) {
        if (now.n == sizeof now.octets)
            put_away();
        if (now.n == 0)
            now.first = t;
        now.last = t;
        now.octets[now.n++] = octets[i];
    }
    if (now.sent)
        put_away();
}

void mb_trace_set(bool on)
{
    hal_host_tap = on ? tap : NULL;
    clock_gettime(CLOCK_MONOTONIC, &start);
    notes_n = lost = now.n = 0;
}

static int put_hex(char *to, const uint8_t *octets, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        sprintf(to + 2 * i, "%02X", octets[i]);
    to[2 * n] = 0;
    return (int)(2 * n);
}

static void say(const struct note *n, bool ascii)
{
    static char text[4u * MBC_FRAME_MAX + 256u];
    static uint8_t body[MBC_FRAME_MAX];
    const struct mbc_coding coding = {ascii ? MBC_ASCII : MBC_RTU, '\n'};
    const unsigned body_n = mbc_unframe(&coding, n->octets, n->n, body);
    long long us = (n->first.tv_sec - start.tv_sec) * 1000000LL + (n->first.tv_nsec - start.tv_nsec) / 1000;
    int at = snprintf(text, sizeof text, "trace=%s t=%lld.%06lld frame=", n->sent ? "tx" : "rx", us / 1000000,
                      us % 1000000);
    at += put_hex(text + at, n->octets, n->n);
    if (body_n < 2) {
        snprintf(text + at, sizeof text - (size_t)at, " check=bad");
    } else {
        at += snprintf(text + at, sizeof text - (size_t)at,
                       " check=ok address=%u function=%02X data=", body[0], body[1]);
        put_hex(text + at, body + 2, body_n - 2);
    }
    console_line(text);
}

void mb_trace_poll(bool ascii, uint16_t gap_ms)
{
    char text[40];
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    if (now.n != 0 &&
        (t.tv_sec - now.last.tv_sec) * 1000 + (t.tv_nsec - now.last.tv_nsec) / 1000000 >= gap_ms)
        put_away();
    for (unsigned i = 0; i < notes_n; i++)
        say(&notes[i], ascii);
    if (lost) {
        snprintf(text, sizeof text, "trace=lost frames=%u", lost);
        console_line(text);
    }
    notes_n = lost = 0;
}
