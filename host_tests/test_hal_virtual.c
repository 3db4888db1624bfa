/* The port in virtual time keeps the promises of hal.h to the tick, and notices who breaks its rules. */
#include "hal_virtual.h"
#include "unity.h"

#include <string.h>

#define BIT  30000u /* 19200 bit/s in 1/576 us */
#define CHAR (11u * BIT)

static struct {
    uint8_t octets[64], errs[64];
    hv_time octet_at[64], silence_at[8], sent_at[8];
    unsigned octets_n, silences, sents;
    hv_time starts[64], ends[64], on_at, off_at;
    unsigned wire_n;
} seen;

static hal_dur_t after_octet; /* the station under test asks for this silence at each octet */
static uint16_t answer_n;     /* and answers a silence with this many octets, once */
static uint8_t answer[4] = {0x11, 0x22, 0x33, 0x44};
static bool misuse;

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    seen.octet_at[seen.octets_n] = hv_now();
    seen.errs[seen.octets_n] = err;
    seen.octets[seen.octets_n++] = octet;
    if (after_octet)
        hal_silence(after_octet);
    if (misuse)
        hal_ticks();
}

void line_silence_isr(void) IN_ISR
{
    seen.silence_at[seen.silences++] = hv_now();
    if (answer_n) {
        hal_send(answer, answer_n);
        answer_n = 0;
    }
}

void line_sent_isr(void) IN_ISR
{
    seen.sent_at[seen.sents++] = hv_now();
}

static void wire_octet(uint8_t octet, hv_time start, hv_time end)
{
    TEST_ASSERT_EQUAL_HEX8(answer[seen.wire_n], octet);
    seen.starts[seen.wire_n] = start;
    seen.ends[seen.wire_n++] = end;
}

static void wire_driver(bool on)
{
    *(on ? &seen.on_at : &seen.off_at) = hv_now();
}

static char failure[80];

static void note_failure(const char *what)
{
    strncpy(failure, what, sizeof failure - 1);
}

void setUp(void)
{
    static const struct hv_wire wire = {wire_octet, wire_driver};
    memset(&seen, 0, sizeof seen);
    memset(failure, 0, sizeof failure);
    after_octet = 0;
    answer_n = 0;
    misuse = false;
    hv_begin();
    hv_on_failure = note_failure;
    hv_set_wire(&wire);
    hal_init();
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, hal_line_open(19200, HAL_8E1));
    hal_irq_restore(HAL_IRQ_ON);
}

void tearDown(void)
{
}

#define AT(expected, time) TEST_ASSERT_EQUAL_UINT64((hv_time)(expected), (time))

static void an_octet_is_delivered_at_the_end_of_its_stop_bit_with_its_flags(void)
{
    hv_inject(1000, 0x68, HAL_ERR_PARITY);
    hv_inject(1000 + CHAR, 0x05, 0);
    hv_run_until(HV_MS);
    TEST_ASSERT_EQUAL(2, seen.octets_n);
    AT(1000, seen.octet_at[0]);
    AT(1000 + CHAR, seen.octet_at[1]);
    TEST_ASSERT_EQUAL_HEX8(0x68, seen.octets[0]);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_PARITY, seen.errs[0]);
    TEST_ASSERT_EQUAL_HEX8(0, seen.errs[1]);
}

static void silence_fires_once_at_the_limit_after_the_last_octet(void)
{
    after_octet = hal_tbit(33);
    hv_inject(1000, 0x16, 0);
    hv_inject(1000 + 33 * BIT, 0x16, 0); /* at the limit: the receiver comes first */
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(1, seen.silences);
    AT(1000 + 66 * BIT, seen.silence_at[0]);
}

static void a_limit_already_past_fires_at_once_as_its_own_interrupt(void)
{
    hv_inject(1000, 0x16, 0);
    hv_run_until(HV_S);
    const uint8_t state = hal_irq_save();
    hal_silence(hal_tbit(33));
    TEST_ASSERT_EQUAL(0, seen.silences);
    hal_irq_restore(state);
    TEST_ASSERT_EQUAL(1, seen.silences);
    AT(HV_S, seen.silence_at[0]);
    hv_run_for(HV_S);
    TEST_ASSERT_EQUAL_MESSAGE(1, seen.silences, "once per silence and limit");
}

static void no_limit_no_interrupt(void)
{
    after_octet = hal_tbit(33);
    hv_inject(1000, 0x16, 0);
    hv_run_until(2000);
    const uint8_t state = hal_irq_save();
    hal_silence(0);
    hal_irq_restore(state);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(0, seen.silences);
}

static void an_answer_leaves_without_gaps_and_the_driver_drops_with_the_last_stop_bit(void)
{
    const hv_time start = 1000 + 11 * BIT;
    after_octet = hal_tbit(11);
    answer_n = 4;
    hv_inject(1000, 0x16, 0);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(4, seen.wire_n);
    AT(start, seen.on_at);
    AT(start, seen.starts[0]);
    for (unsigned i = 1; i < 4; i++)
        AT(seen.ends[i - 1], seen.starts[i]);
    AT(start + 4 * CHAR, seen.ends[3]);
    AT(start + 4 * CHAR, seen.off_at);
    AT(start + 4 * CHAR, seen.sent_at[0]);
    AT(start + 4 * CHAR + 11 * BIT, seen.silence_at[1]);
    TEST_ASSERT_EQUAL_MESSAGE(1, seen.octets_n, "own octets are not received");
}

