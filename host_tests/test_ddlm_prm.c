/* Set_Prm: the station is taken, given up, or told another min_T_SDR.
 * Clause: EN 50170-2 part 8, Set_Prm; spec A6; facts 3.7.
 * 1 Station_status: 80 Lock 40 Unlock 20 Sync 10 Freeze 08 WD_On; 2, 3 WD factors; 4 min_T_SDR; 5, 6 ident; 7 group;
 * 8... user parameters. Slave_Diag: 42 = not ready, Prm_Fault; 05 = Prm_Req, always 1; FF = no master. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    app.prm_count = 0;
    app.faults = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, app.faults);
    fake_end();
}

#define SET_PRM(du) ask_sap(8, 2, 61, du)
#define GOOD        "80 00 00 0B 12 34 00"

/* Acknowledged, Prm_Fault, no owner. */
static void rejected(void)
{
    ANSWERED("E5");
    STATE(DDLM_WAIT_PRM);
    INFO(DDLM_NO_MASTER, master);
    COUNTED(1, prm_rejected);
    DIAG("42 05 00 FF 12 34");
}

static void taken(void)
{
    ANSWERED("E5");
    STATE(DDLM_WAIT_CFG);
    INFO(2, master);
    COUNTED(0, prm_rejected);
}

static void good_parameters_with_lock_take_the_station(void)
{
    SET_PRM(GOOD);
    taken();
    DIAG("02 04 00 02 12 34");
    TEST_ASSERT_EQUAL(1, app.prm_count);
    TEST_ASSERT_EQUAL(0, app.prm_len);
}

static void both_priorities_are_taken(void)
{
    ask("68 0C 0C 68 88 82 6C 3D 3E 80 00 00 0B 12 34 00 C2 16");
    taken();
}

static void the_state_is_indicated_to_the_application(void)
{
    app.states = 0;
    SET_PRM(GOOD);
    TEST_ASSERT_EQUAL(1, app.states);
    TEST_ASSERT_EQUAL(DDLM_WAIT_CFG, app.state);
}

static void a_wrong_high_octet_of_the_ident_is_a_parameter_fault(void)
{
    SET_PRM("80 00 00 0B 13 34 00");
    rejected();
    TEST_ASSERT_EQUAL(0, app.prm_count);
}

static void a_wrong_low_octet_of_the_ident_is_a_parameter_fault(void)
{
    SET_PRM("80 00 00 0B 12 35 00");
    rejected();
}

static void six_octets_are_too_few(void)
{
    SET_PRM("80 00 00 0B 12 34");
    rejected();
}

static void no_octet_at_all_is_too_few(void)
{
    SET_PRM("");
    rejected();
}

static void user_parameters_are_handed_to_the_application(void)
{
    SET_PRM(GOOD " A1 A2 A3");
    taken();
    TEST_ASSERT_EQUAL(3, app.prm_len);
    OCTETS("A1 A2 A3", app.prm, 3);
}

static void more_user_parameters_than_the_device_has_are_a_parameter_fault(void)
{
    SET_PRM(GOOD " A1 A2 A3 A4");
    rejected();
    TEST_ASSERT_EQUAL(0, app.prm_count);
}

static void user_parameters_the_application_refuses_are_a_parameter_fault(void)
{
    app.prm_good = false;
    SET_PRM(GOOD " A1");
    rejected();
}

static void the_application_is_not_asked_about_parameters_that_are_wrong_anyway(void)
{
    SET_PRM("88 00 01 0B 12 34 00 A1");
    TEST_ASSERT_EQUAL(0, app.prm_count);
}

static void watchdog_factors_multiply_to_10_ms_steps(void)
{
    SET_PRM("88 01 01 0B 12 34 00");
    taken();
    INFO(true, wd_on);
    INFO(10, wd_ms);
    DIAG("02 0C 00 02 12 34");
    SET_PRM("88 FF FF 0B 12 34 00");
    INFO(650250, wd_ms);
}

static void a_watchdog_factor_of_0_is_a_parameter_fault(void)
{
    SET_PRM("88 00 01 0B 12 34 00");
    rejected();
}

static void the_second_watchdog_factor_of_0_too(void)
{
    SET_PRM("88 01 00 0B 12 34 00");
    rejected();
}

static void without_wd_on_the_factors_mean_nothing(void)
{
    SET_PRM("88 05 05 0B 12 34 00");
    SET_PRM(GOOD);
    taken();
    INFO(false, wd_on);
    INFO(0, wd_ms);
}

static void min_t_sdr_0_keeps_what_was_set(void)
{
    SET_PRM("80 00 00 1E 12 34 00");
    INFO(30, min_t_sdr);
    SET_PRM("80 00 00 00 12 34 00");
    taken();
    INFO(30, min_t_sdr);
}

