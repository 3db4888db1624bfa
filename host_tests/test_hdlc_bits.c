/* The wire's own encoder and decoder against vectors made by others (facts 2.6): octets, FCS, inserted zeros,
 * length on the line. Everything else in the HDLC tests is judged by this code. */
#include "sim/hdlc_bits.h"
#include "sim/random.h"
#include "unity.h"

#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

struct vector {
    const char *name;
    uint8_t n, octets[8], fcs[2];
    uint8_t inserted, bits;
};

static const struct vector vectors[] = {
    {"SNRM P", 2, {0x05, 0x93}, {0xED, 0xD7}, 1, 49},
    {"UA F", 2, {0x05, 0x73}, {0xE3, 0x30}, 0, 48},
    {"DISC P", 2, {0x05, 0x53}, {0xE1, 0x11}, 0, 48},
    {"DM F", 2, {0x05, 0x1F}, {0x89, 0x99}, 1, 49},
    {"RR P 0", 2, {0x05, 0x11}, {0xF7, 0x70}, 0, 48},
    {"RR F 1", 2, {0x05, 0x31}, {0xF5, 0x51}, 1, 49},
    {"I P 0/0", 4, {0x05, 0x10, 0x01, 0x03}, {0x5F, 0x3C}, 1, 65},
    {"I F 0/1", 5, {0x05, 0x30, 0x01, 0x03, 0x31}, {0x6F, 0xF5}, 0, 72},
    {"I F 0/1 analog", 6, {0x05, 0x30, 0x01, 0x02, 0x0F, 0xFF}, {0x6A, 0x12}, 1, 81},
    {"document 08", 4, {0x05, 0x08, 0x01, 0x03}, {0x08, 0x7F}, 1, 65},
    {"document 09", 5, {0x05, 0x09, 0x01, 0x03, 0x31}, {0xFE, 0x40}, 1, 73},
    {"document 08 to 00", 4, {0x00, 0x08, 0x01, 0x00}, {0xC4, 0x23}, 0, 64},
    {"document 08 to 1E, analog", 6, {0x1E, 0x08, 0x02, 0x01, 0x0F, 0xFF}, {0xA7, 0x39}, 2, 82},
    {"runs of ones", 5, {0x05, 0x10, 0xFF, 0xFF, 0xFF}, {0xC9, 0x1C}, 5, 77},
    {"FRMR 08 00 01", 5, {0x05, 0x97, 0x08, 0x00, 0x01}, {0x86, 0x87}, 0, 72},
    {"XID P", 2, {0x05, 0xBF}, {0x83, 0x3C}, 1, 49},
    {"TEST P 55 AA", 4, {0x05, 0xF3, 0x55, 0xAA}, {0xC6, 0x56}, 1, 65},
    {"SNRM P to all", 2, {0xFF, 0x93}, {0x95, 0x56}, 2, 50},
    {"DLMS", 5, {0xA0, 0x07, 0x03, 0x21, 0x93}, {0x0F, 0x01}, 0, 0},
    {"formal frame of a hardware re-creation", 2, {0x42, 0x13}, {0x8B, 0x58}, 0, 0},
};
#define VECTORS (sizeof vectors / sizeof vectors[0])

static void test_the_fcs_of_every_vector(void)
{
    for (unsigned i = 0; i < VECTORS; i++) {
        const struct vector *v = &vectors[i];
        const uint16_t fcs = hb_fcs(v->octets, v->n);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(v->fcs[0], (uint8_t)fcs, v->name);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(v->fcs[1], fcs >> 8, v->name);
    }
    TEST_ASSERT_EQUAL_HEX16(0x906E, hb_fcs((const uint8_t *)"123456789", 9)); /* the CRC's check value */
}

static void test_inserted_zeros_and_bits_on_the_line_of_every_vector(void)
{
    for (unsigned i = 0; i < VECTORS; i++) {
        const struct vector *v = &vectors[i];
        struct hb_line line = {0};
        hb_frame(&line, v->octets, v->n);
        if (v->bits == 0)
            continue;
        TEST_ASSERT_EQUAL_MESSAGE(v->inserted, line.inserted, v->name);
        TEST_ASSERT_EQUAL_MESSAGE(v->bits, line.n, v->name);
    }
}

