/* The promises of hal.h, one after the other, on whatever machine this is compiled for. */
#include "hal_contract.h"

#define RATE       9600u
#define TBIT_10MS  96u
#define TBIT_LONG  (CONTRACT_LIMIT_MS * 96u / 10u)
#define QUIET_MS   200u
#define LONG       200u
#define SHORT      20u

static struct {
    volatile uint8_t silences;
    volatile uint8_t sents;
    volatile uint8_t octets;
    volatile uint8_t octets_when_sent;
    volatile uint8_t silences_when_sent;
    volatile uint8_t errs;
} seen;

static uint8_t XDATA got[256];
static uint8_t XDATA text[256];
static volatile hal_dur_t next_limit; /* line_silence_isr() sets it, once      */
static volatile uint8_t answer_len;   /* line_silence_isr() sends so much, once */
static hal_dur_t ten_ms, long_limit;  /* at RATE */

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    got[seen.octets] = octet;
    seen.octets++;
    seen.errs |= err;
}

void line_silence_isr(void) IN_ISR
{
    seen.silences++;
    if (next_limit) {
        hal_silence(next_limit);
        next_limit = 0;
    }
    if (answer_len) {
        hal_send(text, answer_len);
        answer_len = 0;
    }
}

void line_sent_isr(void) IN_ISR
{
    seen.octets_when_sent = seen.octets;
    seen.silences_when_sent = seen.silences;
    seen.sents++;
}

/* ---- time ------------------------------------------------------------------------------------------------ */

static uint16_t began;

static void start_clock(void)
{
    began = hal_ticks();
}

static uint16_t elapsed(void)
{
    return (uint16_t)(hal_ticks() - began);
}

static void sleep_until(uint16_t ms)
{
    while (elapsed() < ms)
        CONTRACT_STEP();
}

/* -> milliseconds on the clock when *count was n; a failure after two seconds. */
static uint16_t wait_for(volatile uint8_t *count, uint8_t n)
{
    while (*count < n && elapsed() < 2000u)
        CONTRACT_STEP();
    TEST_ASSERT_EQUAL_UINT8(n, *count);
    return elapsed();
}

static void is_between(uint16_t least, uint16_t ms)
{
    TEST_ASSERT_GREATER_OR_EQUAL_UINT16(least, ms);
    TEST_ASSERT_LESS_OR_EQUAL_UINT16(least + 2u + CONTRACT_LATE_MS, ms);
}

/* ---- before and after each ------------------------------------------------------------------------------- */

static void forget(void)
{
    seen.silences = 0;
    seen.sents = 0;
    seen.octets = 0;
    seen.octets_when_sent = 0;
    seen.silences_when_sent = 0;
    seen.errs = 0;
}

void setUp(void)
{
    uint8_t i = 0;

    next_limit = 0;
    answer_len = 0;
    do
        text[i] = (uint8_t)(i * 37u + 0x68u);
    while (++i);
    TEST_ASSERT_NOT_EQUAL(HAL_LINE_NO, hal_line_open(RATE, HAL_8E1));
    ten_ms = hal_tbit(TBIT_10MS);
    long_limit = hal_tbit(TBIT_LONG);
    TEST_ASSERT_NOT_EQUAL(HAL_LINE_NO, hal_line_open(RATE, HAL_8E1)); /* on a slow core that took time */
    forget();
    start_clock();
}

/* Nothing of this test comes in the next. */
void tearDown(void)
{
    uint8_t octets;
    uint8_t irq = hal_irq_save();

    hal_silence(0);
    hal_irq_restore(irq);
    do {
        octets = seen.octets;
        start_clock();
        sleep_until(QUIET_MS);
    } while (octets != seen.octets);
}

static void limit_is(hal_dur_t d)
{
    uint8_t irq = hal_irq_save();

    hal_silence(d);
    hal_irq_restore(irq);
}

static void send(uint8_t n)
{
    uint8_t irq = hal_irq_save();

    hal_send(text, n);
    hal_irq_restore(irq);
}

