/* PROFIBUS-PA frames that are damaged: every error of up to three bits, and random octets. More than a simulated target can
 * do; what a frame is stands in test_pa_frame.c. */
#include "fdl/pa_frame.h"
#include "pa_vectors.h"
#include "sim/random.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

static uint8_t frame[PA_FRAME_MAX + 1];
static uint8_t body_len;

void setUp(void)
{
    memset(frame, 0x55, sizeof frame);
    body_len = 0x55;
}

void tearDown(void)
{
}

/* 259 - 249 = 10: judged in the width of the count, a frame of 265 octets would pass for one of 9. */
static void a_frame_longer_than_255_octets_is_rejected(void)
{
    uint8_t *const longer = calloc(1, 270);
    longer[0] = 0x10;
    for (uint16_t n = 256; n < 270; n++)
        TEST_ASSERT_EQUAL(PA_BAD_LENGTH, pa_decode(longer, n, &body_len));
    free(longer);
}

static void flip(unsigned bit)
{
    frame[bit / 8] ^= (uint8_t)(0x80u >> bit % 8);
}

/* HD = 4: exhaustive for the short formats. */
static void up_to_three_wrong_bits_in_a_short_frame_are_always_found(void)
{
    for (unsigned v = 0; v < VECTORS; v++) {
        const unsigned bits = vectors[v].n * 8u;
        memcpy(frame, vectors[v].frame, vectors[v].n);
        for (unsigned i = 0; i < bits; i++) {
            flip(i);
            TEST_ASSERT_NOT_EQUAL(PA_GOOD, pa_decode(frame, vectors[v].n, &body_len));
            for (unsigned j = i + 1; j < bits; j++) {
                flip(j);
                if (pa_decode(frame, vectors[v].n, &body_len) == PA_GOOD)
                    TEST_FAIL_MESSAGE("two wrong bits passed");
                for (unsigned k = j + 1; k < bits; k++) {
                    flip(k);
                    if (pa_decode(frame, vectors[v].n, &body_len) == PA_GOOD)
                        TEST_FAIL_MESSAGE("three wrong bits passed");
                    flip(k);
                }
                flip(j);
            }
            flip(i);
        }
    }
}

/* The CRC is linear: an error of bits i, j, k is found exactly when the three remainders do not cancel. So all
 * patterns of the longest frame can be asked about by remainders, without decoding each. */
static void up_to_three_wrong_bits_in_the_longest_frame_are_always_found(void)
{
    enum { BITS = 255 * 8 };
    static uint16_t remainder[BITS];
    static uint8_t seen[65536];
    uint16_t r = 1;
    for (unsigned i = 0; i < BITS; i++) { /* of x^i */
        remainder[i] = r;
        TEST_ASSERT_FALSE_MESSAGE(seen[r], "two wrong bits cancel");
        seen[r] = 1;
        r = (uint16_t)((r << 1) ^ (r & 0x8000 ? 0x1DCF : 0));
    }
    unsigned passed = 0;
    for (unsigned i = 0; i < BITS; i++)
        for (unsigned j = i + 1; j < BITS; j++)
            passed += seen[remainder[i] ^ remainder[j]];
    TEST_ASSERT_EQUAL_MESSAGE(0, passed, "three wrong bits cancel");
}

static void random_octets_practically_never_pass(void)
{
    uint64_t random = 99;
    const unsigned turns = getenv("TEST_FULL") ? 1000000 : 20000;
    unsigned good = 0;
    for (unsigned i = 0; i < turns; i++) {
        const uint16_t n = (uint16_t)sim_below(&random, 40);
        for (unsigned k = 0; k < n; k++)
            frame[k] = (uint8_t)sim_random(&random);
        good += pa_decode(frame, n, &body_len) == PA_GOOD;
    }
    TEST_ASSERT_LESS_THAN(3, good);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_frame_longer_than_255_octets_is_rejected);
    RUN_TEST(up_to_three_wrong_bits_in_a_short_frame_are_always_found);
    RUN_TEST(up_to_three_wrong_bits_in_the_longest_frame_are_always_found);
    RUN_TEST(random_octets_practically_never_pass);
    return UNITY_END();
}
