/* The physical layer alone: chunks of octets up, T_SYN, T_SDR, turn-round, and PHY management.
 * Clauses: EN 50170-2 part 2 (8E1), part 4, 4.1.7 (T_SYN 33 T_bit, T_SDR); spec A1, A2. */
#include "fake_hal.h"
#include "phy_uart/phy_uart.h"

static const uint8_t IDATA *model; /* of the chunk that is asked for */
static uint8_t len, less;
static struct {
    uint8_t chunks, syns, faults, sent, cancelled, events;
    uint8_t err, variable, value;
} seen;
static uint8_t XDATA room[10];
static uint8_t XDATA frame[2];
static bool again; /* another telegram may follow at once */

void phy_chunk_ind_isr(void) IN_ISR
{
    seen.chunks++;
    again = phy_rx.untimed;
}

void phy_syn_ind_isr(void) IN_ISR
{
    seen.syns++;
    phy_rx.at = room;
    phy_rx.sum = 0;
    phy_rx.model = model;
    phy_rx.less = less;
    phy_rx.left = len;
}

void phy_fault_ind_isr(uint8_t err) IN_ISR
{
    seen.faults++;
    seen.err = err;
}

void phy_done_ind_isr(bool sent) IN_ISR
{
    if (sent)
        seen.sent++;
    else
        seen.cancelled++;
}

void phy_event_ind(uint8_t variable, uint8_t value)
{
    seen.events++;
    seen.variable = variable;
    seen.value = value;
}

static void forget(void)
{
    seen.chunks = 0;
    seen.syns = 0;
    seen.faults = 0;
    seen.sent = 0;
    seen.cancelled = 0;
    seen.events = 0;
}

void setUp(void)
{
    fake_begin();
    model = PHY_MODEL_END;
    len = 3;
    phy_reset();
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
    forget();
}

void tearDown(void)
{
    fake_end();
}

/* As the layer above does it: inside the interrupt of the last octet. */
static void answer(void)
{
    frame[0] = 0xE5;
    frame[1] = 0x5E;
    fake.isr++;
    phy_tx.at = frame;
    phy_tx.len = 2;
    phy_answer_isr();
    fake.isr--;
}

/* ---- receiving ---- */

static void nothing_is_received_before_t_syn_of_silence(void)
{
    hear("10 20 30 40");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    TEST_ASSERT_EQUAL(33, fake.limit);
    fake_silence();
    TEST_ASSERT_EQUAL(1, seen.syns);
}

static void octets_are_gathered_with_their_sum_and_announced_when_all_are_there(void)
{
    fake_silence();
    hear("F0 20");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    hear("30");
    TEST_ASSERT_EQUAL(1, seen.chunks);
    OCTETS("F0 20 30", room, 3);
    TEST_ASSERT_EQUAL_HEX8(0x40, phy_rx.sum); /* F0 + 20 + 30 = 140H */
}

/* A head of four octets 01..04 and, behind it, 05..08 are awaited, then two of any value. */
static void await(void)
{
    uint8_t i;

    for (i = 0; i < 8; i++)
        phy_model[PHY_MODEL - 8 + i] = (uint8_t)(i + 1);
    model = PHY_MODEL_END - 8;
    len = 10;
    less = 6;
    seen.chunks = 0;
    fake_silence();
}

static void a_chunk_like_its_model_is_announced_when_it_is_whole(void)
{
    await();
    hear("01 02 03 04 05 06 07 08 F1");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    TEST_ASSERT_TRUE(phy_rx.model == PHY_MODEL_END);
    hear("F2");
    TEST_ASSERT_EQUAL(1, seen.chunks);
    TEST_ASSERT_EQUAL(0, phy_rx.left);
    TEST_ASSERT_EQUAL(6, phy_rx.less);
    OCTETS("01 02 03 04 05 06 07 08 F1 F2", room, 10);
    TEST_ASSERT_EQUAL_HEX8(0x07, phy_rx.sum); /* 24 + F1 + F2 = 207H */
}

static void over(uint8_t octets, uint8_t left)
{
    TEST_ASSERT_EQUAL(1, seen.chunks);
    TEST_ASSERT_EQUAL(0, phy_rx.less);
    TEST_ASSERT_EQUAL(left, phy_rx.left);
    TEST_ASSERT_TRUE(phy_rx.model == PHY_MODEL_END);
    TEST_ASSERT_TRUE(phy_rx.at == room + octets);
}