/* max_T_SDR is 60 T_bit at 19.2 kbit/s. */
static void min_t_sdr_from_11_to_max_t_sdr_is_taken(void)
{
    SET_PRM("80 00 00 3C 12 34 00");
    taken();
    INFO(60, min_t_sdr);
    SET_PRM("80 00 00 0B 12 34 00");
    INFO(11, min_t_sdr);
}

static void min_t_sdr_below_11_is_a_parameter_fault(void)
{
    SET_PRM("80 00 00 0A 12 34 00");
    rejected();
    INFO(11, min_t_sdr);
}

static void min_t_sdr_above_max_t_sdr_is_a_parameter_fault(void)
{
    SET_PRM("80 00 00 3D 12 34 00");
    rejected();
}

static void sync_freeze_and_group_are_taken_with_lock(void)
{
    SET_PRM("B0 00 00 0B 12 34 A5");
    taken();
    INFO(true, sync_enabled);
    INFO(true, freeze_enabled);
    INFO(0xA5, groups);
    SET_PRM("90 00 00 0B 12 34 00");
    INFO(false, sync_enabled);
    INFO(true, freeze_enabled);
    INFO(0, groups);
    SET_PRM("A0 00 00 0B 12 34 00");
    INFO(true, sync_enabled);
    INFO(false, freeze_enabled);
}

static void reserved_bits_of_the_status_mean_nothing(void)
{
    SET_PRM("87 00 00 0B 12 34 00");
    taken();
}

/* ---- neither lock nor unlock ---- */

static void without_lock_and_unlock_only_min_t_sdr_changes(void)
{
    SET_PRM("A8 01 01 0B 12 34 07");
    SET_PRM("38 02 02 14 12 34 FF");
    taken();
    INFO(20, min_t_sdr);
    INFO(10, wd_ms);
    INFO(7, groups);
    INFO(false, freeze_enabled);
    TEST_ASSERT_EQUAL(1, app.prm_count);
}

static void min_t_sdr_alone_changes_even_with_a_wrong_ident(void)
{
    SET_PRM("00 00 00 14 FF FF 00");
    ANSWERED("E5");
    INFO(20, min_t_sdr);
    STATE(DDLM_WAIT_PRM);
    DIAG("02 05 00 FF 12 34");
}

static void min_t_sdr_alone_out_of_range_is_ignored(void)
{
    SET_PRM("00 00 00 0A 12 34 00");
    INFO(11, min_t_sdr);
    SET_PRM("00 00 00 3D 12 34 00");
    INFO(11, min_t_sdr);
    SET_PRM("00 00 00 00 12 34 00");
    INFO(11, min_t_sdr);
    DIAG("02 05 00 FF 12 34");
}

/* ---- unlock ---- */

static void unlock_gives_the_station_up(void)
{
    to_data_exch();
    SET_PRM("40 00 00 00 12 34 00");
    ANSWERED("E5");
    STATE(DDLM_WAIT_PRM);
    INFO(DDLM_NO_MASTER, master);
    DIAG("02 05 00 FF 12 34");
}

static void lock_and_unlock_together_unlock(void)
{
    SET_PRM(GOOD);
    SET_PRM("C0 00 00 00 12 34 00");
    STATE(DDLM_WAIT_PRM);
}

static void unlock_with_a_wrong_ident_is_a_parameter_fault(void)
{
    SET_PRM(GOOD);
    SET_PRM("40 00 00 00 12 35 00");
    rejected();
}

static void unlock_clears_earlier_faults(void)
{
    SET_PRM("80 00 00 0B 12 35 00");
    SET_PRM("40 00 00 00 12 34 00");
    DIAG("02 05 00 FF 12 34");
}

/* ---- who and when ---- */

static void a_station_that_is_locked_ignores_other_masters(void)
{
    SET_PRM(GOOD);
    ask_sap(8, 3, 61, "80 00 00 14 12 34 00");
    ANSWERED("E5");
    ask_sap(8, 3, 61, "40 00 00 00 12 34 00");
    ask_sap(8, 3, 61, "00 00 00 14 12 34 00");
    ask_sap(8, 3, 61, "");
    taken();
    INFO(11, min_t_sdr);
    COUNTED(4, not_processed);
}

static void a_station_that_was_unlocked_belongs_to_the_next_master(void)
{
    SET_PRM(GOOD);
    SET_PRM("40 00 00 00 12 34 00");
    ask_sap(8, 3, 61, GOOD);
    STATE(DDLM_WAIT_CFG);
    INFO(3, master);
}

