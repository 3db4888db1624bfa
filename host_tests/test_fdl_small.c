/* A part that stores telegram bodies of 40 octets: longer telegrams are received, checked and refused.
 * Clauses: EN 50170-2 part 4, 4.7.1; spec A3; config.h, FDL_BODY_MAX. */
#include "fdl/fdl_priv.h"
#include "fdl_unit.h"

void setUp(void)
{
    unit_begin();
    fma_rsap_activate(10, FDL_ALL, 246, FDL_TO_MAIN, 0);
    fma_rsap_activate(FDL_SAP_NIL, FDL_ALL, 246, FDL_TO_MAIN, 0);
}

void tearDown(void)
{
    fake_end();
}

/* SRD to SAP 10 of address da with le octets from DA on; FCS off by `off`. */
static void ask_long(uint8_t da, uint8_t fc, uint8_t le, uint8_t off)
{
    fake.sent_len = 0;
    fake_silence();
    hear("68");
    fake_octet(le, 0);
    fake_octet(le, 0);
    hear("68");
    fake_octet(da | 0x80, 0);
    hear("82");
    fake_octet(fc, 0);
    hear("0A 3E");
    hear_repeated(1, (uint8_t)(le - 5));
    fake_octet((uint8_t)((da | 0x80) + 0x82 + fc + 0x0A + 0x3E + le - 5 + off), 0);
    fake_octet(0x16, 0);
    finish_request();
}

static void a_body_of_40_octets_is_stored(void)
{
    ask_long(8, 0x4D, 40, 0);
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(35, ind.last.len);
    OCTETS("01 01 01 01 01 01 01 01", ind.lsdu, 8);
}

static void every_longer_telegram_is_refused_rr_and_the_next_one_is_taken(void)
{
    uint8_t le;

    for (le = 41; le <= 249; le++) {
        ask_long(8, 0x4D, le, 0);
        ANSWERED("10 02 08 02 0C 16");
    }
    ask_long(8, 0x4D, 12, 0);
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
    COUNTED(0, checksum);
    COUNTED(0, format);
}

static void the_check_sum_of_a_long_telegram_counts(void)
{
    uint8_t le;

    for (le = 41; le <= 249; le++) {
        ask_long(8, 0x4D, le, 1);
        NOT_ANSWERED();
    }
    COUNTED(209, checksum);
}

static void the_end_delimiter_of_a_long_telegram_counts(void)
{
    fake_silence();
    hear("68 29 29 68 88 82 4D 0A 3E");
    hear_repeated(0, 36);
    hear("9F 17");
    finish_request();
    TEST_ASSERT_EQUAL(0, fake.sends);
    COUNTED(1, format);
}

static void a_gap_inside_a_long_telegram_drops_it(void)
{
    fake_silence();
    hear("68 F9 F9 68 88 82 4D 0A 3E");
    hear_repeated(0, 100);
    fake_silence();
    COUNTED(1, gap);
    ask_long(8, 0x4D, 12, 0);
    ANSWERED("E5");
}

static void a_long_telegram_for_another_station_is_skipped(void)
{
    ask_long(9, 0x4D, 249, 0);
    NOT_ANSWERED();
    COUNTED(1, foreign);
    ask_long(8, 0x4D, 12, 0);
    ANSWERED("E5");
}

static void a_long_sdn_is_dropped(void)
{
    fma_sap_activate(10, FDL_ALL, FDL_SDN, 246, FDL_TO_MAIN);
    ask_long(8, 0x44, 100, 0);
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
}

static void a_long_telegram_to_a_sap_that_is_not_active_is_refused_rs(void)
{
    fma_sap_deactivate(10);
    ask_long(8, 0x4D, 100, 0);
    ANSWERED("10 02 08 03 0D 16");
}

static void a_long_telegram_repeated_is_a_retry_and_another_one_is_not(void)
{
    ask_long(8, 0x7D, 100, 0);
    ANSWERED("10 02 08 02 0C 16");
    ask_long(8, 0x7D, 100, 0);
    ANSWERED("10 02 08 02 0C 16");
    COUNTED(1, retries);
    ask_long(8, 0x7D, 101, 0);
    COUNTED(1, retries);
    COUNTED(2, refused);
}

/* Without SAPs the five octets that are kept hold two of the data. */
static void a_long_telegram_to_the_default_sap_is_refused_rr(void)
{
    fake_silence();
    hear("68 29 29 68 08 02 4D");
    hear_repeated(0, 38);
    hear("57 16");
    finish_request();
    ANSWERED("10 02 08 02 0C 16");
}

static void two_indications_wait_and_the_third_is_refused_rr(void)
{
    ask_long(8, 0x4D, 10, 0);
    ask_long(8, 0x4D, 11, 0);
    ANSWERED("E5");
    ask_long(8, 0x4D, 12, 0);
    ANSWERED("10 02 08 02 0C 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(2, ind.count);
}

static void nine_saps_are_active_at_once_and_no_more(void)
{
    uint8_t i;

    for (i = 0; i < 7; i++)
        TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(i, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_LR, fma_sap_activate(7, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
}

/* What lies beyond the buffer of the receiver stays as it is, whatever comes. */
static void nothing_is_written_beyond_the_buffer(void)
{
    static uint8_t XDATA buffer[FDL_BUF_LEN + 4];
    uint8_t XDATA *own = fdl_rx_buf;
    uint8_t le;
    uint8_t i;

    fdl_rx_buf = buffer;
    for (i = FDL_BUF_LEN; i < FDL_BUF_LEN + 4; i++)
        buffer[i] = 0xA5;
    for (le = 40; le <= 249; le++) {
        fdl_rx_buf = buffer;
        ask_long(9, 0x4D, le, 0);
    }
    OCTETS("A5 A5 A5 A5", buffer + FDL_BUF_LEN, 4);
    COUNTED(210, foreign);
    fdl_rx_buf = own;
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_body_of_40_octets_is_stored);
    RUN_TEST(every_longer_telegram_is_refused_rr_and_the_next_one_is_taken);
    RUN_TEST(the_check_sum_of_a_long_telegram_counts);
    RUN_TEST(the_end_delimiter_of_a_long_telegram_counts);
    RUN_TEST(a_gap_inside_a_long_telegram_drops_it);
    RUN_TEST(a_long_telegram_for_another_station_is_skipped);
    RUN_TEST(a_long_sdn_is_dropped);
    RUN_TEST(a_long_telegram_to_a_sap_that_is_not_active_is_refused_rs);
    RUN_TEST(a_long_telegram_repeated_is_a_retry_and_another_one_is_not);
    RUN_TEST(a_long_telegram_to_the_default_sap_is_refused_rr);
    RUN_TEST(two_indications_wait_and_the_third_is_refused_rr);
    RUN_TEST(nine_saps_are_active_at_once_and_no_more);
    RUN_TEST(nothing_is_written_beyond_the_buffer);
    return UNITY_END();
}
