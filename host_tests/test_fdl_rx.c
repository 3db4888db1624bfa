/* The telegram receiver over PHY: which octets become a telegram, and what is counted about the others. Each test is run with
 * different telegrams awaited: that must not make a difference.
 * Clauses: EN 50170-2 part 4, 4.7.1 (formats, LE 4..249, FCS, ED); spec A3, D1. */
#include "fake_hal.h"
#include "fdl/fdl_priv.h"
#include "phy_uart/phy_uart.h"

struct fdl_counters XDATA fdl_counters;

static uint8_t XDATA memory[FDL_BUF_LEN];
static uint8_t telegrams, others, cancelled;
static uint8_t body_len;
HOT struct fdl_req fdl_req;
HOT struct fdl_plan fdl_plan;
HOT uint8_t fdl_ts;
IDATA uint8_t fdl_skips_others;

static uint8_t headers, saps;

struct awaited {
    uint8_t len; /* LE, 0: nothing is awaited */
    uint8_t octets;
    uint8_t model[PHY_MODEL];
};
static const CODE struct awaited awaits[] = {
    {0, 0, {0}},
    {5, 7, {0x68, 5, 5, 0x68, 0x08, 0x02, 0x7D}},
    {5, 9, {0x68, 5, 5, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E}},
    {5, 9, {0x68, 5, 5, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3D}},
    {5, 9, {0x68, 5, 5, 0x68, 0x88, 0x82, 0x6D, 0x3B, 0x3E}},
    {5, 8, {0x68, 5, 5, 0x68, 0x88, 0x02, 0x6D, 0x3C}},
    {5, 7, {0x68, 5, 5, 0x68, 0x08, 0x02, 0x5D}},
    {5, 7, {0x68, 5, 5, 0x68, 0x08, 0x03, 0x7D}},
    {13, 7, {0x68, 13, 13, 0x68, 0x08, 0x09, 0x06}},
    {4, 7, {0x68, 4, 4, 0x68, 0x08, 0x02, 0x7D}},
};
static const CODE struct awaited *awaited;

void fdl_da_isr(uint8_t da) IN_ISR
{
    fdl_header.da = da;
}

bool fdl_header_isr(void) IN_ISR
{
    headers++;
    return ((fdl_header.da | fdl_rx_buf[FDL_BODY + 1]) & FDL_ADDRESS_EXT) && fdl_header.len != 3;
}

void fdl_saps_isr(void) IN_ISR
{
    saps++;
}

bool fdl_await_isr(void) IN_ISR
{
    uint8_t i;

    if (!awaited->len)
        return false;
    fdl_plan.stage = FDL_AWAITED;
    fdl_plan.awaited = awaited->octets;
    fdl_header.len = awaited->len;
    for (i = 0; i < awaited->octets; i++)
        phy_model[PHY_MODEL - awaited->octets + i] = awaited->model[i];
    return true;
}

void fdl_telegram_isr(void) IN_ISR
{
    telegrams++;
    body_len = fdl_header.len;
}

void fdl_other_isr(void) IN_ISR
{
    others++;
}

void phy_done_ind_isr(bool sent) IN_ISR
{
    cancelled = (uint8_t)(cancelled + !sent);
}

void fdl_drop_isr(void) IN_ISR
{
}

void phy_event_ind(uint8_t variable, uint8_t value)
{
    (void)variable;
    (void)value;
}

static void begin(uint8_t line)
{
    static const CODE struct fdl_counters none = {0};

    fake_begin();
    fake.line = line;
    fdl_counters = none;
    fdl_rx_buf = memory;
    fdl_skips_others = false;
    fdl_ts = 8;
    telegrams = 0;
    others = 0;
    headers = 0;
    saps = 0;
    phy_reset();
    fdl_rx_reset();
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
}

void setUp(void)
{
    begin(HAL_LINE_TIMED);
}

void tearDown(void)
{
    fake_end();
}

#define BODY(hex) OCTETS(hex, memory + FDL_BODY, body_len)

