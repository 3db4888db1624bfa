/* The CRC of Modbus in its three shapes: as the CRC catalogue and the standard's own examples have it. */
#include "crc16.h"
#include "unity.h"

#include <string.h>

void setUp(void)
{
}

void tearDown(void)
{
}

static uint16_t crc_of(const char *octets, unsigned n)
{
    uint16_t crc = CRC16_START;
    while (n--)
        crc = crc16_add(crc, (uint8_t)*octets++);
    return crc;
}

static void test_the_check_value_of_the_catalogue(void)
{
    TEST_ASSERT_EQUAL_HEX16(0x4B37, crc_of("123456789", 9)); /* CRC-16/MODBUS */
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, crc_of("", 0));
}

static void test_over_a_whole_frame_it_is_zero(void)
{
    TEST_ASSERT_EQUAL_HEX16(0x1241, crc_of("\x02\x07", 2)); /* Modbus over serial line V1.02, 6.2.2: 41H is sent first */
    TEST_ASSERT_EQUAL_HEX16(0, crc_of("\x02\x07\x41\x12", 4));
    TEST_ASSERT_EQUAL_HEX16(0, crc_of("\x11\x03\x00\x6B\x00\x03\x76\x87", 8));
}

static HOT uint16_t taken;

/* By the polynomial: x^16 + x^15 + x^2 + 1, least significant bit first. */
static void test_every_octet(void)
{
    unsigned octet, bit;
    for (octet = 0; octet < 256; octet++) {
        uint16_t crc = (uint16_t)(0xFF00u | octet);
        for (bit = 0; bit < 8; bit++)
            crc = (uint16_t)(crc & 1u ? (crc >> 1) ^ 0xA001u : crc >> 1);
        TEST_ASSERT_EQUAL_HEX16(crc, crc16_add(0xFF00, (uint8_t)octet));
        taken = 0xFF00;
        crc16_take(&taken, (uint8_t)octet);
        TEST_ASSERT_EQUAL_HEX16(crc, taken);
    }
}

static uint8_t XDATA frame[260];

static void test_it_is_put_behind_the_octets_low_first(void)
{
    static const uint8_t CODE whole[] = {0x02, 0x07, 0x41, 0x12, 0xEE}; /* 6.2.2, as above */
    unsigned at;
    memset(frame, 0xEE, sizeof frame);
    frame[0] = whole[0];
    frame[1] = whole[1];
    crc16_append(frame, 2);
    for (at = 0; at < sizeof whole; at++)
        TEST_ASSERT_EQUAL_HEX8(whole[at], frame[at]);
}

static void test_it_is_put_behind_one_octet(void)
{
    frame[0] = 0x00;
    crc16_append(frame, 1);
    TEST_ASSERT_EQUAL_HEX8(0x00, frame[0]);
    TEST_ASSERT_EQUAL_HEX8(0xBF, frame[1]); /* FF00H through the polynomial eight times: 40BFH */
    TEST_ASSERT_EQUAL_HEX8(0x40, frame[2]);
}

/* More than a page of memory, so that they lie over the edge of one. */
static void test_it_is_put_behind_255_octets(void)
{
    unsigned at;
    for (at = 0; at < sizeof frame; at++)
        frame[at] = (uint8_t)(7u * at);
    crc16_append(frame + 1, 255);
    for (at = 0; at < sizeof frame; at++)
        if (at != 256 && at != 257)
            TEST_ASSERT_EQUAL_HEX8(7u * at & 0xFFu, frame[at]);
    TEST_ASSERT_EQUAL_HEX16(0, crc_of((const char *)frame + 1, 257));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_check_value_of_the_catalogue);
    RUN_TEST(test_over_a_whole_frame_it_is_zero);
    RUN_TEST(test_every_octet);
    RUN_TEST(test_it_is_put_behind_the_octets_low_first);
    RUN_TEST(test_it_is_put_behind_one_octet);
    RUN_TEST(test_it_is_put_behind_255_octets);
    return UNITY_END();
}
