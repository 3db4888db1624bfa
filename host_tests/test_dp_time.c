/* T75 - T84: watchdog, baud search, T_SDR. EN 50170-2 part 8 (watchdog), part 4, 4.1.6; facts 3.4, 3.13. */
#include "dp_fixture.h"

#include <string.h>

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

#define T_WD (50u * HV_MS)       /* SET_PRM_WD: 10 ms x 1 x 5 */
#define TURN (HV_MS + HV_MS / 5) /* hal_ticks() is at most 1 ms late, a turn of the main loop takes 100 us */

/* When the last octet of the request that seg_said answers ended. */
static hv_time request_end(void)
{
    return seg_said.start - seg_said.t_sdr;
}

static void T75_the_watchdog_expires_after_T_WD_never_before_and_at_most_a_turn_later(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    ASK(DX, DX_OK);
    const hv_time end = request_end();
    hv_run_until(end + T_WD - 1);
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(0x11, 0x22);
    hv_run_until(end + T_WD + 2 * TURN);
    STATE(DDLM_WAIT_PRM);
    OUTPUTS(0, 0);
}

static void T76_each_telegram_of_the_owner_restarts_it(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    for (unsigned i = 0; i < 30; i++) {
        hv_run_for(30 * HV_MS);
        if (i % 3 == 0)
            ASK(DX, DX_OK);
        else if (i % 3 == 1)
            DIAG(0x000C);
        else
            ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
    }
    STATE(DDLM_DATA_EXCH);
}

static void T76_a_retry_restarts_it_too(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    for (unsigned i = 0; i < 10; i++) {
        ASK("68 05 05 68 08 02 5D 33 44 DE 16", DX_OK);
        hv_run_for(30 * HV_MS);
    }
    STATE(DDLM_DATA_EXCH);
}

static void T76_another_master_or_another_station_does_not_restart_it(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    for (unsigned i = 0; i < 6; i++) {
        hv_run_for(10 * HV_MS);
        (void)dp_ask("68 05 05 68 88 83 6D 3C 3E F2 16", __LINE__);
        SILENT("68 05 05 68 09 02 6D 11 22 AB 16");
    }
    STATE(DDLM_WAIT_PRM);
}

static void T77_after_expiry_anyone_may_take_the_station(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    hv_run_for(2 * T_WD);
    ASK("68 0C 0C 68 88 83 6D 3D 3E 80 01 01 00 12 34 01 BC 16", ACK);
    TEST_ASSERT_EQUAL(3, dp_info()->master);
}

static void T78_Slave_Diag_shows_whether_the_watchdog_is_on(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    DIAG(0x000C);
    hv_run_for(2 * T_WD);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
}

static void T79_without_watchdog_the_outputs_stay(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    hv_run_for(100u * (hv_time)HV_S);
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(0x11, 0x22);
}

static void T79_a_main_loop_that_comes_late_neither_misses_nor_invents_an_expiry(void)
{
    TO_DATA_EXCH(SET_PRM_WD);
    for (unsigned i = 0; i < 20; i++) {
        hv_set_loop(NULL, NULL); /* the application is busy for 30 ms, an exchange in the middle */
        hv_run_for(15 * HV_MS);
        ASK(DX, DX_OK);
        hv_run_for(15 * HV_MS);
        hv_set_loop(dp_station_poll, NULL);
        hv_run_for(HV_MS);
        STATE(DDLM_DATA_EXCH);
    }
}

/* ---- baud search --------------------------------------------------------------------------------------------- */

static const uint32_t rates[] = {9600,   19200,   45450,   93750,   187500,
                                 500000, 1500000, 3000000, 6000000, 12000000};
#define RATES (sizeof rates / sizeof rates[0])

/* A master polls station 5, which does not exist, every 10 ms. */
static void traffic(uint32_t bit_per_s, hv_time duration)
{
    static const uint8_t poll[] = {0x10, 0x05, 0x02, 0x49, 0x50, 0x16};
    const hv_time end = hv_now() + duration;
    dp_tester.bit = hv_bit_of(bit_per_s);
    while (hv_now() < end) {
        seg_send(&dp_tester, hv_now(), poll, sizeof poll, 0);
        hv_run_for(10 * HV_MS + 66 * dp_tester.bit);
    }
}

