/* Console input between an interrupt and the main loop. */
#include "hal/con_in.h"
#include "unity.h"

#define HOLDS 63u /* one cell of 64 tells full from empty */

void setUp(void)
{
    while (hal_con_get() >= 0) {
    }
}

void tearDown(void)
{
}

static void type(const char *text)
{
    for (; *text; text++)
        con_in_isr((uint8_t)*text);
}

static void expect(const char *text)
{
    for (; *text; text++)
        TEST_ASSERT_EQUAL_INT16(*text, hal_con_get());
}

static void test_nothing_typed_reads_as_minus_1(void)
{
    TEST_ASSERT_EQUAL_INT16(-1, hal_con_get());
}

static void test_octets_come_once_and_in_order(void)
{
    type("status\n");
    expect("sta");
    type("in 1 42\n");
    expect("tus\nin 1 42\n");
    TEST_ASSERT_EQUAL_INT16(-1, hal_con_get());
}

static void test_an_octet_above_127_is_not_taken_for_none(void)
{
    con_in_isr(0xFF);
    TEST_ASSERT_EQUAL_INT16(0xFF, hal_con_get());
}

static void test_what_does_not_fit_is_dropped_and_the_rest_stays(void)
{
    uint8_t i;
    for (i = 0; i < HOLDS + 5; i++)
        con_in_isr(i);
    for (i = 0; i < HOLDS; i++)
        TEST_ASSERT_EQUAL_INT16(i, hal_con_get());
    TEST_ASSERT_EQUAL_INT16(-1, hal_con_get());
}

static void test_it_goes_round(void)
{
    unsigned i;
    for (i = 0; i < 300; i++) {
        con_in_isr((uint8_t)i);
        con_in_isr((uint8_t)~i);
        TEST_ASSERT_EQUAL_INT16(i & 0xFF, hal_con_get());
        TEST_ASSERT_EQUAL_INT16(~i & 0xFF, hal_con_get());
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_typed_reads_as_minus_1);
    RUN_TEST(test_octets_come_once_and_in_order);
    RUN_TEST(test_an_octet_above_127_is_not_taken_for_none);
    RUN_TEST(test_what_does_not_fit_is_dropped_and_the_rest_stays);
    RUN_TEST(test_it_goes_round);
    return UNITY_END();
}