/* A good telegram right after what was said before: the receiver is in step again. */
static void the_next_telegram_is_heard(void)
{
    uint8_t before = telegrams;

    request("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL(before + 1, telegrams);
}

/* ---- good ones ---- */

static void an_sd1_telegram_has_three_octets_of_body(void)
{
    request("10 08 02 49 53 16"); /* 08 + 02 + 49 = 53 */
    TEST_ASSERT_EQUAL(1, telegrams);
    BODY("08 02 49");
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(1, fdl_counters.sd_count);
}

static void an_sd2_telegram_has_le_octets_of_body(void)
{
    request("68 05 05 68 88 82 6D 3C 3E F1 16");
    TEST_ASSERT_EQUAL(1, telegrams);
    BODY("88 82 6D 3C 3E");
}

/* What is as awaited is known beforehand, all of it or the header; another one is looked at. */
static void the_header_is_shown_before_the_end_of_a_telegram_that_was_not_awaited(void)
{
    const bool other_saps = awaited == &awaits[3] || awaited == &awaits[4];
    const uint8_t looked_at = awaited == &awaits[2] ? 0 : 1;

    fake_silence();
    hear("68 05 05 68 88 82 6D 3C 3E");
    TEST_ASSERT_EQUAL(other_saps ? 0 : looked_at, headers);
    hear("F1 16");
    TEST_ASSERT_EQUAL(looked_at, saps);
    TEST_ASSERT_EQUAL(1, telegrams);
}

static void saps_are_shown_before_the_data_behind_them(void)
{
    fake_silence();
    hear("68 06 06 68 88 82 6D 3C 3E");
    TEST_ASSERT_EQUAL(1, saps);
    hear("01 F2 16");
    TEST_ASSERT_EQUAL(1, telegrams);
}

static void a_plan_given_up_under_the_awaited_telegram_is_made_at_its_end(void)
{
    fake_silence();
    hear("68 05 05 68 88");
    fdl_plan.stage = FDL_IDLE;
    hear("82 6D 3C 3E F1 16");
    TEST_ASSERT_EQUAL(1, headers);
    TEST_ASSERT_EQUAL(1, saps);
    TEST_ASSERT_EQUAL(1, telegrams);
}

static void telegrams_for_others_are_left_at_their_address_where_nobody_wants_them(void)
{
    fdl_skips_others = true;
    request("68 05 05 68 89 82 6D 3C 3E F2 16");
    request("10 09 02 49 54 16");
    TEST_ASSERT_EQUAL(0, headers);
    TEST_ASSERT_EQUAL(2, others);
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(2, fdl_counters.sd_count);
    request("68 05 05 68 FF 82 46 3A 3E 3F 16"); /* to all */
    TEST_ASSERT_EQUAL(1, telegrams);
    the_next_telegram_is_heard();
}

static void an_sd3_telegram_has_eight_octets_of_data(void)
{
    request("A2 08 02 7D 42 24 00 01 02 03 04 05 FC 16");
    TEST_ASSERT_EQUAL(1, telegrams);
    BODY("08 02 7D 42 24 00 01 02 03 04 05");
}

static void a_token_has_no_check_octets(void)
{
    request("DC 02 03");
    TEST_ASSERT_EQUAL(0, telegrams);
    TEST_ASSERT_EQUAL(1, others);
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(1, fdl_counters.sd_count);
    the_next_telegram_is_heard();
}

static void a_short_acknowledge_is_a_telegram_of_its_own(void)
{
    request("E5");
    fake_silence();
    TEST_ASSERT_EQUAL(0, telegrams);
    TEST_ASSERT_EQUAL(1, others);
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(1, fdl_counters.sd_count);
    the_next_telegram_is_heard();
}

static void the_check_sum_is_taken_modulo_256(void)
{
    request("68 09 09 68 7F FF FF FF FF FF FF FF FF 77 16"); /* 7F + 8 * FF = 877 */
    TEST_ASSERT_EQUAL(1, telegrams);
}

static void the_telegram_of_the_frame_document_is_good(void)
{
    request("68 0D 0D 68 08 09 06 61 62 63 64 65 66 67 68 69 6A 0E 16"); /* spec A12 */
    TEST_ASSERT_EQUAL(1, telegrams);
}

/* LE = n octets: DA SA FC 48 00 08 and n - 3 octets 01. */
static void hear_sd2(uint8_t n)
{
    fake_silence();
    hear("68");
    fake_octet(n, 0);
    fake_octet(n, 0);
    hear("68 08 02 7D");
    hear_repeated(1, (uint8_t)(n - 3));
    fake_octet((uint8_t)(0x87 + n - 3), 0);
    fake_octet(0x16, 0);
}

static void every_length_from_4_to_249_is_heard(void)
{
    uint8_t n;

    for (n = 4; n <= 249; n++) {
        hear_sd2(n);
        TEST_ASSERT_EQUAL(n, body_len);
        TEST_ASSERT_EQUAL_HEX8(1, memory[FDL_BODY + n - 1]);
    }
    TEST_ASSERT_EQUAL(246, telegrams);
    TEST_ASSERT_EQUAL_UINT16(0, fdl_counters.format);
}

/* ---- bad ones: dropped, counted, and the next good one is heard ---- */

static void dropped(uint16_t count)
{
    TEST_ASSERT_EQUAL(0, telegrams);
    TEST_ASSERT_EQUAL(0, others);
    TEST_ASSERT_EQUAL_UINT16(1, count);
    the_next_telegram_is_heard();
}

static void an_octet_that_starts_no_telegram_is_an_sd_error(void)
{
    request("11 08 02 49 53 16");
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(0, fdl_counters.sd_count);
    dropped(fdl_counters.sd_error_count);
}

static void a_wrong_check_sum_drops_the_telegram(void)
{
    request("10 56 65 03 88 16"); /* spec A12: right would be BE */
    dropped(fdl_counters.checksum);
}

static void a_wrong_check_sum_drops_an_sd2_telegram(void)
{
    request("68 05 05 68 88 82 6D 3C 3E F0 16");
    dropped(fdl_counters.checksum);
}

static void a_wrong_end_delimiter_drops_the_telegram(void)
{
    request("10 08 02 49 53 17");
    dropped(fdl_counters.format);
}

static void two_different_lengths_drop_the_telegram(void)
{
    request("68 05 06 68 88 82 6D 3C 3E F1 16");
    dropped(fdl_counters.format);
}

static void a_missing_second_start_delimiter_drops_the_telegram(void)
{
    request("68 05 05 69 88 82 6D 3C 3E F1 16");
    dropped(fdl_counters.format);
}

static void length_3_is_too_short(void)
{
    request("68 03 03 68 08 02 49 53 16");
    dropped(fdl_counters.format);
}

static void length_0_is_too_short(void)
{
    request("68 00 00 68 08 02 49 53 16");
    dropped(fdl_counters.format);
}

static void length_250_is_too_long(void)
{
    request("68 FA FA 68 08 02 49 53 16");
    dropped(fdl_counters.format);
}

static void length_255_is_too_long(void)
{
    request("68 FF FF 68 08 02 49 53 16");
    dropped(fdl_counters.format);
}

static void silence_inside_a_telegram_drops_it(void)
{
    fake_silence();
    hear("10 08 02");
    fake_silence();
    dropped(fdl_counters.gap);
}

static void silence_inside_the_header_of_sd2_and_inside_a_token_is_a_gap_too(void)
{
    fake_silence();
    hear("68 05");
    fake_silence();
    hear("DC 02");
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(2, fdl_counters.gap);
    TEST_ASSERT_EQUAL(0, others);
    the_next_telegram_is_heard();
}

static void silence_between_telegrams_is_no_gap(void)
{
    fake_silence();
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(0, fdl_counters.gap);
    the_next_telegram_is_heard();
}

static void a_telegram_without_t_syn_before_it_is_not_heard(void)
{
    fake_silence();
    hear("10 03 02 49 4E 16");
    hear("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL(1, telegrams);
    the_next_telegram_is_heard();
}

static void a_parity_error_drops_the_telegram(void)
{
    fake_silence();
    hear("10 08 02");
    fake_octet(0x49, HAL_ERR_PARITY);
    hear("53 16");
    dropped(fdl_counters.parity);
}

static void framing_errors_and_breaks_count_like_parity(void)
{
    fake_silence();
    fake_octet(0, HAL_ERR_FRAMING);
    fake_silence();
    fake_octet(0, HAL_ERR_FRAMING | HAL_ERR_BREAK);
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(2, fdl_counters.parity);
    TEST_ASSERT_EQUAL_UINT16(0, fdl_counters.gap);
}

static void a_lost_octet_drops_the_telegram(void)
{
    fake_silence();
    hear("10 08");
    fake_octet(0x49, HAL_ERR_OVERRUN);
    hear("53 16");
    dropped(fdl_counters.overrun);
}

static void after_an_error_only_silence_brings_the_receiver_back_into_step(void)
{
    fake_silence();
    hear("11");
    hear("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL(0, telegrams);
    the_next_telegram_is_heard();
}

/* ---- a line that shows no silence (a pseudo terminal, a USB adapter) ---- */

static void on_an_untimed_line_telegrams_may_follow_each_other_at_once(void)
{
    begin(HAL_LINE_UNTIMED);
    fake_silence();
    hear("10 03 02 49 4E 16");
    hear("DC 02 03");
    hear("E5");
    hear("68 05 05 68 88 82 6D 3C 3E F1 16");
    hear("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL(3, telegrams);
    TEST_ASSERT_EQUAL(2, others);
    fake_silence();
    TEST_ASSERT_EQUAL_UINT16(5, fdl_counters.sd_count);
}

static void on_an_untimed_line_an_error_needs_silence_just_the_same(void)
{
    begin(HAL_LINE_UNTIMED);
    fake_silence();
    hear("10 08 02 49 54 16");
    hear("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL(0, telegrams);
    the_next_telegram_is_heard();
}

/* ---- our bug would be shown ---- */

static void a_chunk_nobody_asked_for_is_dropped(void)
{
    fdl_rx_reset();
    phy_chunk_ind_isr();
    TEST_ASSERT_EQUAL(0, telegrams);
    the_next_telegram_is_heard();
}

static void all(void)
{
    RUN_TEST(an_sd1_telegram_has_three_octets_of_body);
    RUN_TEST(an_sd2_telegram_has_le_octets_of_body);
    RUN_TEST(an_sd3_telegram_has_eight_octets_of_data);
    RUN_TEST(the_header_is_shown_before_the_end_of_a_telegram_that_was_not_awaited);
    RUN_TEST(saps_are_shown_before_the_data_behind_them);
    RUN_TEST(a_plan_given_up_under_the_awaited_telegram_is_made_at_its_end);
    RUN_TEST(telegrams_for_others_are_left_at_their_address_where_nobody_wants_them);
    RUN_TEST(a_token_has_no_check_octets);
    RUN_TEST(a_short_acknowledge_is_a_telegram_of_its_own);
    RUN_TEST(the_check_sum_is_taken_modulo_256);
    RUN_TEST(the_telegram_of_the_frame_document_is_good);
    RUN_TEST(every_length_from_4_to_249_is_heard);
    RUN_TEST(an_octet_that_starts_no_telegram_is_an_sd_error);
    RUN_TEST(a_wrong_check_sum_drops_the_telegram);
    RUN_TEST(a_wrong_check_sum_drops_an_sd2_telegram);
    RUN_TEST(a_wrong_end_delimiter_drops_the_telegram);
    RUN_TEST(two_different_lengths_drop_the_telegram);
    RUN_TEST(a_missing_second_start_delimiter_drops_the_telegram);
    RUN_TEST(length_3_is_too_short);
    RUN_TEST(length_0_is_too_short);
    RUN_TEST(length_250_is_too_long);
    RUN_TEST(length_255_is_too_long);
    RUN_TEST(silence_inside_a_telegram_drops_it);
    RUN_TEST(silence_inside_the_header_of_sd2_and_inside_a_token_is_a_gap_too);
    RUN_TEST(silence_between_telegrams_is_no_gap);
    RUN_TEST(a_telegram_without_t_syn_before_it_is_not_heard);
    RUN_TEST(a_parity_error_drops_the_telegram);
    RUN_TEST(framing_errors_and_breaks_count_like_parity);
    RUN_TEST(a_lost_octet_drops_the_telegram);
    RUN_TEST(after_an_error_only_silence_brings_the_receiver_back_into_step);
    RUN_TEST(on_an_untimed_line_telegrams_may_follow_each_other_at_once);
    RUN_TEST(on_an_untimed_line_an_error_needs_silence_just_the_same);
    RUN_TEST(a_chunk_nobody_asked_for_is_dropped);
}

int main(void)
{
    uint8_t i;

    UNITY_BEGIN();
    for (i = 0; i < sizeof awaits / sizeof *awaits; i++) {
        awaited = &awaits[i];
        all();
    }
    return UNITY_END();
}
