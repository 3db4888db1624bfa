/* A device without anything optional and an application without any callback: refusals, and the defaults of the library.
 * Clause: EN 50170-2 part 8; spec A6; facts 3.6, 3.7. Ident 00AA, one octet each way, one or two user parameters. */
#include "ddlm_unit.h"

void setUp(void)
{
    station_begin(8);
}

void tearDown(void)
{
    fake_end();
}

static void run(void)
{
    ask_sap(8, 2, 61, "80 00 00 0B 00 AA 00 01");
    STATE(DDLM_WAIT_CFG);
    ask_sap(8, 2, 62, "30");
    inputs("A1");
    STATE(DDLM_DATA_EXCH);
}

static void it_comes_to_data_exchange_with_the_defaults_alone(void)
{
    run();
    request("68 04 04 68 08 02 6D 01 78 16");
    ANSWERED("68 04 04 68 02 08 08 A1 B3 16");
    ddlm_outputs(outputs);
    OUTPUTS(DDLM_OUT_SAME, "01");
}

static void sync_or_freeze_asked_for_is_not_supported_and_a_parameter_fault(void)
{
    ask_sap(8, 2, 61, "A0 00 00 0B 00 AA 00 01");
    STATE(DDLM_WAIT_PRM);
    DIAG("52 05 00 FF 00 AA");
    ask_sap(8, 2, 61, "90 00 00 0B 00 AA 00 01");
    STATE(DDLM_WAIT_PRM);
    COUNTED(2, prm_rejected);
}

static void sync_and_freeze_commands_are_not_supported(void)
{
    run();
    ask("68 07 07 68 FF 82 46 3A 3E 28 00 67 16");
    INFO(false, sync);
    INFO(false, freeze);
    DIAG("10 04 00 02 00 AA");
    STATE(DDLM_DATA_EXCH);
}

static void fewer_user_parameters_than_it_wants_are_a_parameter_fault(void)
{
    ask_sap(8, 2, 61, "80 00 00 0B 00 AA 00");
    STATE(DDLM_WAIT_PRM);
    ask_sap(8, 2, 61, "80 00 00 0B 00 AA 00 01 02 03");
    STATE(DDLM_WAIT_PRM);
    DIAG("42 05 00 FF 00 AA");
    ask_sap(8, 2, 61, "80 00 00 0B 00 AA 00 01 02");
    STATE(DDLM_WAIT_CFG);
}

static void set_slave_add_is_refused_rs_even_without_an_address(void)
{
    ask_sap(8, 2, 55, "09 00 AA 00");
    ANSWERED("10 02 08 03 0D 16");
    station_begin(126);
    STATE(DDLM_POWER_ON);
    ask_sap(126, 2, 55, "09 00 AA 00");
    ANSWERED("10 02 7E 03 83 16");
}

static void another_configuration_is_not_adapted_to(void)
{
    ask_sap(8, 2, 61, "80 00 00 0B 00 AA 00 01");
    ask_sap(8, 2, 62, "B0");
    STATE(DDLM_WAIT_PRM);
    DIAG("06 05 00 FF 00 AA");
}

/* DDLM_WRONG_LENGTH_LEAVES = 0. */
static void a_wrong_output_length_is_refused_rs_and_data_exchange_goes_on(void)
{
    run();
    ask("68 05 05 68 08 02 6D 01 02 7A 16");
    ANSWERED("10 02 08 03 0D 16");
    STATE(DDLM_DATA_EXCH);
    COUNTED(1, wrong_length);
    request("68 04 04 68 08 02 6D 01 78 16");
    ANSWERED("68 04 04 68 02 08 08 A1 B3 16");
}

/* Fail_Safe = 0: a master has to send zeros. */
static void no_outputs_at_all_are_a_wrong_length(void)
{
    run();
    ask("10 08 02 6D 77 16");
    ANSWERED("10 02 08 03 0D 16");
    COUNTED(1, wrong_length);
}

static void clear_is_understood_all_the_same(void)
{
    run();
    request("68 04 04 68 08 02 6D 01 78 16");
    ask("68 07 07 68 FF 82 46 3A 3E 02 00 41 16");
    OUTPUTS(DDLM_OUT_SAFE, "00");
}

static void extended_diagnosis_it_has_no_room_for_is_an_overflow(void)
{
    static uint8_t XDATA block[2] = {0x02, 0x01};

    TEST_ASSERT_TRUE(ddlm_diag(block, 2, DDLM_EXT_DIAG));
    DIAG("0A 05 80 FF 00 AA");
}

static void data_for_a_sap_of_the_application_are_acknowledged_and_dropped(void)
{
    fma_rsap_activate(40, FDL_ALL, 8, FDL_TO_MAIN, 0);
    ask_sap(8, 2, 40, "01 02");
    ANSWERED("E5");
}

static void a_fault_of_management_stops_nothing(void)
{
    fake.masked = true;
    TEST_ASSERT_EQUAL(DDLM_IV, ddlm_slave_init(127, 1));
    fake.masked = false;
    run();
}

static void the_bus_falling_silent_stops_nothing(void)
{
    run();
    turn_after(60000);
    turn_after(60000);
    turn_after(60000);
    STATE(DDLM_DATA_EXCH);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(it_comes_to_data_exchange_with_the_defaults_alone);
    RUN_TEST(sync_or_freeze_asked_for_is_not_supported_and_a_parameter_fault);
    RUN_TEST(sync_and_freeze_commands_are_not_supported);
    RUN_TEST(fewer_user_parameters_than_it_wants_are_a_parameter_fault);
    RUN_TEST(set_slave_add_is_refused_rs_even_without_an_address);
    RUN_TEST(another_configuration_is_not_adapted_to);
    RUN_TEST(a_wrong_output_length_is_refused_rs_and_data_exchange_goes_on);
    RUN_TEST(no_outputs_at_all_are_a_wrong_length);
    RUN_TEST(clear_is_understood_all_the_same);
    RUN_TEST(extended_diagnosis_it_has_no_room_for_is_an_overflow);
    RUN_TEST(data_for_a_sap_of_the_application_are_acknowledged_and_dropped);
    RUN_TEST(a_fault_of_management_stops_nothing);
    RUN_TEST(the_bus_falling_silent_stops_nothing);
    return UNITY_END();
}