/* ---- machine --------------------------------------------------------------------------------------------- */

static void time_goes_by_for_a_main_loop_that_sleeps(void)
{
    uint16_t sleeps = 0;

    while (elapsed() < 100u && sleeps < 60000u) {
        CONTRACT_STEP();
        sleeps++;
    }
    is_between(100u, elapsed());
}

/* Our choice: 20 ms at most, whatever the limit of silence; the application's watchdogs and ramps count in ticks. */
static void a_long_limit_does_not_keep_the_main_loop_asleep(void)
{
    uint16_t before;
    uint8_t irq = hal_irq_save();

    hal_silence(hal_tbit(0xFFFF));
    hal_irq_restore(irq);
    while (elapsed() < 100u) {
        before = elapsed();
        CONTRACT_STEP();
        TEST_ASSERT_LESS_OR_EQUAL_UINT16(before + 20u + CONTRACT_LATE_MS, elapsed());
    }
}

static void non_volatile_cells_keep_what_was_written_last(void)
{
    uint8_t i;

    if (!CONTRACT_NV)
        TEST_IGNORE_MESSAGE("this machine or its model keeps nothing without power");
    for (i = 0; i < HAL_NV_SIZE; i++)
        TEST_ASSERT_TRUE(hal_nv_write(i, (uint8_t)(0x5Au ^ i)));
    for (i = 0; i < HAL_NV_SIZE; i++)
        TEST_ASSERT_EQUAL_HEX8(0x5Au ^ i, hal_nv_read(i));
    for (i = 1; i < HAL_NV_SIZE; i++)
        TEST_ASSERT_TRUE(hal_nv_write(i, 0xFF));
    TEST_ASSERT_EQUAL_HEX8(0x5A, hal_nv_read(0));
    TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(1));
    TEST_ASSERT_EQUAL_HEX8(0xFF, hal_nv_read(HAL_NV_SIZE - 1u));
}

/* More changes than a small page of flash has words. */
static void non_volatile_cells_take_many_changes(void)
{
    uint16_t i;

    if (!CONTRACT_NV)
        TEST_IGNORE_MESSAGE("this machine or its model keeps nothing without power");
    TEST_ASSERT_TRUE(hal_nv_write(7, 0xA7));
    for (i = 0; i < 600u; i++)
        TEST_ASSERT_TRUE(hal_nv_write(3, (uint8_t)i));
    TEST_ASSERT_EQUAL_HEX8(0xA7, hal_nv_read(7));
    TEST_ASSERT_EQUAL_HEX8(599u & 0xFFu, hal_nv_read(3));
}

static void masking_nests_and_masked_upcalls_are_late_but_not_lost(void)
{
    uint8_t outer = hal_irq_save();
    uint8_t inner = hal_irq_save();

    hal_silence(ten_ms);
    while (elapsed() < 50u)
        CONTRACT_SPEND();
    hal_irq_restore(inner);
    while (elapsed() < 60u)
        CONTRACT_SPEND();
    TEST_ASSERT_EQUAL_UINT8(0, seen.silences);
    hal_irq_restore(outer);
    wait_for(&seen.silences, 1);
}

/* ---- bit times ------------------------------------------------------------------------------------------- */

static void bit_times_are_rounded_up_and_grow_with_n(void)
{
    hal_dur_t one = hal_tbit(1);
    uint16_t n;

    TEST_ASSERT_TRUE(hal_tbit(0) == 0);
    TEST_ASSERT_TRUE(one >= 1);
    for (n = 1; n < 0x4000u; n = (uint16_t)(n * 2u)) {
        TEST_ASSERT_TRUE(hal_tbit((uint16_t)(2u * n)) - hal_tbit(n) <= hal_tbit(n)); /* saturated, maybe */
        TEST_ASSERT_TRUE(hal_tbit((uint16_t)(n + 1u)) >= hal_tbit(n));
        TEST_ASSERT_TRUE(hal_tbit((uint16_t)(n + 1u)) - hal_tbit(n) <= one);
    }
    TEST_ASSERT_TRUE(hal_tbit(0xFFFF) >= hal_tbit(0xFFFE));
    TEST_ASSERT_TRUE(hal_tbit(0xFFFE) >= hal_tbit(0x4000));
}