static void in_loop_mode_only_our_own_receiver_hears_us(void)
{
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, hal_line_open(19200, HAL_8E1 | HAL_LOOP));
    const uint8_t state = hal_irq_save();
    hal_send(answer, 2);
    hal_irq_restore(state);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(2, seen.octets_n);
    AT(CHAR, seen.octet_at[0]);
    AT(2 * CHAR, seen.sent_at[0]);
    TEST_ASSERT_EQUAL(0, seen.wire_n);
    AT(0, seen.on_at);
}

static void masked_interrupts_are_late_but_not_lost(void)
{
    hv_inject(1000, 0x42, 0);
    hv_inject(1000 + CHAR, 0x43, 0);
    hv_port.fifo = 2;
    const uint8_t state = hal_irq_save();
    hv_spend(HV_MS);
    TEST_ASSERT_EQUAL(0, seen.octets_n);
    hal_irq_restore(state);
    TEST_ASSERT_EQUAL(2, seen.octets_n);
    AT(HV_MS, seen.octet_at[0]);
}

static void a_full_receiver_marks_the_octet_after_the_lost_one(void)
{
    for (unsigned i = 0; i < 3; i++)
        hv_inject(1000 + i * CHAR, (uint8_t)i, 0);
    hv_inject(2 * HV_MS, 0x77, 0);
    const uint8_t state = hal_irq_save();
    hv_spend(3 * HV_MS / 2);
    hal_irq_restore(state);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(2, seen.octets_n);
    TEST_ASSERT_EQUAL_HEX8(0, seen.errs[0]);
    TEST_ASSERT_EQUAL_HEX8(0x77, seen.octets[1]);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_OVERRUN, seen.errs[1]);
    TEST_ASSERT_EQUAL(2, hv_seen.octets_lost);
}

static void every_rate_has_a_whole_bit_time_and_a_board_may_refuse(void)
{
    static const uint32_t some[] = {9600, 19200, 0};
    AT(60000, hv_bit_of(9600));
    AT(12672, hv_bit_of(45450)); /* 12 MHz / 264: 264 / 12 us x 576 */
    AT(6144, hv_bit_of(93750));
    AT(48, hv_bit_of(12000000));
    AT(5000, hv_bit_of(115200));
    AT(0, hv_bit_of(12345));
    hv_port.rates = some;
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(500000, HAL_8E1));
    AT(BIT, hv_bit());
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, hal_line_open(9600, HAL_8N1));
    TEST_ASSERT_EQUAL(10, hv_char_bits());
}

static unsigned boots;

static void boot(void)
{
    boots++;
    hal_init();
    hal_line_open(19200, HAL_8E1);
    hal_irq_restore(HAL_IRQ_ON);
}

static void reset_from_the_loop(void)
{
    if (hal_ticks() >= 5 && hal_nv_read(3) == 0xFF) {
        TEST_ASSERT_TRUE(hal_nv_write(3, 0x12));
        hal_reset(HAL_RESET_ASKED);
    }
}

static void a_reset_boots_again_and_keeps_the_non_volatile_memory(void)
{
    boots = 0;
    hv_set_boot(boot);
    hv_power_on();
    hv_set_loop(reset_from_the_loop, NULL);
    hv_run_until(HV_S);
    TEST_ASSERT_EQUAL(2, boots);
    TEST_ASSERT_EQUAL(1, hv_seen.resets);
    TEST_ASSERT_EQUAL_HEX8(0x12, hv_nv[3]);
    TEST_ASSERT_EQUAL_MESSAGE(995, hal_ticks(), "ticks start again");
}

static void wrong_use_of_the_port_is_reported(void)
{
    hal_silence(5);
    TEST_ASSERT_EQUAL_STRING("hal_silence called in main with interrupts on", failure);
    misuse = true;
    hv_inject(1000, 0x16, 0);
    hv_run_until(HV_MS);
    TEST_ASSERT_EQUAL_STRING("hal_ticks called in an interrupt", failure);
    hal_irq_save();
    hal_send(answer, 1);
    hal_send(answer, 1);
    TEST_ASSERT_EQUAL_STRING("hal_send while sending", failure);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_octet_is_delivered_at_the_end_of_its_stop_bit_with_its_flags);
    RUN_TEST(silence_fires_once_at_the_limit_after_the_last_octet);
    RUN_TEST(a_limit_already_past_fires_at_once_as_its_own_interrupt);
    RUN_TEST(no_limit_no_interrupt);
    RUN_TEST(an_answer_leaves_without_gaps_and_the_driver_drops_with_the_last_stop_bit);
    RUN_TEST(in_loop_mode_only_our_own_receiver_hears_us);
    RUN_TEST(masked_interrupts_are_late_but_not_lost);
    RUN_TEST(a_full_receiver_marks_the_octet_after_the_lost_one);
    RUN_TEST(every_rate_has_a_whole_bit_time_and_a_board_may_refuse);
    RUN_TEST(a_reset_boots_again_and_keeps_the_non_volatile_memory);
    RUN_TEST(wrong_use_of_the_port_is_reported);
    return UNITY_END();
}