static void a_chunk_has_no_head_and_ends_with_its_second_octet_if_the_first_one_is_not_the_models(void)
{
    room[1] = 0xAA;
    room[2] = 0xAA;
    room[3] = 0xAA;
    await();
    hear("02");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    hear("03");
    over(5, 0);
    OCTETS("02 AA AA AA 03", room, 5);
    TEST_ASSERT_EQUAL_HEX8(0x05, phy_rx.sum);
}

static void a_chunk_ends_with_its_head_if_another_octet_of_that_is_not_the_models(void)
{
    await();
    hear("01 02 00");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    hear("04");
    over(4, 0);
    OCTETS("01 02 00 04", room, 4);
    TEST_ASSERT_EQUAL_HEX8(0x07, phy_rx.sum);
    await();
    hear("01 00 00");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    hear("04");
    over(4, 0);
    await();
    hear("01 02 03 00");
    over(4, 0);
}

static void a_chunk_is_over_at_once_if_an_octet_behind_its_head_is_not_the_models(void)
{
    await();
    hear("01 02 03 04 00");
    over(5, 5);
    await();
    hear("01 02 03 04 05 06 07");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    hear("00");
    over(8, 2);
}

static void a_model_may_be_the_first_octet_of_a_chunk_that_is_a_head(void)
{
    await();
    model = PHY_MODEL_END - 1;
    len = 4;
    less = 0;
    fake_silence();
    hear("08 02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    hear("04");
    over(4, 0);
    seen.chunks = 0;
    fake_silence();
    hear("07 02");
    over(5, 0);
    TEST_ASSERT_EQUAL_HEX8(0x02, room[4]);
}

static void octets_nobody_asked_for_are_dropped(void)
{
    room[3] = 0xAA;
    fake_silence();
    hear("01 02 03 04 05");
    TEST_ASSERT_EQUAL(1, seen.chunks);
    TEST_ASSERT_EQUAL_HEX8(0xAA, room[3]);
}

static void a_deaf_receiver_hears_nothing_until_the_next_silence(void)
{
    fake_silence();
    hear("01");
    phy_rx.left = 0;
    hear("02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    fake_silence();
    hear("04 05 06");
    TEST_ASSERT_EQUAL(1, seen.chunks);
}

static void a_faulty_octet_is_reported_with_its_flags_and_makes_the_receiver_deaf(void)
{
    fake_silence();
    hear("01");
    fake_octet(0x02, HAL_ERR_PARITY);
    TEST_ASSERT_EQUAL(1, seen.faults);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_PARITY, seen.err);
    hear("02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
}

static void the_end_of_a_telegram_is_deaf_on_a_timed_line_only(void)
{
    fake_silence();
    hear("01 02 03");
    TEST_ASSERT_FALSE(again);
    fake.line = HAL_LINE_UNTIMED;
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
    fake_silence();
    hear("01 02 03");
    TEST_ASSERT_TRUE(again);
}

/* ---- answering ---- */

static void an_answer_leaves_after_min_t_sdr_of_silence_as_it_stands(void)
{
    answer();
    TEST_ASSERT_EQUAL(11, fake.limit);
    TEST_ASSERT_EQUAL(0, fake.sends);
    fake_silence();
    OCTETS("E5 5E", fake.sent, fake.sent_len);
    TEST_ASSERT_EQUAL(1, fake.sends);
}

static void min_t_sdr_can_be_set_from_11_to_255_bit_times(void)
{
    TEST_ASSERT_EQUAL(11, phy_min_t_sdr());
    phy_set_min_t_sdr(255);
    TEST_ASSERT_EQUAL(255, phy_min_t_sdr());
    answer();
    TEST_ASSERT_EQUAL(255, fake.limit);
}

static void min_t_sdr_set_before_the_line_is_open_counts_once_it_is(void)
{
    phy_reset();
    phy_set_min_t_sdr(60);
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_9K6);
    answer();
    TEST_ASSERT_EQUAL(60, fake.limit);
}

static void where_min_t_sdr_is_over_already_an_answer_leaves_at_once(void)
{
    fake.silent_for = 10;
    answer();
    TEST_ASSERT_FALSE(fake.sending);
    fake_octet(0, 0);
    fake.silent_for = 11;
    answer();
    TEST_ASSERT_TRUE(fake.sending);
    TEST_ASSERT_FALSE(phy_rx.waiting);
    fake_sent();
    TEST_ASSERT_EQUAL(1, seen.sent);
    TEST_ASSERT_EQUAL(33, fake.limit);
}

static void an_octet_before_t_sdr_is_over_cancels_the_answer(void)
{
    answer();
    hear("10");
    TEST_ASSERT_EQUAL(1, seen.cancelled);
    TEST_ASSERT_EQUAL(33, fake.limit);
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
    TEST_ASSERT_EQUAL(1, seen.syns);
}

static void a_faulty_octet_cancels_the_answer_too(void)
{
    answer();
    fake_octet(0, HAL_ERR_FRAMING);
    TEST_ASSERT_EQUAL(1, seen.cancelled);
    TEST_ASSERT_EQUAL(1, seen.faults);
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
}

static void after_an_answer_a_request_needs_t_syn_of_silence_again(void)
{
    answer();
    fake_silence();
    fake_sent();
    TEST_ASSERT_EQUAL(33, fake.limit);
    hear("01 02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    fake_silence();
    hear("01 02 03");
    TEST_ASSERT_EQUAL(1, seen.chunks);
}

static void on_an_untimed_line_a_request_may_follow_the_answer_at_once(void)
{
    fake.line = HAL_LINE_UNTIMED;
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
    answer();
    fake_silence();
    fake_sent();
    TEST_ASSERT_EQUAL(1, seen.syns);
    hear("01 02 03");
    TEST_ASSERT_EQUAL(1, seen.chunks);
}

/* our choice in phy_uart.c: octets come in lumps there. */
static void on_an_untimed_line_5_ms_of_silence_end_a_telegram(void)
{
    fake.line = HAL_LINE_UNTIMED;
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
    TEST_ASSERT_EQUAL(96, fake.limit);
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_12M);
    TEST_ASSERT_EQUAL(60000, fake.limit);
    fake.line = HAL_LINE_TIMED;
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_12M);
    TEST_ASSERT_EQUAL(33, fake.limit);
}

