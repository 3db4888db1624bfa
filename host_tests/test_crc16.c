/* The CRC of Modbus in its three shapes: as the CRC catalogue and the standard's own examples have it. */
#include "crc16.h"
#include "unity.h"

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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_check_value_of_the_catalogue);
    RUN_TEST(test_over_a_whole_frame_it_is_zero);
    RUN_TEST(test_every_octet);
    return UNITY_END();
}