static void found(uint32_t bit_per_s)
{
    TEST_ASSERT_EQUAL(DDLM_BAUD_CONTROL, dp_info()->wd_state);
    TEST_ASSERT_EQUAL_UINT64(hv_bit_of(bit_per_s), hv_bit());
    TEST_ASSERT_EQUAL_UINT32(bit_per_s, phy_bit_per_s(dp_info()->baud));
}

static void T80_every_rate_is_found_in_the_traffic_of_others(void)
{
    for (unsigned i = 0; i < RATES; i++) {
        dp_begin_at(8, DDLM_BAUD_AUTO, rates[i]);
        TEST_ASSERT_EQUAL(DDLM_BAUD_SEARCH, dp_info()->wd_state);
        traffic(rates[i], 4 * (hv_time)HV_S);
        found(rates[i]);
        ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
        TO_DATA_EXCH(SET_PRM);
    }
}

static void T80_only_rates_of_the_board_are_tried(void)
{
    static const uint32_t board[] = {9600, 19200, 93750, 187500, 0};
    for (unsigned i = 0; board[i]; i++) {
        dp_begin_at(8, DDLM_BAUD_AUTO, board[i]);
        hv_port.rates = board;
        dp_power_cycle();
        traffic(board[i], 4 * (hv_time)HV_S);
        found(board[i]);
    }
    TEST_ASSERT_EQUAL(0, dp_reports);
}

static void T81_a_change_of_rate_is_followed_after_Baud_Control(void)
{
    dp_begin_at(8, DDLM_BAUD_AUTO, 500000);
    traffic(500000, 2 * (hv_time)HV_S);
    found(500000);
    seg_set_rate(19200);
    traffic(19200, 5 * (hv_time)HV_S + 3 * (hv_time)HV_S); /* Baud_Control 5 s, then the search */
    found(19200);
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
}

static void T82_noise_is_not_taken_for_a_rate(void)
{
    uint64_t random = 82;
    dp_begin_at(8, DDLM_BAUD_AUTO, 19200);
    for (unsigned i = 0; i < 400; i++) {
        uint8_t noise[64];
        dp_tester.bit = hv_bit_of(rates[sim_below(&random, RATES)]);
        for (unsigned k = 0; k < sizeof noise; k++)
            noise[k] = (uint8_t)sim_random(&random);
        seg_send(&dp_tester, hv_now(), noise, sizeof noise, 0);
        hv_run_for(sizeof noise * 11 * dp_tester.bit + sim_below(&random, 5 * HV_MS));
        TEST_ASSERT_EQUAL(DDLM_BAUD_SEARCH, dp_info()->wd_state);
    }
    traffic(19200, 4 * (hv_time)HV_S);
    found(19200);
}

static void T83_without_a_telegram_to_us_Baud_Control_ends_after_5_s(void)
{
    dp_begin_at(8, DDLM_BAUD_AUTO, 19200);
    traffic(19200, 4 * (hv_time)HV_S);
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
    const hv_time end = request_end();
    while (hv_now() < end + 5 * (hv_time)HV_S - HV_MS)
        hv_run_for(HV_MS);
    found(19200);
    hv_run_until(end + 5 * (hv_time)HV_S + 2 * TURN);
    TEST_ASSERT_EQUAL(DDLM_BAUD_SEARCH, dp_info()->wd_state);
}

static void T83_a_search_does_not_end_data_exchange(void)
{
    dp_begin_at(8, DDLM_BAUD_AUTO, 19200);
    traffic(19200, 4 * (hv_time)HV_S);
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    hv_run_for(6 * (hv_time)HV_S);
    TEST_ASSERT_EQUAL(DDLM_BAUD_SEARCH, dp_info()->wd_state);
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(0x11, 0x22);
    traffic(19200, 4 * (hv_time)HV_S);
    ASK(DX, DX_OK);
}