static void nothing_is_heard_while_the_answer_is_being_sent(void)
{
    fake_silence();
    answer();
    fake_silence();
    fake_silence(); /* a limit that runs out while sending means nothing */
    hear("01 02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    TEST_ASSERT_EQUAL(1, seen.syns);
    TEST_ASSERT_EQUAL(0, seen.cancelled);
    TEST_ASSERT_EQUAL(1, fake.sends);
    fake_sent();
}

static void a_disabled_transmitter_sends_nothing(void)
{
    TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_TRANSMITTER_OUTPUT, PHY_DISABLED));
    answer();
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
    TEST_ASSERT_EQUAL(1, seen.syns);
    phy_set_value(PHY_TRANSMITTER_OUTPUT, PHY_ENABLED);
    answer();
    fake_silence();
    TEST_ASSERT_EQUAL(1, fake.sends);
}

static void a_transmitter_disabled_while_an_answer_waits_sends_nothing_either(void)
{
    answer();
    phy_set_value(PHY_TRANSMITTER_OUTPUT, PHY_DISABLED);
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
}

/* ---- management ---- */

static void reset_gives_the_values_of_the_standard_and_closes_the_line(void)
{
    phy_set_value(PHY_TRANSMITTER_OUTPUT, PHY_DISABLED);
    phy_set_value(PHY_LOOP, PHY_ENABLED);
    phy_set_min_t_sdr(77);
    fake_silence();
    phy_reset();
    TEST_ASSERT_EQUAL(PHY_ENABLED, phy_read_value(PHY_TRANSMITTER_OUTPUT));
    TEST_ASSERT_EQUAL(PHY_PRIMARY, phy_read_value(PHY_RECEIVED_SIGNAL_SOURCE));
    TEST_ASSERT_EQUAL(PHY_DISABLED, phy_read_value(PHY_LOOP));
    TEST_ASSERT_EQUAL(0xFF, phy_read_value(PHY_BAUD_RATE));
    TEST_ASSERT_EQUAL(PHY_NO_REDUNDANCY, phy_read_value(PHY_MEDIUM_RED));
    TEST_ASSERT_EQUAL(11, phy_min_t_sdr());
    TEST_ASSERT_EQUAL(0, fake.limit);
    hear("01 02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
}

static void reset_takes_back_an_answer_that_waits(void)
{
    answer();
    phy_reset();
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
}

/* The frame is on its way, its end comes after the reset: it must not open the receiver again. */
static void an_answer_that_ends_after_a_reset_leaves_the_line_closed(void)
{
    fake.line = HAL_LINE_UNTIMED;
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
    answer();
    fake_silence();
    phy_reset();
    fake_sent();
    TEST_ASSERT_EQUAL(0, fake.limit);
    hear("01 02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
}

struct rate {
    uint8_t baud;
    uint32_t bit_per_s;
    uint16_t max_t_sdr;
};

/* Codes: spec A1, continued; max_T_SDR: spec A9. */
static const CODE struct rate rates[11] = {
    {0, 9600, 60},    {1, 19200, 60},    {2, 93750, 60},     {3, 187500, 60},   {4, 500000, 100},    {5, 38400, 60},
    {6, 1500000, 150}, {7, 45450, 60}, {8, 3000000, 250}, {9, 6000000, 450}, {10, 12000000, 800},
};

static void every_baud_rate_code_opens_the_line_8e1_at_its_rate(void)
{
    uint8_t i;

    for (i = 0; i < 11; i++) {
        TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_BAUD_RATE, rates[i].baud));
        TEST_ASSERT_EQUAL_UINT32(rates[i].bit_per_s, fake.rate);
        TEST_ASSERT_EQUAL(HAL_8E1, fake.format);
        TEST_ASSERT_EQUAL(33, fake.limit);
        TEST_ASSERT_EQUAL_UINT32(rates[i].bit_per_s, phy_bit_per_s(rates[i].baud));
        TEST_ASSERT_EQUAL_UINT16(rates[i].max_t_sdr, phy_max_t_sdr(rates[i].baud));
    }
    TEST_ASSERT_EQUAL(PHY_IV, phy_set_value(PHY_BAUD_RATE, 11));
    TEST_ASSERT_EQUAL_UINT32(0, phy_bit_per_s(11));
    TEST_ASSERT_EQUAL_UINT16(0, phy_max_t_sdr(11));
}

