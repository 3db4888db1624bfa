/* PROFIBUS-PA frames. CRCs: worked bit by bit from the polynomial (facts, section 6; check value of the CRC
 * catalogue's CRC-16/PROFIBUS), octets written out here. */
#include "fdl/pa_frame.h"
#include "pa_vectors.h"
#include "unity.h"

#include <string.h>

static uint8_t frame[PA_FRAME_MAX + 1], body[PA_BODY_MAX];
static uint8_t body_len;

void setUp(void)
{
    memset(frame, 0x55, sizeof frame);
    body_len = 0x55;
}

void tearDown(void)
{
}

static uint16_t crc_of(const void *octets, unsigned n)
{
    const uint8_t *o = octets;
    uint16_t crc = 0xFFFF;
    while (n--)
        crc = pa_crc_add(crc, *o++);
    return crc;
}

static void the_crc_is_the_catalogues(void)
{
    TEST_ASSERT_EQUAL_HEX16(0xA819, crc_of("123456789", 9) ^ 0xFFFF);
    TEST_ASSERT_EQUAL_HEX16(0x547A, crc_of("\x08\x02\x49", 3) ^ 0xFFFF);
    TEST_ASSERT_EQUAL_HEX16(0x19EB, crc_of("\x68\x88\x82\x6D\x3C\x3E", 6) ^ 0xFFFF);
}

static void each_format_is_encoded_octet_by_octet(void)
{
    for (unsigned i = 0; i < VECTORS; i++) {
        const struct vector *v = &vectors[i];
        memset(frame, 0x55, sizeof frame);
        memcpy(body, v->body, v->len);
        TEST_ASSERT_EQUAL(v->n, pa_encode(v->sdl, body, v->len, frame));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(v->frame, frame, v->n);
        TEST_ASSERT_EQUAL_HEX8(0x55, frame[v->n]);
    }
}

static void each_format_is_decoded(void)
{
    for (unsigned i = 0; i < VECTORS; i++) {
        const struct vector *v = &vectors[i];
        memcpy(frame, v->frame, v->n);
        TEST_ASSERT_EQUAL(PA_GOOD, pa_decode(frame, v->n, &body_len));
        TEST_ASSERT_EQUAL(v->len, body_len);
        if (v->len)
            TEST_ASSERT_EQUAL_HEX8_ARRAY(v->body, frame + pa_body_at(v->sdl), v->len);
        TEST_ASSERT_EQUAL_HEX16(0xE394, crc_of(frame, v->n));
    }
}

static void a_body_that_does_not_suit_its_format_is_not_encoded(void)
{
    static const uint8_t wrong[][2] = {{0x10, 2},  {0x10, 4}, {0x68, 3}, {0x68, 250}, {0xA2, 10},
                                       {0xA2, 12}, {0xDC, 3}, {0xDC, 1}, {0xE5, 1},   {0x16, 3}};
    for (unsigned i = 0; i < sizeof wrong / 2; i++)
        TEST_ASSERT_EQUAL(0, pa_encode(wrong[i][0], body, wrong[i][1], frame));
    TEST_ASSERT_EQUAL_HEX8(0x55, frame[0]);
}

static void every_length_of_sdl2_goes_there_and_back(void)
{
    uint8_t n;
    for (unsigned len = 4; len <= 249; len++) {
        for (unsigned i = 0; i < len; i++)
            body[i] = (uint8_t)(i * 37u + len);
        n = pa_encode(PA_SDL2, body, (uint8_t)len, frame);
        TEST_ASSERT_EQUAL(len + 6, n);
        TEST_ASSERT_EQUAL(PA_GOOD, pa_decode(frame, n, &body_len));
        TEST_ASSERT_EQUAL(len, body_len);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(body, frame + 4, len);
    }
}

/* Each of these has a right CRC: only the length rule is broken. */
static unsigned with_crc(unsigned n)
{
    const uint16_t crc = (uint16_t)~crc_of(frame, n);
    frame[n] = (uint8_t)(crc >> 8);
    frame[n + 1] = (uint8_t)crc;
    return n + 2;
}

static void broken_length_rules_are_rejected_though_the_crc_is_right(void)
{
    static const uint8_t start[][10] = {
        {0x68, 5, 6, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E}, /* LE != LEr       */
        {0x68, 4, 4, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E}, /* LE too small    */
        {0x68, 6, 6, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E}, /* LE too large    */
        {0x68, 5, 5, 0x10, 0x88, 0x82, 0x6D, 0x3C, 0x3E}, /* no second SDL2  */
        {0x10, 1, 2, 0x49, 0, 0, 0, 0, 0},                /* SDL1 with data  */
        {0xE5, 1, 2, 0x49, 0, 0, 0, 0, 0},                /* acknowledge with data */
    };
    for (unsigned i = 0; i < sizeof start / sizeof start[0]; i++) {
        memcpy(frame, start[i], 9);
        TEST_ASSERT_EQUAL(PA_BAD_LENGTH, pa_decode(frame, (uint16_t)with_crc(9), &body_len));
    }
    memcpy(frame, "\x68\x03\x03\x68\x08\x02\x49", 7); /* LE 3 */
    TEST_ASSERT_EQUAL(PA_BAD_LENGTH, pa_decode(frame, (uint16_t)with_crc(7), &body_len));
    memcpy(frame, "\x16\x08\x02\x49", 4);
    TEST_ASSERT_EQUAL(PA_BAD_SDL, pa_decode(frame, (uint16_t)with_crc(4), &body_len));
    memcpy(frame, "\xE5\x14\x26", 3);
    for (uint16_t n = 0; n < 3; n++)
        TEST_ASSERT_EQUAL(PA_BAD_LENGTH, pa_decode(frame, n, &body_len));
    TEST_ASSERT_EQUAL_HEX8(0x55, body_len);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_crc_is_the_catalogues);
    RUN_TEST(each_format_is_encoded_octet_by_octet);
    RUN_TEST(each_format_is_decoded);
    RUN_TEST(a_body_that_does_not_suit_its_format_is_not_encoded);
    RUN_TEST(every_length_of_sdl2_goes_there_and_back);
    RUN_TEST(broken_length_rules_are_rejected_though_the_crc_is_right);
    return UNITY_END();
}
