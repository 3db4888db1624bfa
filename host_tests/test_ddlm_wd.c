/* Watchdog and baud search: BAUD_SEARCH, BAUD_CONTROL, DP_CONTROL.
 * Clause: EN 50170-2 part 8, watchdog; facts 3.13. Codes of rates: spec A1. */
#include "ddlm_unit.h"

static void begin(uint8_t baud)
{
    fake.masked = true;
    ddlm_slave_init(8, baud);
    fake.masked = false;
}

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    app.faults = 0;
}

void tearDown(void)
{
    fake_end();
}

#define WD_STATE(s) INFO(s, wd_state)
#define FOREIGN     "10 09 02 49 54 16"
#define OWN_STATUS  "10 08 02 49 53 16"

/* ---- start ---- */

static void a_given_rate_is_taken_and_never_searched_for(void)
{
    uint8_t i;

    WD_STATE(DDLM_BAUD_CONTROL);
    INFO(1, baud);
    for (i = 0; i < 20; i++)
        turn_after(1000);
    WD_STATE(DDLM_BAUD_CONTROL);
    INFO(1, baud);
}

static void a_rate_the_board_cannot_do_is_answered_no(void)
{
    fake.fastest = 1500000;
    fake.masked = true;
    TEST_ASSERT_EQUAL(DDLM_NO, ddlm_slave_init(8, 10));
    TEST_ASSERT_EQUAL(1, app.faults);
    TEST_ASSERT_EQUAL(DDLM_NO, app.fault);
    fake.masked = false;
}

static void addresses_and_rates_that_do_not_exist_are_answered_iv(void)
{
    fake.masked = true;
    TEST_ASSERT_EQUAL(DDLM_IV, ddlm_slave_init(127, 1));
    TEST_ASSERT_EQUAL(DDLM_IV, ddlm_slave_init(8, 11));
    TEST_ASSERT_EQUAL(DDLM_IV, ddlm_slave_init(8, 254));
    TEST_ASSERT_EQUAL(3, app.faults);
    TEST_ASSERT_EQUAL(DDLM_IV, app.fault);
    fake.masked = false;
}

/* ---- BAUD_SEARCH ---- */

/* 12 M, 6 M, 3 M, 1.5 M, 500 k, 187.5 k, 93.75 k, 45.45 k, 19.2 k, 9.6 k. */
static const CODE uint8_t order[10] = {10, 9, 8, 6, 4, 3, 2, 7, 1, 0};

static void the_search_begins_at_the_highest_rate_and_goes_down_and_round(void)
{
    uint8_t i;

    begin(DDLM_BAUD_AUTO);
    WD_STATE(DDLM_BAUD_SEARCH);
    for (i = 0; i < 10; i++) {
        INFO(order[i], baud);
        turn_after(900);
    }
    INFO(10, baud);
    WD_STATE(DDLM_BAUD_SEARCH);
}

/* 8000 T_bit, at least 100 ms: 833 ms at 9.6 kbit/s. */
static void each_rate_is_listened_to_long_enough(void)
{
    fake.fastest = 19200;
    begin(DDLM_BAUD_AUTO);
    INFO(1, baud);
    turn_after(415);
    INFO(1, baud);
    turn_after(1); /* 8000 / 19200 s = 416 ms */
    INFO(0, baud);
    turn_after(832);
    INFO(0, baud);
    turn_after(1);
    INFO(1, baud);
    fake.fastest = 12000000;
    begin(DDLM_BAUD_AUTO);
    turn_after(99);
    INFO(10, baud);
    turn_after(1);
    INFO(9, baud);
}

static void rates_the_board_cannot_do_are_left_out(void)
{
    fake.fastest = 187500;
    begin(DDLM_BAUD_AUTO);
    INFO(3, baud);
    turn_after(100);
    INFO(2, baud);
}