static void T83_under_the_watchdog_the_rate_stays_until_it_expires(void)
{
    dp_begin_at(8, DDLM_BAUD_AUTO, 19200);
    traffic(19200, 4 * (hv_time)HV_S);
    TO_DATA_EXCH(SET_PRM_WD);
    TEST_ASSERT_EQUAL(DDLM_DP_CONTROL, dp_info()->wd_state);
    hv_run_for(2 * T_WD);
    STATE(DDLM_WAIT_PRM);
    found(19200);
}

/* ---- T_SDR ----------------------------------------------------------------------------------------------------- */

/* In virtual time the port is ideal; what an 8051 adds is measured on its simulator. */
static void T84_answers_start_exactly_min_T_SDR_after_the_request_at_every_rate(void)
{
    static const uint8_t codes[] = {PHY_BAUD_9K6,   PHY_BAUD_19K2, PHY_BAUD_45K45, PHY_BAUD_93K75,
                                    PHY_BAUD_187K5, PHY_BAUD_500K, PHY_BAUD_1M5,   PHY_BAUD_3M,
                                    PHY_BAUD_6M,    PHY_BAUD_12M};
    for (unsigned i = 0; i < RATES; i++) {
        dp_begin_at(8, codes[i], rates[i]);
        ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
        TEST_ASSERT_EQUAL_UINT64(11 * hv_bit(), seg_said.t_sdr);
        ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 3C 12 34 01 F7 16", ACK); /* with the old min_T_SDR */
        seg_set_min_t_sdr(60);
        ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
        TEST_ASSERT_EQUAL_UINT64(60 * hv_bit(), seg_said.t_sdr);
    }
}

static void T84_a_port_with_latency_still_answers_before_max_T_SDR(void)
{
    hv_port.octet_latency = 10 * hv_bit(); /* just before the next octet would be lost */
    hv_port.send_latency = 40 * hv_bit();
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16"); /* the judge knows the limit */
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
}

static void T84_the_answer_does_not_wait_for_the_main_loop(void)
{
    TO_DATA_EXCH(SET_PRM);
    hv_set_loop(NULL, NULL);
    ASK(DX, DX_OK);
    TEST_ASSERT_EQUAL_UINT64(11 * hv_bit(), seg_said.t_sdr);
    DIAG(0x0004);
    TEST_ASSERT_EQUAL_UINT64(11 * hv_bit(), seg_said.t_sdr);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T75_the_watchdog_expires_after_T_WD_never_before_and_at_most_a_turn_later);
    RUN_TEST(T76_each_telegram_of_the_owner_restarts_it);
    RUN_TEST(T76_a_retry_restarts_it_too);
    RUN_TEST(T76_another_master_or_another_station_does_not_restart_it);
    RUN_TEST(T77_after_expiry_anyone_may_take_the_station);
    RUN_TEST(T78_Slave_Diag_shows_whether_the_watchdog_is_on);
    RUN_TEST(T79_without_watchdog_the_outputs_stay);
    RUN_TEST(T79_a_main_loop_that_comes_late_neither_misses_nor_invents_an_expiry);
    RUN_TEST(T80_every_rate_is_found_in_the_traffic_of_others);
    RUN_TEST(T80_only_rates_of_the_board_are_tried);
    RUN_TEST(T81_a_change_of_rate_is_followed_after_Baud_Control);
    RUN_TEST(T82_noise_is_not_taken_for_a_rate);
    RUN_TEST(T83_without_a_telegram_to_us_Baud_Control_ends_after_5_s);
    RUN_TEST(T83_a_search_does_not_end_data_exchange);
    RUN_TEST(T83_under_the_watchdog_the_rate_stays_until_it_expires);
    RUN_TEST(T84_answers_start_exactly_min_T_SDR_after_the_request_at_every_rate);
    RUN_TEST(T84_a_port_with_latency_still_answers_before_max_T_SDR);
    RUN_TEST(T84_the_answer_does_not_wait_for_the_main_loop);
    return UNITY_END();
}
