/* The judge of the line catches each violation, and nothing that is right. The station here is a puppet: it
 * sends what the test says when the test says. */
#include "sim/bus.h"
#include "unity.h"

#include <string.h>

#define BIT     30000u /* 19200 bit/s */
#define T(tbit) ((hv_time)(tbit)*BIT)

static struct seg_party master, other;
static uint8_t heard[64], heard_err[64];
static hv_time heard_at[64];
static unsigned heard_n;
static uint8_t station_heard[300], station_err[300];
static unsigned station_n;

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    station_heard[station_n] = octet;
    station_err[station_n++] = err;
}

void line_silence_isr(void) IN_ISR
{
}

void line_sent_isr(void) IN_ISR
{
}

static void hears(struct seg_party *self, uint8_t octet, uint8_t err)
{
    (void)self;
    heard[heard_n] = octet;
    heard_err[heard_n] = err;
    heard_at[heard_n++] = hv_now();
}

void setUp(void)
{
    hv_begin();
    seg_begin(19200, 8);
    heard_n = station_n = 0;
    master = (struct seg_party){.name = "master", .judged = true, .hears = hears};
    other = (struct seg_party){.name = "other", .judged = true};
    seg_attach(&master);
    seg_attach(&other);
    hal_init();
    hal_line_open(19200, HAL_8E1);
    hal_irq_restore(HAL_IRQ_ON);
}

void tearDown(void)
{
}

static void say(void *octets, uint32_t n)
{
    const uint8_t state = hal_irq_save();
    hal_send(octets, (uint16_t)n);
    hal_irq_restore(state);
}

/* FDL status request of master 2 to station 8, answered; sums 08+02+49 = 53, 02+08+00 = 0A */
static const uint8_t request[] = {0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
static uint8_t answer[] = {0x10, 0x02, 0x08, 0x00, 0x0A, 0x16};
static const uint8_t to_another[] = {0x10, 0x09, 0x02, 0x49, 0x54, 0x16};

#define REQUEST_AT  HV_MS
#define REQUEST_END (REQUEST_AT + T(66))

static void ask_and_answer_after(hv_time idle)
{
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_at(REQUEST_END + idle, say, answer, sizeof answer);
    hv_run_until(HV_S);
}

#define ONLY(rule) only((rule), __LINE__)

/* Exactly this rule was broken (SEG_RULES: none). */
static void only(enum seg_rule rule, int line)
{
    const char *const verdict = seg_verdict();
    for (unsigned r = 0; r < SEG_RULES; r++)
        UNITY_TEST_ASSERT_EQUAL_UINT(r == rule, seg_count((enum seg_rule)r) > 0, (unsigned)line, verdict);
    UNITY_TEST_ASSERT((verdict == NULL) == (rule == SEG_RULES), (unsigned)line, "verdict");
    TEST_ASSERT_NULL_MESSAGE(seg_verdict(), "told once");
}

static void a_good_exchange_is_not_objected_to(void)
{
    ask_and_answer_after(T(11));
    ONLY(SEG_RULES);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(answer, heard, sizeof answer);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(request, station_heard, sizeof request);
    TEST_ASSERT_EQUAL_UINT64(REQUEST_END + T(22), heard_at[0]);
    TEST_ASSERT_EQUAL_UINT64(T(11), seg_said.t_sdr);
}

static void an_answer_at_max_T_SDR_is_in_time(void)
{
    ask_and_answer_after(T(60));
    ONLY(SEG_RULES);
}

static void an_answer_one_tick_before_min_T_SDR_is_early(void)
{
    ask_and_answer_after(T(11) - 1);
    ONLY(SEG_EARLY);
}

static void an_answer_one_tick_after_max_T_SDR_is_late(void)
{
    ask_and_answer_after(T(60) + 1);
    ONLY(SEG_LATE);
}

static void a_longer_min_T_SDR_is_demanded_when_set(void)
{
    seg_set_min_t_sdr(50);
    ask_and_answer_after(T(49));
    ONLY(SEG_EARLY);
}

static void an_answer_for_another_station_is_unasked(void)
{
    seg_send(&master, REQUEST_AT, to_another, sizeof to_another, 0);
    hv_at(REQUEST_END + T(11), say, answer, sizeof answer);
    hv_run_until(HV_S);
    ONLY(SEG_UNASKED);
}

static void an_answer_to_a_damaged_request_is_unasked(void)
{
    static const uint8_t damage[sizeof request] = {0, 0, HAL_ERR_PARITY};
    master.judged = false;
    seg_send(&master, REQUEST_AT, request, sizeof request, damage);
    hv_at(REQUEST_END + T(11), say, answer, sizeof answer);
    hv_run_until(HV_S);
    ONLY(SEG_UNASKED);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_PARITY, station_err[2]);
}

static void a_request_of_the_station_is_unasked(void)
{
    static uint8_t poll[] = {0x10, 0x02, 0x08, 0x49, 0x53, 0x16};
    hv_at(HV_MS, say, poll, sizeof poll);
    hv_run_until(HV_S);
    TEST_ASSERT_GREATER_THAN(0, seg_count(SEG_UNASKED));
}

static void a_request_needs_33_bit_times_of_silence(void)
{
    ask_and_answer_after(T(11));
    seg_send(&master, HV_S, request, sizeof request, 0);
    hv_at(HV_S + T(66 + 11), say, answer, sizeof answer);
    seg_send(&master, HV_S + T(66 + 11 + 66 + 33), to_another, sizeof to_another, 0);
    hv_run_until(2 * HV_S);
    ONLY(SEG_RULES);
    seg_send(&master, 2 * HV_S, to_another, sizeof to_another, 0);
    seg_send(&master, 2 * HV_S + T(66 + 33) - 1, to_another, sizeof to_another, 0);
    hv_run_until(3 * HV_S);
    ONLY(SEG_NO_SYN);
}

