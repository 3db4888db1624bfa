/* Octet order: PROFIBUS and Modbus send the high octet of a 16-bit value first. */
#include "bytes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void the_high_octet_comes_first(void)
{
    static uint8_t XDATA octets[2] = {0x12, 0x34};

    TEST_ASSERT_EQUAL_HEX16(0x1234, get_u16be(octets));
    put_u16be(octets, 0xFE01);
    TEST_ASSERT_EQUAL_HEX8(0xFE, octets[0]);
    TEST_ASSERT_EQUAL_HEX8(0x01, octets[1]);
    TEST_ASSERT_EQUAL_HEX16(0xFE01, get_u16be(octets));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_high_octet_comes_first);
    return UNITY_END();
}