static void bad_parameters_of_the_owner_throw_it_out_of_data_exchange(void)
{
    to_data_exch();
    SET_PRM("80 00 00 0B 12 35 00");
    rejected();
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    ANSWERED("10 02 08 03 0D 16");
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
}

static void good_parameters_in_data_exchange_start_the_configuration_anew(void)
{
    to_data_exch();
    ddlm_outputs(outputs);
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    OUTPUTS(DDLM_OUT_NEW, "01 02");
    SET_PRM(GOOD);
    taken();
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    ANSWERED("10 02 08 03 0D 16");
    inputs("31 01"); /* not before the next Chk_Cfg */
    STATE(DDLM_WAIT_CFG);
}

static void good_parameters_clear_a_parameter_fault(void)
{
    SET_PRM("80 00 00 0B 12 35 00");
    DIAG("42 05 00 FF 12 34");
    SET_PRM(GOOD);
    DIAG("02 04 00 02 12 34");
}

static void a_repeated_set_prm_is_acknowledged_and_not_executed_again(void)
{
    ask("68 0C 0C 68 88 82 7D 3D 3E 80 00 00 0B 12 34 00 D3 16");
    ask("68 0C 0C 68 88 82 7D 3D 3E 80 00 00 0B 12 34 00 D3 16");
    ANSWERED("E5");
    TEST_ASSERT_EQUAL(1, app.prm_count);
}

static void parameters_wait_for_the_main_loop_in_boxes_and_the_fourth_is_refused_rr(void)
{
    request("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 0B 12 34 00 C3 16");
    request("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 0B 12 34 00 C3 16");
    request("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 0B 12 34 00 C3 16");
    ANSWERED("E5");
    request("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 0B 12 34 00 C3 16");
    ANSWERED("10 02 08 02 0C 16");
    turn();
    TEST_ASSERT_EQUAL(3, app.prm_count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(good_parameters_with_lock_take_the_station);
    RUN_TEST(both_priorities_are_taken);
    RUN_TEST(the_state_is_indicated_to_the_application);
    RUN_TEST(a_wrong_high_octet_of_the_ident_is_a_parameter_fault);
    RUN_TEST(a_wrong_low_octet_of_the_ident_is_a_parameter_fault);
    RUN_TEST(six_octets_are_too_few);
    RUN_TEST(no_octet_at_all_is_too_few);
    RUN_TEST(user_parameters_are_handed_to_the_application);
    RUN_TEST(more_user_parameters_than_the_device_has_are_a_parameter_fault);
    RUN_TEST(user_parameters_the_application_refuses_are_a_parameter_fault);
    RUN_TEST(the_application_is_not_asked_about_parameters_that_are_wrong_anyway);
    RUN_TEST(watchdog_factors_multiply_to_10_ms_steps);
    RUN_TEST(a_watchdog_factor_of_0_is_a_parameter_fault);
    RUN_TEST(the_second_watchdog_factor_of_0_too);
    RUN_TEST(without_wd_on_the_factors_mean_nothing);
    RUN_TEST(min_t_sdr_0_keeps_what_was_set);
    RUN_TEST(min_t_sdr_from_11_to_max_t_sdr_is_taken);
    RUN_TEST(min_t_sdr_below_11_is_a_parameter_fault);
    RUN_TEST(min_t_sdr_above_max_t_sdr_is_a_parameter_fault);
    RUN_TEST(sync_freeze_and_group_are_taken_with_lock);
    RUN_TEST(reserved_bits_of_the_status_mean_nothing);
    RUN_TEST(without_lock_and_unlock_only_min_t_sdr_changes);
    RUN_TEST(min_t_sdr_alone_changes_even_with_a_wrong_ident);
    RUN_TEST(min_t_sdr_alone_out_of_range_is_ignored);
    RUN_TEST(unlock_gives_the_station_up);
    RUN_TEST(lock_and_unlock_together_unlock);
    RUN_TEST(unlock_with_a_wrong_ident_is_a_parameter_fault);
    RUN_TEST(unlock_clears_earlier_faults);
    RUN_TEST(a_station_that_is_locked_ignores_other_masters);
    RUN_TEST(a_station_that_was_unlocked_belongs_to_the_next_master);
    RUN_TEST(bad_parameters_of_the_owner_throw_it_out_of_data_exchange);
    RUN_TEST(good_parameters_in_data_exchange_start_the_configuration_anew);
    RUN_TEST(good_parameters_clear_a_parameter_fault);
    RUN_TEST(a_repeated_set_prm_is_acknowledged_and_not_executed_again);
    RUN_TEST(parameters_wait_for_the_main_loop_in_boxes_and_the_fourth_is_refused_rr);
    return UNITY_END();
}