static void two_at_once_collide_and_spoil_each_other(void)
{
    seg_send(&other, REQUEST_AT + T(20), to_another, 1, 0);
    ask_and_answer_after(T(11));
    TEST_ASSERT_GREATER_THAN(0, seg_count(SEG_COLLISION));
    TEST_ASSERT_EQUAL_HEX8(0, station_err[0]);
    TEST_ASSERT_NOT_EQUAL(0, station_err[1]);
}

static void a_gap_inside_a_telegram_is_seen(void)
{
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_at(REQUEST_END + T(11), say, answer, 3);
    hv_at(REQUEST_END + T(11 + 33 + 1), say, answer + 3, 3);
    hv_run_until(HV_S);
    ONLY(SEG_GAP);
}

static void a_telegram_cut_short_is_malformed(void)
{
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_at(REQUEST_END + T(11), say, answer, 3);
    hv_run_until(HV_S);
    ONLY(SEG_MALFORMED);
}

static void a_wrong_FCS_is_malformed(void)
{
    static uint8_t wrong[] = {0x10, 0x02, 0x08, 0x00, 0x0B, 0x16};
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_at(REQUEST_END + T(11), say, wrong, sizeof wrong);
    hv_run_until(HV_S);
    ONLY(SEG_MALFORMED);
}

static void a_driver_left_on_is_seen_at_the_end_of_the_test(void)
{
    ask_and_answer_after(T(11));
    seg_wire.driver(true);
    hv_run_for(HV_MS);
    ONLY(SEG_DRIVER);
}

static void a_driver_dropped_late_is_seen(void)
{
    ask_and_answer_after(T(11));
    seg_wire.driver(true);
    hv_run_for(T(1));
    seg_wire.driver(false);
    ONLY(SEG_DRIVER);
}

static void a_driver_left_on_collides_with_the_next_request(void)
{
    seg_wire.driver(true);
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_run_until(REQUEST_END);
    TEST_ASSERT_GREATER_THAN(0, seg_count(SEG_COLLISION));
}

/* ---- levels and rates ---------------------------------------------------------------------------------- */

static void the_same_octet_is_heard_from_its_levels(void)
{
    uint8_t level[2 * 11];
    uart_levels(0x68, level);
    uart_levels(0x05, level + 11);
    seg_send_levels(&master, level, sizeof level);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(2, station_n);
    TEST_ASSERT_EQUAL_HEX8(0x68, station_heard[0]);
    TEST_ASSERT_EQUAL_HEX8(0x05, station_heard[1]);
    TEST_ASSERT_EQUAL_HEX8(0, station_err[0] | station_err[1]);
}

static void a_turned_parity_or_stop_bit_is_flagged(void)
{
    uint8_t level[11];
    uart_levels(0x68, level);
    level[9] ^= 1;
    seg_send_levels(&master, level, sizeof level);
    hv_run_for(HV_S);
    level[9] ^= 1;
    level[10] = 0;
    seg_send_levels(&master, level, sizeof level);
    hv_run_for(HV_S);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_PARITY, station_err[0]);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_FRAMING, station_err[1]);
}

static void a_station_on_another_rate_hears_rubbish_with_errors(void)
{
    hal_line_open(93750, HAL_8E1);
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_run_until(HV_S);
    unsigned errors = 0;
    for (unsigned i = 0; i < station_n; i++)
        errors += station_err[i] != 0;
    TEST_ASSERT_GREATER_THAN(0, station_n);
    TEST_ASSERT_GREATER_THAN(0, errors);
}

static void a_deviation_of_three_per_mille_is_heard_well(void)
{
    master.bit = BIT + BIT * 3 / 1000;
    seg_send(&master, REQUEST_AT, request, sizeof request, 0);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(sizeof request, station_n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(request, station_heard, sizeof request);
    for (unsigned i = 0; i < station_n; i++)
        TEST_ASSERT_EQUAL_HEX8(0, station_err[i]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_good_exchange_is_not_objected_to);
    RUN_TEST(an_answer_at_max_T_SDR_is_in_time);
    RUN_TEST(an_answer_one_tick_before_min_T_SDR_is_early);
    RUN_TEST(an_answer_one_tick_after_max_T_SDR_is_late);
    RUN_TEST(a_longer_min_T_SDR_is_demanded_when_set);
    RUN_TEST(an_answer_for_another_station_is_unasked);
    RUN_TEST(an_answer_to_a_damaged_request_is_unasked);
    RUN_TEST(a_request_of_the_station_is_unasked);
    RUN_TEST(a_request_needs_33_bit_times_of_silence);
    RUN_TEST(two_at_once_collide_and_spoil_each_other);
    RUN_TEST(a_gap_inside_a_telegram_is_seen);
    RUN_TEST(a_telegram_cut_short_is_malformed);
    RUN_TEST(a_wrong_FCS_is_malformed);
    RUN_TEST(a_driver_left_on_is_seen_at_the_end_of_the_test);
    RUN_TEST(a_driver_dropped_late_is_seen);
    RUN_TEST(a_driver_left_on_collides_with_the_next_request);
    RUN_TEST(the_same_octet_is_heard_from_its_levels);
    RUN_TEST(a_turned_parity_or_stop_bit_is_flagged);
    RUN_TEST(a_station_on_another_rate_hears_rubbish_with_errors);
    RUN_TEST(a_deviation_of_three_per_mille_is_heard_well);
    return UNITY_END();
}