static void a_board_that_can_do_no_rate_is_a_fault_and_hangs_nowhere(void)
{
    fake.fastest = 0;
    fake.masked = true;
    TEST_ASSERT_EQUAL(DDLM_NO, ddlm_slave_init(8, DDLM_BAUD_AUTO));
    fake.masked = false;
    TEST_ASSERT_EQUAL(DDLM_NO, app.fault);
    turn_after(1000);
    turn_after(1000);
    WD_STATE(DDLM_BAUD_SEARCH);
    fake.fastest = 12000000;
    turn_after(1000);
    request(OWN_STATUS);
    ANSWERED("10 02 08 00 0A 16");
}

static void any_error_free_telegram_ends_the_search(void)
{
    begin(DDLM_BAUD_AUTO);
    turn_after(900);
    ask(FOREIGN);
    WD_STATE(DDLM_BAUD_CONTROL);
    INFO(9, baud);
    turn_after(4000);
    INFO(9, baud);
}

static void tokens_acknowledges_and_errors_do_not_end_the_search(void)
{
    begin(DDLM_BAUD_AUTO);
    ask("DC 02 03");
    ask("E5");
    ask("10 09 02 49 55 16");
    WD_STATE(DDLM_BAUD_SEARCH);
}

/* ---- BAUD_CONTROL ---- */

/* 2 * WD_Baud_Control_Val * 10 ms = 5 s. */
static void nothing_for_us_in_baud_control_searches_again_and_leaves_the_state_alone(void)
{
    begin(DDLM_BAUD_AUTO);
    ask(OWN_STATUS);
    to_data_exch();
    turn_after(2500);
    ask(FOREIGN); /* for another station: does not count */
    turn_after(2499);
    WD_STATE(DDLM_BAUD_CONTROL);
    turn_after(1);
    WD_STATE(DDLM_BAUD_SEARCH);
    STATE(DDLM_DATA_EXCH);
    INFO(10, baud);
}

static void a_telegram_for_us_keeps_baud_control(void)
{
    uint8_t i;

    begin(DDLM_BAUD_AUTO);
    ask(OWN_STATUS);
    for (i = 0; i < 5; i++) {
        turn_after(4999);
        ask("10 08 05 49 56 16");
    }
    WD_STATE(DDLM_BAUD_CONTROL);
}

/* ---- DP_CONTROL ---- */

/* T_WD = 10 ms * 3 * 10 = 300 ms. */
static void guarded(void)
{
    ask_sap(8, 2, 61, "88 03 0A 0B 12 34 00");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    STATE(DDLM_DATA_EXCH);
    WD_STATE(DDLM_DP_CONTROL);
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    turn();
    OUTPUTS(DDLM_OUT_NEW, "01 02");
}

static void the_watchdog_expires_when_t_wd_has_passed_and_not_before(void)
{
    guarded();
    turn_after(300); /* 300 ms may have been 299 and a little */
    STATE(DDLM_DATA_EXCH);
    turn_after(1);
    STATE(DDLM_WAIT_PRM);
    WD_STATE(DDLM_BAUD_CONTROL);
    COUNTED(1, wd_expired);
    INFO(false, wd_on);
    DIAG("02 05 00 FF 12 34");
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    ANSWERED("10 02 08 03 0D 16");
}

static void the_owner_restarts_the_watchdog_with_any_telegram(void)
{
    uint8_t i;

    guarded();
    for (i = 0; i < 5; i++) {
        turn_after(300);
        ask(OWN_STATUS);
    }
    turn_after(300);
    ask("68 05 05 68 08 02 7D 01 02 8A 16");
    turn_after(300);
    ask("68 05 05 68 08 02 7D 01 02 8A 16"); /* a retry counts, too */
    turn_after(300);
    STATE(DDLM_DATA_EXCH);
    COUNTED(0, wd_expired);
}

static void other_masters_and_broadcasts_do_not_restart_it(void)
{
    guarded();
    turn_after(150);
    ask("10 08 03 49 54 16");
    DIAG("00 0C 00 02 12 34");
    ask("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16");
    ask("68 05 05 68 08 02 6D 01 02 E1 16"); /* wrong FCS */
    turn_after(151);
    STATE(DDLM_WAIT_PRM);
}