static void test_snrm_bit_for_bit(void)
{
    static const char expected[] = "0111111010100000110010011011011111010101101111110";
    const uint8_t snrm[] = {0x05, 0x93};
    struct hb_line line = {0};
    char text[64] = {0};
    hb_frame(&line, snrm, sizeof snrm);
    for (unsigned i = 0; i < line.n; i++)
        text[i] = (char)('0' + line.bit[i]);
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void feed_and_expect(const struct hb_line *line, enum hb_event expected, struct hb_decoder *d)
{
    enum hb_event seen = HB_NOTHING;
    for (unsigned i = 0; i < line->n; i++) {
        const enum hb_event e = hb_decode(d, line->bit[i]);
        if (e != HB_NOTHING)
            seen = e;
    }
    TEST_ASSERT_EQUAL(expected, seen);
}

static void test_every_vector_is_decoded(void)
{
    for (unsigned i = 0; i < VECTORS; i++) {
        struct hb_line line = {0};
        struct hb_decoder d = {0};
        hb_frame(&line, vectors[i].octets, vectors[i].n);
        feed_and_expect(&line, HB_FRAME, &d);
        TEST_ASSERT_EQUAL(vectors[i].n, d.n);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(vectors[i].octets, d.octets, d.n);
    }
}

static void test_two_frames_may_share_a_flag_and_flags_a_zero(void)
{
    const uint8_t ua[] = {0x05, 0x73};
    struct hb_line line = {0};
    struct hb_decoder d = {0};
    unsigned frames = 0;
    hb_frame(&line, ua, 2);
    line.n -= 8; /* the closing flag is the opening one of the next frame */
    hb_frame(&line, ua, 2);
    hb_raw(&line, 0x3F, 7); /* 1111110: the next flag uses the last zero of this one */
    hb_stuffed(&line, ua, 2);
    hb_stuffed(&line, (const uint8_t[]){0xE3, 0x30}, 2);
    hb_flag(&line);
    for (unsigned i = 0; i < line.n; i++)
        frames += hb_decode(&d, line.bit[i]) == HB_FRAME;
    TEST_ASSERT_EQUAL(3, frames);
}

static void test_what_is_no_frame(void)
{
    const uint8_t ua[] = {0x05, 0x73, 0xE3, 0x31};
    struct hb_line line;
    struct hb_decoder d = {0};

    line = (struct hb_line){0}; /* last bit of the FCS is wrong */
    hb_flag(&line), hb_stuffed(&line, ua, 4), hb_flag(&line);
    feed_and_expect(&line, HB_BAD_FCS, &d);
    line = (struct hb_line){0}; /* 24 bits */
    hb_flag(&line), hb_stuffed(&line, ua, 3), hb_flag(&line);
    feed_and_expect(&line, HB_SHORT, &d);
    line = (struct hb_line){0}; /* 33 bits */
    hb_flag(&line), hb_stuffed(&line, ua, 4), hb_raw(&line, 0, 1), hb_flag(&line);
    feed_and_expect(&line, HB_UNALIGNED, &d);
    line = (struct hb_line){0}; /* seven ones */
    hb_flag(&line), hb_stuffed(&line, ua, 4), hb_raw(&line, 0x7F, 8);
    feed_and_expect(&line, HB_ABORT, &d);
    line = (struct hb_line){0};
    hb_raw(&line, 0x7FFF, 15);
    feed_and_expect(&line, HB_IDLE, &d);
}

static void test_random_frames_come_back(void)
{
    uint64_t random = 7;
    for (unsigned k = 0; k < 2000; k++) {
        uint8_t octets[HB_OCTETS];
        struct hb_line line = {0};
        struct hb_decoder d = {0};
        const unsigned n = 2u + sim_below(&random, HB_OCTETS - 1u);
        for (unsigned i = 0; i < n; i++)
            octets[i] = (uint8_t)(sim_random(&random) | (k & 1u ? sim_random(&random) : 0));
        hb_frame(&line, octets, n);
        feed_and_expect(&line, HB_FRAME, &d);
        TEST_ASSERT_EQUAL(n, d.n);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(octets, d.octets, n);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_fcs_of_every_vector);
    RUN_TEST(test_inserted_zeros_and_bits_on_the_line_of_every_vector);
    RUN_TEST(test_snrm_bit_for_bit);
    RUN_TEST(test_every_vector_is_decoded);
    RUN_TEST(test_two_frames_may_share_a_flag_and_flags_a_zero);
    RUN_TEST(test_what_is_no_frame);
    RUN_TEST(test_random_frames_come_back);
    return UNITY_END();
}
