/* Every error of one, two and three bits in the shortest control frame (issue): what the damaged line means is said
 * by the decoder of the simulation; the station must agree, and carry out nothing else.
 *
 * A CRC of 16 bits finds every such error in a frame of fixed bounds. On the line the bounds are not fixed: a turned
 * bit can make or break an inserted zero or a flag, and what then stands between two flags is another, shorter or
 * longer frame, which may be right by the standard. Those are counted and listed. */
#include "remote_board_fake.h"
#include "remote_module.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "sim/hdlc_bus.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sanitized programs are slow, and find nothing more in the same lines again. */
#if defined(__SANITIZE_ADDRESS__)
#define STEP_FULL 31
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define STEP_FULL 31
#endif
#endif
#ifndef STEP_FULL
#define STEP_FULL 1
#endif

static uint8_t mode;
static uint8_t good[8]; /* A C I of the frame under test */
static unsigned good_n;
static struct hb_line clean;

static struct {
    unsigned cases, right, controls;
} tally;

static void init(void)
{
    rm_init(RM_DO, 5, mode);
}

static void start(const uint8_t *octets, unsigned n)
{
    hbus_begin();
    board_fake_begin();
    hbus_station(init, rm_poll);
    hbus_run(20);
    memcpy(good, octets, n);
    good_n = n;
    clean = (struct hb_line){0};
    hb_frame(&clean, octets, n);
}

void setUp(void)
{
    memset(&tally, 0, sizeof tally);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, hbus.stuck);
}

/* Is it a control command to station 5 that must be carried out? Spec C1, C2. */
static bool is_control(const uint8_t *f, unsigned n, uint8_t control)
{
    return n == 5 && f[0] == 0x05 && f[1] == control && f[2] == 0x02 && f[3] <= 0x0F && (f[4] & 0xFE) == 0x30;
}

static void list(const unsigned *turned, unsigned n, const struct hb_decoder *d)
{
    char text[120];
    size_t at = 0;
    if (tally.right > 12 && !getenv("HDLC_LIST"))
        return;
    for (unsigned i = 0; i < n; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, " %u", turned[i]);
    at += (size_t)snprintf(text + at, sizeof text - at, " ->");
    for (unsigned i = 0; i < d->n && at < sizeof text; i++)
        at += (size_t)snprintf(text + at, sizeof text - at, " %02X", d->octets[i]);
    printf("  right by the standard: bits%s\n", text);
}

/* -> control commands that the damaged line carries */
static unsigned meaning(const struct hb_line *line, const unsigned *turned, unsigned n)
{
    struct hb_decoder d = {0};
    unsigned controls = 0;
    for (unsigned i = 0; i < line->n; i++) {
        if (hb_decode(&d, line->bit[i]) != HB_FRAME)
            continue;
        tally.right++;
        list(turned, n, &d);
        controls += is_control(d.octets, d.n, good[1]);
    }
    tally.controls += controls;
    return controls;
}

static void one_case(const unsigned *turned, unsigned n)
{
    static struct hb_line line;
    const uint16_t before = rm_counters.executed;
    unsigned expected;
    line = clean;
    for (unsigned i = 0; i < n; i++)
        line.bit[turned[i]] ^= 1u;
    expected = meaning(&line, turned, n);
    tally.cases++;
    hbus_clear();
    hbus_say_bits(&line);
    hbus_run(24);
    while (hal_8273_chip.rts)
        hbus_run(8);
    if ((uint16_t)(rm_counters.executed - before) != expected) {
        char text[100];
        snprintf(text, sizeof text, "bits %u %u %u: executed %u, right %u", turned[0], n > 1 ? turned[1] : 0,
                 n > 2 ? turned[2] : 0, rm_counters.executed - before, expected);
        TEST_FAIL_MESSAGE(text);
    }
}

static void all_errors(void (*refresh)(void))
{
    unsigned t[3];
    for (t[0] = 0; t[0] < clean.n; t[0]++) {
        refresh();
        one_case(t, 1);
        for (t[1] = t[0] + 1; t[1] < clean.n; t[1]++) {
            refresh();
            one_case(t, 2);
            for (t[2] = t[1] + 1; t[2] < clean.n; t[2]++) {
                refresh();
                one_case(t, 3);
            }
        }
    }
}

static void nothing(void)
{
}

static void report(const char *what)
{
    printf("%s: %u errors of 1..3 bits in %u line bits; %u lines were right frames, %u of them control commands\n",
           what, tally.cases, clean.n, tally.right, tally.controls);
}

/* 75 bits: C(75,1) + C(75,2) + C(75,3) and so on: every pattern was tried. */
static unsigned patterns(unsigned n)
{
    return n + n * (n - 1) / 2 + n * (n - 1) * (n - 2) / 6;
}

