/* Random frames and noise. A second, simpler secondary in this file (state table of the facts, 2.3, as one function)
 * says what each frame must lead to; the station must answer just so, and its outputs change when, and only when, a
 * good control command was in it. */
#include "remote_board_fake.h"
#include "remote_module.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "sim/hdlc_bus.h"
#include "sim/random.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sanitized programs are some times slower. */
#if defined(__SANITIZE_ADDRESS__)
#define SLOW 4u
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SLOW 4u
#endif
#endif
#ifndef SLOW
#define SLOW 1u
#endif

static uint64_t seed;
static uint8_t mode;

static unsigned rounds(unsigned full)
{
    return getenv("TEST_FULL") ? full / SLOW : full / 100u;
}

static void init(void)
{
    rm_init(RM_DO, 5, mode);
}

static void start(void)
{
    hbus_begin();
    board_fake_begin();
    hbus_station(init, rm_poll);
    hdlc_nrm_inactivity(0);
    hbus_run(20);
}

void setUp(void)
{
    mode = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, hbus.collisions + hbus.stuck);
}

/* ---- the second secondary ---------------------------------------------------------------------------------- */

static struct {
    int state; /* 0 NDM, 1 NRM, 2 FRMR */
    unsigned vs, vr, kept; /* kept: answers not acknowledged, 0..2; the first one may be sent */
    bool sent, rej, rnr;
    uint8_t out[2][HDLC_INFO_MAX];
    unsigned out_n[2];
    uint8_t frmr[3];
    uint16_t outputs;
    unsigned executed;
} ref;

/* -> length of the answer's information field (the module's own, spec C2 and its negative answers) */
static unsigned module_does(const uint8_t *info, unsigned n, uint8_t *answer, bool documented)
{
    unsigned reason = 0;
    if (n == 0 || (info[0] != 2 && (info[0] != 3 || documented)))
        reason = 1;
    else if (n != (info[0] == 2 ? 3u : 2u))
        reason = 3;
    else if (info[1] > (info[0] == 2 ? 15 : 1))
        reason = 2;
    else if (info[0] == 2 && info[2] != 0x30 && info[2] != 0x31)
        reason = 4;
    if (reason) {
        if (documented)
            return 0;
        answer[0] = (uint8_t)(0x80 | (n ? info[0] : 0));
        answer[1] = n > 1 ? info[1] : 0;
        answer[2] = (uint8_t)reason;
        return 3;
    }
    memcpy(answer, info, n);
    if (info[0] == 3)
        return info[1] ? 36 : 12; /* contents are not compared */
    ref.executed++;
    ref.outputs = (uint16_t)((ref.outputs & ~(1u << info[1])) | (unsigned)(info[2] & 1) << info[1]);
    return 3;
}

static unsigned say(uint8_t *a, unsigned control, const uint8_t *info, unsigned n)
{
    a[0] = 5;
    a[1] = (uint8_t)control;
    memmove(a + 2, info, n);
    return n + 2;
}

static unsigned poll_answer(uint8_t *a)
{
    if (ref.kept == 0 || ref.rnr)
        return say(a, (ref.kept == 2 ? 0x15u : 0x11u) | ref.vr << 5, a, 0);
    if (!ref.sent)
        ref.vs = (ref.vs + 1) % 8;
    ref.sent = true;
    return say(a, 0x10u | ref.vr << 5 | ((ref.vs + 7) % 8) << 1, ref.out[0], ref.out_n[0]);
}

