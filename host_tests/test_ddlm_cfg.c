/* Chk_Cfg and Get_Cfg of a device that does not adapt.
 * Clause: EN 50170-2 part 8, Chk_Cfg, Get_Cfg; spec A6; facts 3.6. Own configuration: 10 20 10 20. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    app.cfg_count = 0;
    app.faults = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, app.faults);
    fake_end();
}

#define CHK_CFG(du) ask_sap(8, 2, 62, du)
#define OWN         "10 20 10 20"

/* Acknowledged, Cfg_Fault, no owner. */
static void rejected(void)
{
    ANSWERED("E5");
    STATE(DDLM_WAIT_PRM);
    COUNTED(1, cfg_rejected);
    DIAG("06 05 00 FF 12 34");
}

static void the_own_configuration_is_accepted_and_inputs_are_awaited(void)
{
    to_wait_cfg();
    inputs("31 01");
    STATE(DDLM_WAIT_CFG);
    CHK_CFG(OWN);
    ANSWERED("E5");
    STATE(DDLM_WAIT_CFG);
    INFO(true, not_ready);
    DIAG("02 04 00 02 12 34");
    inputs("31 01");
    STATE(DDLM_DATA_EXCH);
    INFO(false, not_ready);
    DIAG("00 04 00 02 12 34");
    TEST_ASSERT_EQUAL(0, app.cfg_count);
}

static void a_missing_module_is_a_configuration_fault(void)
{
    to_wait_cfg();
    CHK_CFG("10 20 10");
    rejected();
    TEST_ASSERT_EQUAL(1, app.cfg_count);
    TEST_ASSERT_EQUAL(3, app.cfg_len);
}

static void one_module_more_is_a_configuration_fault(void)
{
    to_wait_cfg();
    CHK_CFG("10 20 10 20 00");
    rejected();
}

static void modules_in_another_order_are_a_configuration_fault(void)
{
    to_wait_cfg();
    CHK_CFG("10 10 20 20");
    rejected();
}

static void another_consistency_is_a_configuration_fault(void)
{
    to_wait_cfg();
    CHK_CFG("10 20 10 A0");
    rejected();
}

static void an_empty_configuration_is_a_configuration_fault(void)
{
    to_wait_cfg();
    CHK_CFG("");
    rejected();
}

static void a_configuration_that_is_cut_off_is_not_even_shown_to_the_application(void)
{
    to_wait_cfg();
    CHK_CFG("10 20 10 40");
    rejected();
    TEST_ASSERT_EQUAL(0, app.cfg_count);
}

static void the_fault_stays_until_the_next_good_parameters(void)
{
    to_wait_cfg();
    CHK_CFG("10");
    DIAG("06 05 00 FF 12 34");
    to_wait_cfg();
    DIAG("02 04 00 02 12 34");
}

static void a_configuration_before_parameters_is_not_processed(void)
{
    CHK_CFG(OWN);
    ANSWERED("E5");
    STATE(DDLM_WAIT_PRM);
    COUNTED(1, not_processed);
    DIAG("02 05 00 FF 12 34");
}

static void a_configuration_of_another_master_is_not_processed(void)
{
    to_wait_cfg();
    ask_sap(8, 3, 62, "10");
    ANSWERED("E5");
    STATE(DDLM_WAIT_CFG);
    COUNTED(1, not_processed);
    COUNTED(0, cfg_rejected);
}

static void the_same_configuration_in_data_exchange_changes_nothing(void)
{
    to_data_exch();
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    CHK_CFG(OWN);
    ANSWERED("E5");
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    ask_sap(8, 3, 62, OWN);
    COUNTED(1, not_processed);
    STATE(DDLM_DATA_EXCH);
}

static void a_wrong_configuration_in_data_exchange_ends_it(void)
{
    to_data_exch();
    CHK_CFG("10");
    rejected();
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    ANSWERED("10 02 08 03 0D 16");
}

static void the_same_configuration_twice_still_waits_for_inputs(void)
{
    to_wait_cfg();
    CHK_CFG(OWN);
    CHK_CFG(OWN);
    STATE(DDLM_WAIT_CFG);
    inputs("31 01");
    STATE(DDLM_DATA_EXCH);
}

/* ---- Get_Cfg ---- */

#define REAL "68 09 09 68 82 88 08 3E 3B 10 20 10 20 EB 16"

static void get_cfg_is_answered_with_the_real_configuration_in_every_state(void)
{
    request("68 05 05 68 88 82 6D 3B 3E F0 16");
    ANSWERED(REAL);
    to_wait_cfg();
    request("68 05 05 68 88 82 6C 3B 3E EF 16");
    ANSWERED(REAL);
    to_data_exch();
    request("68 05 05 68 88 82 6D 3B 3E F0 16");
    ANSWERED(REAL);
    request("68 05 05 68 88 83 6D 3B 3E F1 16");
    ANSWERED("68 09 09 68 83 88 08 3E 3B 10 20 10 20 EC 16");
}

static void get_cfg_with_data_is_refused_rr(void)
{
    request("68 06 06 68 88 82 6D 3B 3E 00 F0 16");
    ANSWERED("10 02 08 02 0C 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_own_configuration_is_accepted_and_inputs_are_awaited);
    RUN_TEST(a_missing_module_is_a_configuration_fault);
    RUN_TEST(one_module_more_is_a_configuration_fault);
    RUN_TEST(modules_in_another_order_are_a_configuration_fault);
    RUN_TEST(another_consistency_is_a_configuration_fault);
    RUN_TEST(an_empty_configuration_is_a_configuration_fault);
    RUN_TEST(a_configuration_that_is_cut_off_is_not_even_shown_to_the_application);
    RUN_TEST(the_fault_stays_until_the_next_good_parameters);
    RUN_TEST(a_configuration_before_parameters_is_not_processed);
    RUN_TEST(a_configuration_of_another_master_is_not_processed);
    RUN_TEST(the_same_configuration_in_data_exchange_changes_nothing);
    RUN_TEST(a_wrong_configuration_in_data_exchange_ends_it);
    RUN_TEST(the_same_configuration_twice_still_waits_for_inputs);
    RUN_TEST(get_cfg_is_answered_with_the_real_configuration_in_every_state);
    RUN_TEST(get_cfg_with_data_is_refused_rr);
    return UNITY_END();
}