/* ---- silence --------------------------------------------------------------------------------------------- */

static void a_silence_is_reported_once_and_in_time(void)
{
    limit_is(long_limit);
    is_between(CONTRACT_LIMIT_MS - 1u, wait_for(&seen.silences, 1));
    sleep_until(350u);
    TEST_ASSERT_EQUAL_UINT8(1, seen.silences);
}

static void a_new_limit_reports_the_same_silence_again(void)
{
    limit_is(ten_ms);
    wait_for(&seen.silences, 1);
    limit_is(long_limit);
    is_between(CONTRACT_LIMIT_MS - 1u, wait_for(&seen.silences, 2));
}

static void a_silence_already_past_follows_at_once_but_not_inside_the_call(void)
{
    uint8_t irq;

    sleep_until(50u);
    irq = hal_irq_save();
    hal_silence(ten_ms);
    TEST_ASSERT_EQUAL_UINT8(0, seen.silences);
    hal_irq_restore(irq);
    start_clock();
    is_between(0u, wait_for(&seen.silences, 1));
}

static void without_a_limit_nothing_is_reported(void)
{
    limit_is(long_limit);
    sleep_until(50u);
    limit_is(0);
    sleep_until(250u);
    TEST_ASSERT_EQUAL_UINT8(0, seen.silences);
}

static void a_limit_set_in_the_upcall_counts_from_the_last_octet(void)
{
    next_limit = long_limit;
    limit_is(ten_ms);
    is_between(CONTRACT_LIMIT_MS - 1u, wait_for(&seen.silences, 2));
}

/* ---- the line -------------------------------------------------------------------------------------------- */

static void what_is_sent_is_not_heard_but_its_echo_is(void)
{
    uint8_t i;

    send(LONG);
    wait_for(&seen.sents, 1);
    if (CONTRACT_UART_TIMED) { /* 200 characters of 11 bits at 9600 bit/s: 229.2 ms */
        TEST_ASSERT_GREATER_OR_EQUAL_UINT16(229u, elapsed());
        TEST_ASSERT_LESS_OR_EQUAL_UINT16(231u + CONTRACT_LATE_MS + CONTRACT_TI_LATE_MS, elapsed());
    }
    TEST_ASSERT_EQUAL_UINT8(0, seen.octets_when_sent);
    start_clock();
    wait_for(&seen.octets, LONG);
    for (i = 0; i < LONG; i++)
        TEST_ASSERT_EQUAL_HEX8(text[i], got[i]);
    TEST_ASSERT_EQUAL_HEX8(0, seen.errs);
    sleep_until((uint16_t)(elapsed() + 50u));
    TEST_ASSERT_EQUAL_UINT8(LONG, seen.octets);
    TEST_ASSERT_EQUAL_UINT8(1, seen.sents);
}

static void one_octet_can_be_sent(void)
{
    send(1);
    wait_for(&seen.sents, 1);
    wait_for(&seen.octets, 1);
    TEST_ASSERT_EQUAL_HEX8(text[0], got[0]);
}

/* As a station answers: from the upcall of silence. */
static void sending_can_start_in_the_upcall_of_silence(void)
{
    answer_len = SHORT;
    limit_is(ten_ms);
    wait_for(&seen.sents, 1);
    start_clock();
    wait_for(&seen.octets, SHORT);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(text, got, SHORT);
}

static void no_silence_while_sending_and_then_from_the_last_stop_bit(void)
{
    uint8_t irq = hal_irq_save();

    hal_silence(ten_ms);
    hal_send(text, LONG);
    hal_irq_restore(irq);
    wait_for(&seen.sents, 1);
    start_clock();
    TEST_ASSERT_EQUAL_UINT8(0, seen.silences_when_sent);
    is_between(9u, wait_for(&seen.silences, 1));
    TEST_ASSERT_EQUAL_UINT8(0, seen.octets); /* the echo is yet to come */
}

