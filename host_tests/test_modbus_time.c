/* What of the RTU line is a matter of time: on the virtual port only, which is exact to a fraction of a bit. The rest is in
 * test_modbus_line.c. [A] application protocol V1.1b3, [S] serial line V1.02. */
#include "hal_virtual.h"
#include "modbus_fixture.h"
#include "unity.h"

#define GOOD   "11 03 00 6B 00 01"
#define ANSWER "11 03 02 02 2B"

static const uint8_t request[] = {0x11, 0x06, 0x00, 0x01, 0x12, 0x34};

void setUp(void)
{
    fixture_begin(0x11, MB_RTU);
}

void tearDown(void)
{
    mbc_end();
}

static void test_rtu_answers_after_t35_and_not_before(void)
{
    static const struct {
        uint32_t rate;
        unsigned bits; /* 3.5 characters of 11 bits up to 19200; above it 1.75 ms: [S] 2.5.1.1 */
    } of[] = {{1200, 39}, {9600, 39}, {19200, 39}, {38400, 67}, {57600, 101}, {115200, 202}};
    static const uint8_t read[] = {0x11, 0x03, 0x00, 0x6B, 0x00, 0x01};
    for (unsigned i = 0; i < sizeof of / sizeof of[0]; i++) {
        mb_port.bit_per_s = of[i].rate;
        TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
        mbc_idle(300);
        mbc_send(&client, read, sizeof read);
        TEST_ASSERT_EQUAL(5, mbc_wait(&client, got));
        const unsigned poll = (unsigned)(100 * HV_US / hv_bit()) + 2; /* the main loop comes every 100 us */
        TEST_ASSERT_GREATER_OR_EQUAL(of[i].bits, client.answer_delay);
        TEST_ASSERT_LESS_OR_EQUAL(of[i].bits + poll, client.answer_delay);
        mbc_idle(300);
    }
}

static void test_rtu_a_client_may_ask_again_at_once(void)
{
    static const uint8_t read[] = {0x11, 0x03, 0x00, 0x6B, 0x00, 0x01};
    for (unsigned i = 0; i < 5; i++) {
        mbc_send(&client, read, sizeof read);
        while (client.heard_n < 7)
            hv_run_for(hv_bit());
        mbc_idle(11 + 2); /* the last octet has only begun */
    }
    mbc_send(&client, read, sizeof read);
    TEST_ASSERT_EQUAL(5, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL(6, mb_diag.counter[MB_BUS_MESSAGE]);
}

static void slow(void)
{
    hv_spend(200 * HV_MS);
}

static void test_a_late_answer_is_not_sent_into_the_next_request(void)
{
    uint8_t frame[MBC_FRAME_MAX];
    fx.slow = slow; /* the application is slow */
    mbc_send(&client, request, sizeof request);
    const unsigned n = mbc_frame(&client.coding, request, sizeof request, 0, frame);
    for (unsigned i = 0; i < n; i++) /* after 150 ms the client gives up and asks again */
        hv_inject(hv_now() + 150 * HV_MS + i * 11 * hv_bit(), frame[i], 0);
    client.time_out = 1000;
    TEST_ASSERT_EQUAL(0, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL(0, client.heard_n);
    TEST_ASSERT_EQUAL(1, fx.writes);
    fx.slow = NULL;
    ask(GOOD, ANSWER);
}

/* While the application was slow, somebody has begun a long frame whose end looks like a request to us; its
 * beginning was missed, at whatever octet the application came back. */
static void test_the_end_of_a_frame_is_not_a_frame(void)
{
    static const uint8_t other[] = {0x11, 0x06, 0x00, 0x02, 0x55, 0x55};
    uint8_t frame[MBC_FRAME_MAX];
    const unsigned n = mbc_frame(&client.coding, other, sizeof other, 0, frame);
    for (unsigned before = 80; before < 100; before++) { /* 200 ms are over after 91 octets */
        fixture_begin(0x11, MB_RTU);
        fx.slow = slow;
        mbc_send(&client, request, sizeof request);
        for (unsigned i = 0; i < before + n; i++)
            hv_inject(hv_now() + 150 * HV_MS + i * 11 * hv_bit(), i < before ? 0x77 : frame[i - before], 0);
        hv_run_for(HV_S);
        TEST_ASSERT_EQUAL(0, client.heard_n);
        TEST_ASSERT_EQUAL(1, fx.writes);
        TEST_ASSERT_EQUAL_HEX16(0, holding_0[2]);
        fx.slow = NULL;
        ask(GOOD, ANSWER);
    }
}

static void test_the_answer_is_sent_as_one_run_and_the_driver_drops_behind_it(void)
{
    ask(GOOD, ANSWER);
    TEST_ASSERT_EQUAL(7 * 11, client.answer_time);
    TEST_ASSERT_FALSE(hv_driver());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rtu_answers_after_t35_and_not_before);
    RUN_TEST(test_rtu_a_client_may_ask_again_at_once);
    RUN_TEST(test_a_late_answer_is_not_sent_into_the_next_request);
    RUN_TEST(test_the_end_of_a_frame_is_not_a_frame);
    RUN_TEST(test_the_answer_is_sent_as_one_run_and_the_driver_drops_behind_it);
    return UNITY_END();
}