static void a_rate_the_board_cannot_do_changes_nothing(void)
{
    fake.fastest = 500000;
    TEST_ASSERT_EQUAL(PHY_NO, phy_set_value(PHY_BAUD_RATE, PHY_BAUD_1M5));
    TEST_ASSERT_EQUAL(PHY_BAUD_19K2, phy_read_value(PHY_BAUD_RATE));
    TEST_ASSERT_EQUAL(0, seen.events);
    TEST_ASSERT_EQUAL_UINT32(19200, fake.rate);
    fake_silence();
    hear("01 02 03");
    TEST_ASSERT_EQUAL(1, seen.chunks);
}

static void a_new_rate_forgets_the_telegram_and_the_answer_on_their_way(void)
{
    fake_silence();
    hear("01");
    answer();
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_9K6);
    hear("02 03");
    TEST_ASSERT_EQUAL(0, seen.chunks);
    TEST_ASSERT_EQUAL(0, seen.cancelled);
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
    TEST_ASSERT_EQUAL(2, seen.syns);
}

static void loop_opens_the_line_with_the_transmitter_on_the_receiver(void)
{
    TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_LOOP, PHY_ENABLED));
    TEST_ASSERT_EQUAL_HEX8(HAL_8E1 | HAL_LOOP, fake.format);
    TEST_ASSERT_EQUAL(PHY_ENABLED, phy_read_value(PHY_LOOP));
    TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_LOOP, PHY_DISABLED));
    TEST_ASSERT_EQUAL_HEX8(HAL_8E1, fake.format);
}

static void loop_set_while_the_line_is_closed_counts_once_it_is_open(void)
{
    phy_reset();
    fake.opens = 0;
    TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_LOOP, PHY_ENABLED));
    TEST_ASSERT_EQUAL(0, fake.opens);
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_9K6);
    TEST_ASSERT_EQUAL_HEX8(HAL_8E1 | HAL_LOOP, fake.format);
}

static void one_bus_and_one_receiver_is_all_a_board_has(void)
{
    TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_MEDIUM_RED, PHY_NO_REDUNDANCY));
    TEST_ASSERT_EQUAL(PHY_NO, phy_set_value(PHY_MEDIUM_RED, PHY_BUS_A_HIGH));
    TEST_ASSERT_EQUAL(PHY_NO, phy_set_value(PHY_MEDIUM_RED, PHY_BUS_B_HIGH));
    TEST_ASSERT_EQUAL(PHY_OK, phy_set_value(PHY_RECEIVED_SIGNAL_SOURCE, PHY_PRIMARY));
    TEST_ASSERT_EQUAL(PHY_NO, phy_set_value(PHY_RECEIVED_SIGNAL_SOURCE, PHY_ALTERNATE));
    TEST_ASSERT_EQUAL(PHY_NO, phy_set_value(PHY_RECEIVED_SIGNAL_SOURCE, PHY_RANDOM));
    TEST_ASSERT_EQUAL(0, seen.events);
}