static void test_document_mode_in_every_mode_of_the_chip(void)
{
    static const uint8_t modes[] = {0, HDLC_8273_BUFFERED, HDLC_8273_DMA};
    for (unsigned i = getenv("TEST_FULL") ? 0 : 2; i < sizeof modes; i++) {
        mode = modes[i];
        memset(&tally, 0, sizeof tally);
        start((const uint8_t[]){0x05, 0x08, 0x02, 0x0F, 0x31}, 5);
        all_errors(nothing);
        TEST_ASSERT_EQUAL(patterns(clean.n), tally.cases);
    }
    report("05 08 02 0F 31");
    mode = 0;
}

/* The same in I-frames: the station is connected anew where a damaged frame has moved its numbers or its state. */
static void reconnect(void)
{
    static uint16_t commands;
    if (hdlc_nrm_counters.commands == commands && hdlc_nrm_state() == HDLC_NRM)
        return;
    hbus_ask((const uint8_t[]){0x05, 0x93}, 2);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    commands = hdlc_nrm_counters.commands;
}

static void test_i_frame(void)
{
    start((const uint8_t[]){0x05, 0x10, 0x02, 0x0F, 0x31}, 5);
    all_errors(reconnect);
    TEST_ASSERT_EQUAL(patterns(clean.n), tally.cases);
    report("05 10 02 0F 31");
}

/* The test can see what it looks for: all bits turned that make one good frame of another. */
static void test_a_damaged_line_that_is_a_right_frame_is_seen(void)
{
    const uint8_t other[] = {0x05, 0x08, 0x02, 0x03, 0x30};
    struct hb_line wanted = {0};
    unsigned turned[HB_BITS], n = 0;
    start((const uint8_t[]){0x05, 0x08, 0x02, 0x06, 0x31}, 5);
    hb_frame(&wanted, other, 5);
    TEST_ASSERT_EQUAL(wanted.n, clean.n);
    for (unsigned i = 0; i < clean.n; i++)
        if (wanted.bit[i] != clean.bit[i])
            turned[n++] = i;
    TEST_ASSERT_TRUE(n > 3);
    one_case(turned, n);
    TEST_ASSERT_EQUAL(1, tally.right);
    TEST_ASSERT_EQUAL(1, tally.controls);
}

/* A command without information, 49 and 48 line bits: damaged, it neither connects nor disconnects, unless it is a
 * right frame. */
static uint8_t state;
static unsigned right_before;

static void same_state(void)
{
    if (tally.right == right_before)
        TEST_ASSERT_EQUAL(state, hdlc_nrm_state());
    right_before = tally.right;
    if (hdlc_nrm_state() != state)
        hbus_ask((const uint8_t[]){0x05, state == HDLC_NRM ? 0x93 : 0x53}, 2);
    TEST_ASSERT_EQUAL(state, hdlc_nrm_state());
}

static void unnumbered(uint8_t control, uint8_t state_before, const char *what)
{
    memset(&tally, 0, sizeof tally);
    state = HDLC_NDM;
    right_before = 0;
    start((const uint8_t[]){0x05, control}, 2);
    hdlc_nrm_inactivity(0);
    if (state_before == HDLC_NRM)
        hbus_ask((const uint8_t[]){0x05, 0x93}, 2);
    state = state_before;
    all_errors(same_state);
    same_state();
    TEST_ASSERT_EQUAL(patterns(clean.n), tally.cases);
    report(what);
}

static void test_snrm_and_disc(void)
{
    unnumbered(0x93, HDLC_NDM, "05 93");
    unnumbered(0x53, HDLC_NRM, "05 53");
}

/* TEST_FULL: all channels and values, so that every place of an inserted zero was met. */
static void test_all_control_frames_of_the_document(void)
{
    const unsigned step = getenv("TEST_FULL") ? STEP_FULL : 31;
    unsigned cases = 0, right = 0, controls = 0;
    for (unsigned k = 0; k < 32; k += step) {
        memset(&tally, 0, sizeof tally);
        tally.right = 100; /* not listed here */
        start((const uint8_t[]){0x05, 0x08, 0x02, (uint8_t)(k / 2), (uint8_t)(0x30 + k % 2)}, 5);
        all_errors(nothing);
        TEST_ASSERT_EQUAL(patterns(clean.n), tally.cases);
        cases += tally.cases, right += tally.right - 100, controls += tally.controls;
    }
    printf("all control frames: %u errors, %u lines were right frames, %u of them control commands\n", cases, right,
           controls);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_document_mode_in_every_mode_of_the_chip);
    RUN_TEST(test_i_frame);
    RUN_TEST(test_snrm_and_disc);
    RUN_TEST(test_a_damaged_line_that_is_a_right_frame_is_seen);
    RUN_TEST(test_all_control_frames_of_the_document);
    return UNITY_END();
}