/* The answer to frame f[0..n-1], n >= 2, into a; -> its length, 0: silence. */
static unsigned reference(const uint8_t *f, unsigned n, uint8_t *a)
{
    const unsigned c = f[1], nr = c >> 5, ns = (c >> 1) & 7, info = n - 2;
    const bool p = (c & 0x10) != 0, i = (c & 1) == 0;
    const bool s = (c & 0x0F) == 0x01 || (c & 0x0F) == 0x05 || (c & 0x0F) == 0x09;
    const unsigned u = c & 0xEF;
    if (f[0] != 5)
        return 0;
    if (ref.state == 0 && c == 0x08 && info <= HDLC_INFO_MAX) {
        const unsigned k = module_does(f + 2, info, a + 2, true);
        return k ? say(a, 0x09, a + 2, k) : 0;
    }
    if (u == 0x83 && info == 0) {
        if (p) {
            ref.state = 1;
            ref.vs = ref.vr = ref.kept = 0;
            ref.sent = ref.rej = ref.rnr = false;
        }
        return p ? say(a, 0x73, a, 0) : 0;
    }
    if (ref.state == 0)
        return p ? say(a, 0x1F, a, 0) : 0;
    if (u == 0x43 && info == 0) {
        if (p) {
            ref.state = 0;
            ref.outputs = 0;
        }
        return p ? say(a, 0x73, a, 0) : 0;
    }
    if (ref.state == 1) {
        const bool known = i || s || u == 0x03 || u == 0xE3 || u == 0xAF || u == 0x83 || u == 0x43;
        const bool with_info = i || u == 0x03 || u == 0xE3 || u == 0xAF;
        const bool number = nr == ref.vs || (ref.sent && nr == (ref.vs + 7) % 8);
        const unsigned why = !known                  ? 1
                             : info && !with_info    ? 3
                             : info > HDLC_INFO_MAX  ? 4
                             : (i || s) && !number   ? 8
                                                     : 0;
        if (why == 0) {
            if ((i || s) && ref.sent && nr == ref.vs) {
                ref.sent = false;
                ref.kept--;
                memcpy(ref.out[0], ref.out[1], sizeof ref.out[0]);
                ref.out_n[0] = ref.out_n[1];
            }
            if (s)
                ref.rnr = (c & 0x0F) == 0x05;
            if (i && ns == ref.vr && ref.kept < 2) {
                ref.vr = (ref.vr + 1) % 8;
                ref.rej = false;
                ref.out_n[ref.kept] = module_does(f + 2, info, ref.out[ref.kept], false);
                ref.kept++;
            } else if (i && ns != ref.vr && p && ns != (ref.vr + 7) % 8 && !ref.sent && !ref.rej && ref.kept < 2) {
                ref.rej = true;
                return say(a, 0x19u | ref.vr << 5, a, 0);
            }
            if (!p)
                return 0;
            if (u == 0xE3 && !i && !s)
                return say(a, 0xF3, f + 2, info);
            if (u == 0xAF && !i && !s)
                return say(a, 0xBF, (const uint8_t[]){0x02, 0x10}, 2);
            return poll_answer(a);
        }
        ref.state = 2;
        ref.frmr[0] = (uint8_t)c;
        ref.frmr[1] = (uint8_t)(ref.vr << 5 | ref.vs << 1);
        ref.frmr[2] = (uint8_t)why;
    }
    return p ? say(a, 0x97, ref.frmr, 3) : 0;
}

/* ---- random frames -------------------------------------------------------------------------------------------- */

static unsigned below(unsigned n)
{
    return sim_below(&seed, n);
}

/* Mostly what might come: our address, commands in sequence, small information fields; sometimes anything. */
static unsigned random_frame(uint8_t *f)
{
    static const uint8_t u[] = {0x93, 0x93, 0x93, 0x53, 0x11, 0x31, 0x15, 0x19, 0x13, 0xF3,
                                0xBF, 0x83, 0x43, 0x08, 0x08, 0x09, 0x1D, 0x97, 0x73};
    unsigned n = 2;
    f[0] = below(20) ? 5 : (uint8_t)below(256);
    f[1] = 0x93;
    if (ref.state != 1 && below(3)) /* else most frames would only be answered DM or FRMR */
        return n;
    switch (below(8)) {
    case 0:
        f[1] = (uint8_t)below(256);
        break;
    case 1:
        f[1] = u[below(sizeof u)];
        break;
    case 2:
        f[1] = (uint8_t)(ref.vs << 5 | 0x11u | below(3) << 2); /* RR, RNR, REJ */
        break;
    default:
        f[1] = (uint8_t)((ref.vs + (below(6) ? 0 : 7)) % 8 << 5 | (below(8) ? 0x10u : 0) |
                         (ref.vr + (below(6) ? 0 : below(8))) % 8 << 1);
        break;
    }
    if ((f[1] & 1u) == 0 || below(12) == 0) { /* information: a control, or what is nearly one */
        f[n++] = below(8) ? 0x02 : (uint8_t)below(6);
        f[n++] = (uint8_t)(below(12) ? below(16) : below(256));
        f[n++] = (uint8_t)(below(12) ? 0x30 + below(2) : below(256));
        if (below(10) == 0)
            n = 2 + below(4);
        if (below(40) == 0)
            for (n = 2; n < 2 + below(100); n++)
                f[n] = (uint8_t)below(256);
    }
    return n;
}