static void values_and_variables_that_do_not_exist_are_invalid(void)
{
    TEST_ASSERT_EQUAL(PHY_IV, phy_set_value(PHY_TRANSMITTER_OUTPUT, 2));
    TEST_ASSERT_EQUAL(PHY_IV, phy_set_value(PHY_RECEIVED_SIGNAL_SOURCE, 3));
    TEST_ASSERT_EQUAL(PHY_IV, phy_set_value(PHY_LOOP, 2));
    TEST_ASSERT_EQUAL(PHY_IV, phy_set_value(PHY_MEDIUM_RED, 3));
    TEST_ASSERT_EQUAL(PHY_IV, phy_set_value(PHY_VARIABLES, 0));
    TEST_ASSERT_EQUAL_HEX8(0xFF, phy_read_value(PHY_VARIABLES));
}

static void an_event_is_indicated_when_a_variable_changes_and_only_then(void)
{
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_19K2);
    TEST_ASSERT_EQUAL(0, seen.events);
    phy_set_value(PHY_BAUD_RATE, PHY_BAUD_500K);
    TEST_ASSERT_EQUAL(1, seen.events);
    TEST_ASSERT_EQUAL(PHY_BAUD_RATE, seen.variable);
    TEST_ASSERT_EQUAL(PHY_BAUD_500K, seen.value);
    phy_set_value(PHY_TRANSMITTER_OUTPUT, PHY_DISABLED);
    TEST_ASSERT_EQUAL(2, seen.events);
    TEST_ASSERT_EQUAL(PHY_TRANSMITTER_OUTPUT, seen.variable);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(nothing_is_received_before_t_syn_of_silence);
    RUN_TEST(octets_are_gathered_with_their_sum_and_announced_when_all_are_there);
    RUN_TEST(a_chunk_like_its_model_is_announced_when_it_is_whole);
    RUN_TEST(a_chunk_has_no_head_and_ends_with_its_second_octet_if_the_first_one_is_not_the_models);
    RUN_TEST(a_chunk_ends_with_its_head_if_another_octet_of_that_is_not_the_models);
    RUN_TEST(a_chunk_is_over_at_once_if_an_octet_behind_its_head_is_not_the_models);
    RUN_TEST(a_model_may_be_the_first_octet_of_a_chunk_that_is_a_head);
    RUN_TEST(octets_nobody_asked_for_are_dropped);
    RUN_TEST(a_deaf_receiver_hears_nothing_until_the_next_silence);
    RUN_TEST(a_faulty_octet_is_reported_with_its_flags_and_makes_the_receiver_deaf);
    RUN_TEST(the_end_of_a_telegram_is_deaf_on_a_timed_line_only);
    RUN_TEST(an_answer_leaves_after_min_t_sdr_of_silence_as_it_stands);
    RUN_TEST(min_t_sdr_can_be_set_from_11_to_255_bit_times);
    RUN_TEST(min_t_sdr_set_before_the_line_is_open_counts_once_it_is);
    RUN_TEST(where_min_t_sdr_is_over_already_an_answer_leaves_at_once);
    RUN_TEST(an_octet_before_t_sdr_is_over_cancels_the_answer);
    RUN_TEST(a_faulty_octet_cancels_the_answer_too);
    RUN_TEST(after_an_answer_a_request_needs_t_syn_of_silence_again);
    RUN_TEST(on_an_untimed_line_a_request_may_follow_the_answer_at_once);
    RUN_TEST(on_an_untimed_line_5_ms_of_silence_end_a_telegram);
    RUN_TEST(nothing_is_heard_while_the_answer_is_being_sent);
    RUN_TEST(a_disabled_transmitter_sends_nothing);
    RUN_TEST(a_transmitter_disabled_while_an_answer_waits_sends_nothing_either);
    RUN_TEST(reset_gives_the_values_of_the_standard_and_closes_the_line);
    RUN_TEST(reset_takes_back_an_answer_that_waits);
    RUN_TEST(an_answer_that_ends_after_a_reset_leaves_the_line_closed);
    RUN_TEST(every_baud_rate_code_opens_the_line_8e1_at_its_rate);
    RUN_TEST(a_rate_the_board_cannot_do_changes_nothing);
    RUN_TEST(a_new_rate_forgets_the_telegram_and_the_answer_on_their_way);
    RUN_TEST(loop_opens_the_line_with_the_transmitter_on_the_receiver);
    RUN_TEST(loop_set_while_the_line_is_closed_counts_once_it_is_open);
    RUN_TEST(one_bus_and_one_receiver_is_all_a_board_has);
    RUN_TEST(values_and_variables_that_do_not_exist_are_invalid);
    RUN_TEST(an_event_is_indicated_when_a_variable_changes_and_only_then);
    return UNITY_END();
}