static void each_octet_begins_a_new_silence_with_the_limit_as_it_was(void)
{
    limit_is(ten_ms);
    send(SHORT);
    wait_for(&seen.silences, 1);
    wait_for(&seen.octets, SHORT);
    start_clock();
    is_between(9u, wait_for(&seen.silences, 2));
    sleep_until(100u);
    TEST_ASSERT_EQUAL_UINT8(2, seen.silences);
}

static void in_a_loop_only_our_own_receiver_hears_us(void)
{
    if (!CONTRACT_LOOP)
        TEST_IGNORE_MESSAGE("QEMU's model of this UART has no loop");
    if (hal_line_open(RATE, HAL_8E1 | HAL_LOOP) == HAL_LINE_NO)
        TEST_IGNORE_MESSAGE("this machine has no loop");
    send(SHORT);
    wait_for(&seen.sents, 1);
    TEST_ASSERT_EQUAL_UINT8(SHORT, seen.octets_when_sent);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(text, got, SHORT);
    sleep_until(200u);
    TEST_ASSERT_EQUAL_UINT8(SHORT, seen.octets); /* no echo */
}

static void opening_again_ends_a_transmission_without_a_word(void)
{
    uint8_t irq = hal_irq_save();

    hal_silence(ten_ms);
    hal_send(text, LONG);
    TEST_ASSERT_NOT_EQUAL(HAL_LINE_NO, hal_line_open(RATE, HAL_8E1));
    hal_irq_restore(irq);
    sleep_until(350u);
    TEST_ASSERT_EQUAL_UINT8(0, seen.sents);
    TEST_ASSERT_EQUAL_UINT8(0, seen.silences); /* nor is there a limit any more */
}

static void what_cannot_be_opened_changes_nothing(void)
{
    limit_is(long_limit);
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(0, HAL_8E1));
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(13000000, HAL_8E1));
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(7777777, HAL_8E1));
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(RATE, HAL_FORMATS));
    is_between(CONTRACT_LIMIT_MS - 1u, wait_for(&seen.silences, 1));
    TEST_ASSERT_TRUE(long_limit == hal_tbit(TBIT_LONG));
}

int main(void)
{
    CONTRACT_BEGIN();
    UNITY_BEGIN();
    RUN_TEST(time_goes_by_for_a_main_loop_that_sleeps);
    RUN_TEST(a_long_limit_does_not_keep_the_main_loop_asleep);
    RUN_TEST(non_volatile_cells_keep_what_was_written_last);
    RUN_TEST(non_volatile_cells_take_many_changes);
    RUN_TEST(masking_nests_and_masked_upcalls_are_late_but_not_lost);
    RUN_TEST(bit_times_are_rounded_up_and_grow_with_n);
    RUN_TEST(a_silence_is_reported_once_and_in_time);
    RUN_TEST(a_new_limit_reports_the_same_silence_again);
    RUN_TEST(a_silence_already_past_follows_at_once_but_not_inside_the_call);
    RUN_TEST(without_a_limit_nothing_is_reported);
    RUN_TEST(a_limit_set_in_the_upcall_counts_from_the_last_octet);
    RUN_TEST(what_is_sent_is_not_heard_but_its_echo_is);
    RUN_TEST(one_octet_can_be_sent);
    RUN_TEST(sending_can_start_in_the_upcall_of_silence);
    RUN_TEST(no_silence_while_sending_and_then_from_the_last_stop_bit);
    RUN_TEST(each_octet_begins_a_new_silence_with_the_limit_as_it_was);
    RUN_TEST(in_a_loop_only_our_own_receiver_hears_us);
    RUN_TEST(opening_again_ends_a_transmission_without_a_word);
    RUN_TEST(what_cannot_be_opened_changes_nothing);
    return UNITY_END();
}