static void check_frame(const uint8_t *f, unsigned n, unsigned k)
{
    static uint8_t expected[HB_OCTETS];
    char text[60];
    unsigned want = reference(f, n, expected);
    snprintf(text, sizeof text, "frame %u: %02X %02X, %u octets", k, f[0], f[1], n);
    hbus_clear();
    hbus_say(f, n);
    if (want) {
        for (unsigned i = 0; i < 1000 && (hbus.answers == 0 || hal_8273_chip.rts); i++)
            hbus_run(1);
        TEST_ASSERT_EQUAL_MESSAGE(want, hbus.answer_n, text);
        if ((expected[1] & 1u) == 0 && expected[2] == 0x03)
            want = 4; /* the rest is diagnosis */
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(expected, hbus.answer, want, text);
        hbus_run(8);
    } else {
        hbus_run(20);
    }
    TEST_ASSERT_EQUAL_MESSAGE(want ? 1 : 0, hbus.answers, text);
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(ref.outputs, board.digital_out, text);
    TEST_ASSERT_EQUAL_MESSAGE((uint16_t)ref.executed, rm_counters.executed, text);
    TEST_ASSERT_EQUAL_MESSAGE(ref.state, hdlc_nrm_state(), text);
}

static unsigned run_frames(unsigned count)
{
    uint8_t f[HB_OCTETS];
    memset(&ref, 0, sizeof ref);
    seed = 0x1234567u + mode;
    start();
    for (unsigned k = 0; k < count; k++)
        check_frame(f, random_frame(f), k);
    TEST_ASSERT_TRUE_MESSAGE(ref.executed > count / 20, "hardly any command was a good one");
    return ref.executed;
}

static void test_random_frames(void)
{
    const unsigned count = rounds(1000000);
    printf("%u random frames, %u of them carried out\n", count, run_frames(count));
}

static void test_random_frames_buffered_and_by_dma(void)
{
    mode = HDLC_8273_BUFFERED;
    run_frames(rounds(100000));
    mode = HDLC_8273_DMA;
    run_frames(rounds(100000));
}

/* ---- noise ------------------------------------------------------------------------------------------------------ */

/* Noise of random density, frames in it broken at random; what the decoder of the simulation finds right in it is
 * asked of the reference. Behind each burst a good command is answered, and the outputs are as they should be. */
static unsigned noise(struct hb_line *line, unsigned n)
{
    const unsigned ones = 1 + below(9);
    unsigned bits = 0;
    line->n = line->ones = 0;
    while (line->n < n) {
        if (below(12) == 0) {
            uint8_t f[HB_OCTETS];
            const unsigned start_at = line->n;
            const unsigned octets = random_frame(f);
            if (octets < 20) {
                hb_frame(line, f, octets);
                for (unsigned k = below(4); k; k--)
                    line->bit[start_at + below(line->n - start_at)] ^= 1u;
            }
        }
        hb_raw(line, below(10) < ones, 1);
    }
    bits = line->n;
    for (unsigned k = 0; k < 20; k++)
        hb_raw(line, 1, 1);
    return bits;
}

/* The line's bits as the station gets them; the station may answer into the noise: that is no fault of its own. */
static void test_noise(void)
{
    const unsigned wanted = rounds(10000000);
    unsigned bits = 0, bursts = 0;
    static struct hb_line line;
    mode = 0;
    seed = 99;
    start();
    hbus_ask((const uint8_t[]){0x05, 0x93}, 2);
    while (bits < wanted) {
        const uint16_t executed = rm_counters.executed;
        struct hb_decoder d = {0};
        unsigned controls = 0;
        bits += noise(&line, 20 + below(1500));
        for (unsigned i = 0; i < line.n; i++)
            if (hb_decode(&d, line.bit[i]) == HB_FRAME && d.octets[0] == 5)
                controls++;
        hbus_say_bits(&line);
        while (hal_8273_chip.rts)
            hbus_run(8);
        hbus_run(40);
        TEST_ASSERT_TRUE_MESSAGE((uint16_t)(rm_counters.executed - executed) <= controls, "carried out, but not sent");
        hbus.collisions = 0;
        hbus_clear();
        TEST_ASSERT_TRUE_MESSAGE(hbus_ask((const uint8_t[]){0x05, 0x93}, 2), "deaf after noise");
        TEST_ASSERT_EQUAL_HEX8(0x73, hbus.answer[1]);
        hbus_clear();
        TEST_ASSERT_TRUE(hbus_ask((const uint8_t[]){0x05, 0x10, 0x02, 0x07, bursts & 1u ? 0x31 : 0x30}, 5));
        TEST_ASSERT_EQUAL_HEX8(0x30, hbus.answer[1]);
        TEST_ASSERT_EQUAL(bursts & 1u, (board.digital_out >> 7) & 1u);
        bursts++;
    }
    printf("%u bits of noise in %u bursts\n", bits, bursts);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_frames);
    RUN_TEST(test_random_frames_buffered_and_by_dma);
    RUN_TEST(test_noise);
    return UNITY_END();
}
