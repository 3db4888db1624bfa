/* Function 43/14 with objects of all three levels, and more of them than an answer holds. [A] 6.21. */
#include "modbus_fixture.h"
#include "unity.h"

#include <string.h>

#define TEXT_100                                                                                             \
    "aaaaaaaaaabbbbbbbbbbccccccccccddddddddddeeeeeeeeeeffffffffffgggggggggghhhhhhhhhhiiiiiiiiiijjjjjjjjjj"

const struct mb_object CODE mb_objects[] = {
    {0x00, "V"},      {0x01, "P"},      {0x02, "1"}, {0x04, "Product"},
    {0x80, TEXT_100}, {0x81, TEXT_100}, {0x90, ""},  {0xFF, TEXT_100 TEXT_100 TEXT_100},
    {0, NULL},
};

/* 43/13 is the application's: here it answers what it was asked, without the last octet. */
uint8_t mb_canopen_ind(void)
{
    if (mb_pdu_len < 4)
        return MB_ILLEGAL_VALUE;
    mb_pdu_len--;
    return MB_OK;
}

void setUp(void)
{
    fixture_begin(0x11, fixture_mode);
}

void tearDown(void)
{
    mbc_end();
}

/* -> octets of the answer's PDU */
static unsigned identify(uint8_t code, uint8_t object, uint8_t *pdu)
{
    const uint8_t request[] = {0x11, 0x2B, 0x0E, code, object};
    unsigned n;
    mbc_send(&client, request, sizeof request);
    n = mbc_wait(&client, got);
    TEST_ASSERT_GREATER_THAN(1, n);
    memcpy(pdu, got + 1, n - 1);
    mbc_idle(40);
    return n - 1;
}

static void test_each_level_has_its_objects(void)
{
    ask("11 2B 0E 01 00", "11 2B 0E 01 83 00 00 03 00 01 56 01 01 50 02 01 31");
    ask("11 2B 0E 02 00", "11 2B 0E 02 83 00 00 04 00 01 56 01 01 50 02 01 31 04 07 50 72 6F 64 75 63 74");
    ask("11 2B 0E 02 02", "11 2B 0E 02 83 00 00 02 02 01 31 04 07 50 72 6F 64 75 63 74");
    ask("11 2B 0E 01 04",
        "11 2B 0E 01 83 00 00 03 00 01 56 01 01 50 02 01 31"); /* not of this level: from 0 */
    ask("11 2B 0E 02 03", "11 2B 0E 02 83 00 00 04 00 01 56 01 01 50 02 01 31 04 07 50 72 6F 64 75 63 74");
}

static void test_a_stream_goes_on_where_more_follows(void)
{
    static uint8_t pdu[MBC_FRAME_MAX];
    unsigned n = identify(3, 0, pdu);
    TEST_ASSERT_EQUAL_HEX8(0x83, pdu[3]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, pdu[4]); /* more follows */
    TEST_ASSERT_EQUAL_HEX8(0xFF, pdu[5]); /* the last one does not fit any more */
    TEST_ASSERT_EQUAL(7, pdu[6]);
    TEST_ASSERT_EQUAL(7 + 3 * 3 + 9 + 2 * 102 + 2, n);
    n = identify(3, 0x81, pdu);
    TEST_ASSERT_EQUAL_HEX8(0xFF, pdu[4]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, pdu[5]);
    TEST_ASSERT_EQUAL(2, pdu[6]);
    TEST_ASSERT_EQUAL(7 + 102 + 2, n);
    n = identify(3, 0xFF, pdu);
    TEST_ASSERT_EQUAL_HEX8(0x00, pdu[4]);
    TEST_ASSERT_EQUAL_HEX8(0x00, pdu[5]);
    TEST_ASSERT_EQUAL(253, n); /* a text of 300 is cut at 244: an object is never split */
    TEST_ASSERT_EQUAL(244, pdu[8]);
}

static void test_one_object_alone(void)
{
    ask("11 2B 0E 04 04", "11 2B 0E 04 83 00 00 01 04 07 50 72 6F 64 75 63 74");
    ask("11 2B 0E 04 90", "11 2B 0E 04 83 00 00 01 90 00");
    ask("11 2B 0E 04 03", "11 AB 02");
}

static void test_canopen_is_routed_to_the_application(void)
{
    ask("11 2B 0D 01 02 03", "11 2B 0D 01 02");
    ask("11 2B 0D 01", "11 AB 03");
}

int main(void)
{
    UNITY_BEGIN();
    BOTH(test_each_level_has_its_objects);
    BOTH(test_a_stream_goes_on_where_more_follows);
    BOTH(test_one_object_alone);
    BOTH(test_canopen_is_routed_to_the_application);
    return UNITY_END();
}