static void it_guards_the_configuration_too(void)
{
    ask_sap(8, 2, 61, "88 03 0A 0B 12 34 00");
    STATE(DDLM_WAIT_CFG);
    turn_after(301);
    STATE(DDLM_WAIT_PRM);
    COUNTED(1, wd_expired);
}

static void time_before_set_prm_is_not_charged(void)
{
    turn_after(1000);
    fake.ticks = (uint16_t)(fake.ticks + 1000);
    ask_sap(8, 2, 61, "88 01 01 0B 12 34 00"); /* 10 ms */
    STATE(DDLM_WAIT_CFG);
    turn_after(10);
    STATE(DDLM_WAIT_CFG);
    turn_after(1);
    STATE(DDLM_WAIT_PRM);
}

static void the_longest_t_wd_is_650_s(void)
{
    uint8_t i;

    ask_sap(8, 2, 61, "88 FF FF 0B 12 34 00");
    for (i = 0; i < 10; i++)
        turn_after(65000);
    turn_after(250);
    STATE(DDLM_WAIT_CFG);
    turn_after(1); /* 650.25 s */
    STATE(DDLM_WAIT_PRM);
}

static void without_wd_on_nothing_expires(void)
{
    uint8_t i;

    to_data_exch();
    for (i = 0; i < 20; i++)
        turn_after(60000);
    STATE(DDLM_DATA_EXCH);
    COUNTED(0, wd_expired);
}

static void unlock_ends_dp_control(void)
{
    guarded();
    ask_sap(8, 2, 61, "40 00 00 00 12 34 00");
    WD_STATE(DDLM_BAUD_CONTROL);
    turn_after(301);
    COUNTED(0, wd_expired);
}

static void after_an_expiry_the_rate_is_searched_when_nothing_comes(void)
{
    begin(DDLM_BAUD_AUTO);
    ask(OWN_STATUS);
    guarded();
    turn_after(301);
    WD_STATE(DDLM_BAUD_CONTROL);
    turn_after(4999);
    WD_STATE(DDLM_BAUD_CONTROL);
    turn_after(1);
    WD_STATE(DDLM_BAUD_SEARCH);
    STATE(DDLM_WAIT_PRM);
}

static void the_tick_counter_may_wrap(void)
{
    fake.ticks = 65500;
    turn();
    guarded();
    turn_after(300);
    STATE(DDLM_DATA_EXCH);
    turn_after(1);
    STATE(DDLM_WAIT_PRM);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_given_rate_is_taken_and_never_searched_for);
    RUN_TEST(a_rate_the_board_cannot_do_is_answered_no);
    RUN_TEST(addresses_and_rates_that_do_not_exist_are_answered_iv);
    RUN_TEST(the_search_begins_at_the_highest_rate_and_goes_down_and_round);
    RUN_TEST(each_rate_is_listened_to_long_enough);
    RUN_TEST(rates_the_board_cannot_do_are_left_out);
    RUN_TEST(a_board_that_can_do_no_rate_is_a_fault_and_hangs_nowhere);
    RUN_TEST(any_error_free_telegram_ends_the_search);
    RUN_TEST(tokens_acknowledges_and_errors_do_not_end_the_search);
    RUN_TEST(nothing_for_us_in_baud_control_searches_again_and_leaves_the_state_alone);
    RUN_TEST(a_telegram_for_us_keeps_baud_control);
    RUN_TEST(the_watchdog_expires_when_t_wd_has_passed_and_not_before);
    RUN_TEST(the_owner_restarts_the_watchdog_with_any_telegram);
    RUN_TEST(other_masters_and_broadcasts_do_not_restart_it);
    RUN_TEST(it_guards_the_configuration_too);
    RUN_TEST(time_before_set_prm_is_not_charged);
    RUN_TEST(the_longest_t_wd_is_650_s);
    RUN_TEST(without_wd_on_nothing_expires);
    RUN_TEST(unlock_ends_dp_control);
    RUN_TEST(after_an_expiry_the_rate_is_searched_when_nothing_comes);
    RUN_TEST(the_tick_counter_may_wrap);
    return UNITY_END();
}
