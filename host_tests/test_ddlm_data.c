/* Data_Exchange, RD_Inp, RD_Outp and Global_Control: what reaches the application, and when.
 * Clause: EN 50170-2 part 8, Data_Exchange, Global_Control; spec A6; facts 3.6, 3.11.
 * Global_Control: 02 Clear 04 Unfreeze 08 Freeze 10 Unsync 20 Sync; then Group_Select, 0 = all. */
#include "ddlm_unit.h"

/* In data exchange with Sync and Freeze enabled, group 05; the power-up fail-safe state has been taken. */
void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    app.faults = 0;
    ask_sap(8, 2, 61, "B0 00 00 0B 12 34 05");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, app.faults);
    fake_end();
}

static void write(uint8_t octet)
{
    fake.sent_len = 0;
    fake_silence();
    hear("68 05 05 68 08 02 6D");
    fake_octet(octet, 0);
    fake_octet(octet, 0);
    fake_octet((uint8_t)(0x77 + 2 * octet), 0);
    fake_octet(0x16, 0);
    finish_request();
}

/* To all slaves, from the owner: FF + 82 + 46 + 3A + 3E = 23F. */
static void control(uint8_t command, uint8_t group)
{
    fake.sent_len = 0;
    fake_silence();
    hear("68 07 07 68 FF 82 46 3A 3E");
    fake_octet(command, 0);
    fake_octet(group, 0);
    fake_octet((uint8_t)(0x3F + command + group), 0);
    fake_octet(0x16, 0);
    finish_request();
    NOT_ANSWERED();
    turn();
}

#define RS     "10 02 08 03 0D 16"
#define INPUTS "68 05 05 68 02 08 08 31 01 44 16"

/* ---- Data_Exchange ---- */

static void outputs_come_in_and_inputs_go_out_at_once(void)
{
    request("68 05 05 68 08 02 6D A1 A2 BA 16");
    ANSWERED(INPUTS);
    OUTPUTS(DDLM_OUT_NEW, "A1 A2");
    OUTPUTS(DDLM_OUT_SAME, "A1 A2");
    COUNTED(1, data_exchange);
}

static void the_newest_outputs_count(void)
{
    write(1);
    write(2);
    write(3);
    OUTPUTS(DDLM_OUT_NEW, "03 03");
    OUTPUTS(DDLM_OUT_SAME, "03 03");
    COUNTED(3, data_exchange);
}

static void the_newest_inputs_count(void)
{
    inputs("32 00");
    inputs("33 01");
    write(1);
    ANSWERED("68 05 05 68 02 08 08 33 01 46 16");
}

static void a_repeated_data_exchange_is_answered_alike_and_executed_once(void)
{
    request("68 05 05 68 08 02 7D 01 02 8A 16");
    OUTPUTS(DDLM_OUT_NEW, "01 02");
    inputs("44 44");
    request("68 05 05 68 08 02 7D 01 02 8A 16");
    ANSWERED(INPUTS);
    OUTPUTS(DDLM_OUT_SAME, "01 02");
    COUNTED(1, data_exchange);
}

static void an_sd3_would_be_too_long_for_two_octets(void)
{
    request("A2 08 02 6D 01 02 03 04 05 06 07 08 9B 16");
    ANSWERED(RS);
    OUTPUTS(DDLM_OUT_SAME, "00 00");
}

static void another_master_is_refused_rs(void)
{
    request("68 05 05 68 08 03 6D 01 02 7B 16");
    ANSWERED("10 03 08 03 0E 16");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    STATE(DDLM_DATA_EXCH);
    COUNTED(0, wrong_length);
}

static void an_sdn_with_outputs_is_no_data_exchange(void)
{
    request("68 05 05 68 08 02 44 01 02 51 16");
    NOT_ANSWERED();
    OUTPUTS(DDLM_OUT_SAME, "00 00");
}

static void wrong_length(const char *hex)
{
    write(9);
    request(hex);
    ANSWERED(RS);
    request("68 05 05 68 08 02 6D 01 02 7A 16"); /* the main loop has not come round yet */
    ANSWERED(RS);
    turn();
    STATE(DDLM_WAIT_PRM);
    COUNTED(1, wrong_length);
    DIAG("06 05 00 FF 12 34");
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
}

static void one_output_octet_less_is_a_configuration_fault(void)
{
    wrong_length("68 04 04 68 08 02 6D 01 78 16");
}

static void one_output_octet_more_is_a_configuration_fault(void)
{
    wrong_length("68 06 06 68 08 02 6D 01 02 03 7D 16");
}

/* A device with Fail_Safe = 1: facts 3.11, CLEAR state. */
static void no_output_octets_at_all_mean_the_fail_safe_state(void)
{
    write(9);
    OUTPUTS(DDLM_OUT_NEW, "09 09");
    request("10 08 02 6D 77 16");
    ANSWERED(INPUTS);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    STATE(DDLM_DATA_EXCH);
    COUNTED(2, data_exchange);
    write(8);
    OUTPUTS(DDLM_OUT_NEW, "08 08");
}

static void outputs_and_fail_safe_before_the_application_looked_the_later_counts(void)
{
    write(9);
    request("10 08 02 6D 77 16");
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    request("10 08 02 6D 77 16");
    write(9);
    OUTPUTS(DDLM_OUT_NEW, "09 09");
    OUTPUTS(DDLM_OUT_SAME, "09 09");
}

static void inputs_before_data_exchange_are_not_taken(void)
{
    station_begin(8);
    inputs("77 77");
    to_data_exch();
    write(1);
    ANSWERED(INPUTS);
}

/* Executed when its answer is out: by then the owner may be gone (promise 4). */
static void outputs_answered_but_not_yet_executed_do_not_outlive_the_owner(void)
{
    fake_silence();
    hear("68 05 05 68 08 02 6D A1 A2 BA 16");
    fake_silence();
    ddlm_slave_init(8, 1);
    fake_sent();
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    setUp();
    fake_silence();
    hear("68 05 05 68 08 02 6D A1 A2 BA 16");
    fake_silence();
    fma_sap_deactivate(FDL_SAP_NIL); /* what leaving data exchange begins with */
    fake_sent();
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    COUNTED(0, data_exchange);
}

/* ---- RD_Inp, RD_Outp ---- */

static void any_master_may_read_the_inputs(void)
{
    request("68 05 05 68 88 83 6D 38 3E EE 16");
    ANSWERED("68 07 07 68 83 88 08 3E 38 31 01 BB 16");
    request("68 05 05 68 88 82 6C 38 3E EC 16");
    ANSWERED("68 07 07 68 82 88 08 3E 38 31 01 BA 16");
}

static void any_master_may_read_the_outputs_the_application_has(void)
{
    request("68 05 05 68 88 83 6D 39 3E EF 16");
    ANSWERED("68 07 07 68 83 88 08 3E 39 00 00 8A 16");
    write(5);
    ddlm_outputs(outputs);
    request("68 05 05 68 88 82 6C 39 3E ED 16");
    ANSWERED("68 07 07 68 82 88 08 3E 39 05 05 93 16");
}

static void reading_with_data_is_refused_rr(void)
{
    request("68 06 06 68 88 83 6D 38 3E 00 EE 16");
    ANSWERED("10 03 08 02 0D 16");
    request("68 06 06 68 88 83 6D 39 3E 00 EF 16");
    ANSWERED("10 03 08 02 0D 16");
}

/* ---- Sync ---- */

static void sync_holds_the_outputs_until_the_next_sync(void)
{
    write(1);
    OUTPUTS(DDLM_OUT_NEW, "01 01");
    control(0x20, 0);
    INFO(true, sync);
    write(2);
    write(3);
    OUTPUTS(DDLM_OUT_SAME, "01 01");
    control(0x20, 0);
    OUTPUTS(DDLM_OUT_NEW, "03 03");
    control(0x20, 0);
    OUTPUTS(DDLM_OUT_SAME, "03 03");
    COUNTED(3, global_control);
}

static void outputs_before_the_sync_command_are_not_held(void)
{
    write(1);
    control(0x20, 0);
    write(2);
    OUTPUTS(DDLM_OUT_NEW, "01 01");
    OUTPUTS(DDLM_OUT_SAME, "01 01");
}

static void unsync_gives_the_held_outputs_and_ends_the_mode(void)
{
    control(0x20, 0);
    write(2);
    control(0x10, 0);
    INFO(false, sync);
    OUTPUTS(DDLM_OUT_NEW, "02 02");
    write(3);
    OUTPUTS(DDLM_OUT_NEW, "03 03");
}

static void unsync_wins_over_sync(void)
{
    control(0x20, 0);
    write(2);
    control(0x30, 0);
    INFO(false, sync);
    OUTPUTS(DDLM_OUT_NEW, "02 02");
}

static void unsync_without_sync_changes_nothing(void)
{
    write(1);
    control(0x10, 0);
    OUTPUTS(DDLM_OUT_NEW, "01 01");
    control(0x10, 0);
    OUTPUTS(DDLM_OUT_SAME, "01 01");
}

/* ---- Freeze ---- */

static void freeze_takes_the_inputs_of_its_moment(void)
{
    inputs("32 00");
    control(0x08, 0);
    INFO(true, freeze);
    inputs("33 00");
    inputs("34 00");
    write(1);
    ANSWERED("68 05 05 68 02 08 08 32 00 44 16");
    control(0x08, 0);
    inputs("35 00");
    write(1);
    ANSWERED("68 05 05 68 02 08 08 34 00 46 16");
    write(2);
    ANSWERED("68 05 05 68 02 08 08 34 00 46 16");
}

static void unfreeze_gives_the_newest_inputs(void)
{
    control(0x08, 0);
    inputs("33 00");
    control(0x04, 0);
    INFO(false, freeze);
    write(1);
    ANSWERED("68 05 05 68 02 08 08 33 00 45 16");
    inputs("34 00");
    write(1);
    ANSWERED("68 05 05 68 02 08 08 34 00 46 16");
}

static void unfreeze_wins_over_freeze(void)
{
    control(0x08, 0);
    control(0x0C, 0);
    INFO(false, freeze);
}

static void frozen_inputs_are_read_frozen(void)
{
    control(0x08, 0);
    inputs("33 00");
    request("68 05 05 68 88 83 6D 38 3E EE 16");
    ANSWERED("68 07 07 68 83 88 08 3E 38 31 01 BB 16");
}

/* ---- Clear ---- */

static void clear_is_the_fail_safe_state_until_the_next_outputs(void)
{
    write(1);
    ddlm_outputs(outputs);
    control(0x02, 0);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    write(2);
    OUTPUTS(DDLM_OUT_NEW, "02 02");
    STATE(DDLM_DATA_EXCH);
}

static void clear_drops_outputs_that_are_held_or_waiting(void)
{
    control(0x20, 0);
    write(7);
    control(0x02, 0);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    control(0x10, 0);
    OUTPUTS(DDLM_OUT_SAME, "00 00");
    write(8);
    control(0x02, 0);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
}

static void operate_changes_nothing(void)
{
    write(1);
    control(0x00, 0);
    OUTPUTS(DDLM_OUT_NEW, "01 01");
    INFO(false, sync);
    INFO(false, freeze);
    COUNTED(1, global_control);
}

static void reserved_bits_of_the_command_mean_nothing(void)
{
    write(1);
    control(0xC1, 0);
    OUTPUTS(DDLM_OUT_NEW, "01 01");
    COUNTED(1, global_control);
}

static void several_commands_at_once_are_all_executed(void)
{
    control(0x2A, 0);
    INFO(true, sync);
    INFO(true, freeze);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
}

/* ---- groups and masters ---- */

static void a_group_that_is_ours_is_meant(void)
{
    control(0x20, 0x04);
    INFO(true, sync);
    control(0x10, 0xFF);
    INFO(false, sync);
}

static void a_group_that_is_not_ours_is_not_meant(void)
{
    control(0x20, 0xFA); /* ours is 05 */
    INFO(false, sync);
    COUNTED(0, global_control);
}

static void only_the_owner_controls(void)
{
    request("68 07 07 68 FF 83 46 3A 3E 20 00 60 16");
    turn();
    INFO(false, sync);
    COUNTED(0, global_control);
}

static void control_may_be_addressed_to_this_slave_alone(void)
{
    request("68 07 07 68 88 82 44 3A 3E 20 00 E6 16");
    NOT_ANSWERED();
    INFO(true, sync);
}

static void a_control_of_another_length_is_ignored(void)
{
    request("68 06 06 68 FF 82 46 3A 3E 20 5F 16");
    request("68 08 08 68 FF 82 46 3A 3E 20 00 00 5F 16");
    turn();
    INFO(false, sync);
    COUNTED(0, global_control);
}

static void control_by_srd_is_refused_rs(void)
{
    request("68 07 07 68 88 82 6D 3A 3E 20 00 0F 16");
    ANSWERED(RS);
    INFO(false, sync);
}

static void modes_that_were_not_asked_for_are_not_supported(void)
{
    ask_sap(8, 2, 61, "80 00 00 0B 12 34 05");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    control(0x20, 0);
    INFO(false, sync);
    DIAG("10 04 00 02 12 34");
    ask_sap(8, 2, 61, "80 00 00 0B 12 34 05");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    DIAG("00 04 00 02 12 34");
    control(0x08, 0);
    INFO(false, freeze);
    DIAG("10 04 00 02 12 34");
}

static void faults_of_data_exchange_add_up(void)
{
    ask_sap(8, 2, 61, "80 00 00 0B 12 34 05");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    control(0x20, 0);
    ask("68 04 04 68 08 02 6D 01 78 16");
    STATE(DDLM_WAIT_PRM);
    DIAG("16 05 00 FF 12 34");
}

/* The main loop has not come round between the two. */
static void a_command_that_is_not_supported_does_not_hide_a_wrong_length(void)
{
    ask_sap(8, 2, 61, "80 00 00 0B 12 34 05");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    request("68 04 04 68 08 02 6D 01 78 16");
    control(0x20, 0);
    STATE(DDLM_WAIT_PRM);
}

static void inputs_and_outputs_cannot_be_read_after_data_exchange(void)
{
    ask_sap(8, 2, 61, "40 00 00 00 12 34 00");
    request("68 05 05 68 88 82 6D 38 3E ED 16");
    ANSWERED(RS);
    request("68 05 05 68 88 82 6D 39 3E EE 16");
    ANSWERED(RS);
}

static void leaving_data_exchange_ends_sync_and_freeze(void)
{
    control(0x28, 0);
    write(7);
    ask_sap(8, 2, 61, "40 00 00 00 12 34 00");
    INFO(false, sync);
    INFO(false, freeze);
    INFO(0, groups);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
}

/* ---- promises under interrupts ---- */

static uint8_t next_octet;

static void the_master_writes(void)
{
    write(++next_octet);
}

/* Promise 1: outputs are those of one telegram, never a mixture, whenever the next one comes. */
static void outputs_are_never_a_mixture(void)
{
    uint8_t i;

    next_octet = 0;
    fake_at_unlock = the_master_writes;
    for (i = 0; i < 50; i++) {
        if (ddlm_outputs(outputs) == DDLM_OUT_NEW) {
            TEST_ASSERT_EQUAL_HEX8(outputs[0], outputs[1]);
            TEST_ASSERT_NOT_EQUAL(0, outputs[0]);
        }
    }
    fake_at_unlock = 0;
    ddlm_outputs(outputs);
    TEST_ASSERT_EQUAL(next_octet, outputs[0]);
}

static void the_master_clears(void)
{
    fake_at_unlock = 0;
    request("68 07 07 68 FF 82 46 3A 3E 02 00 41 16");
}

/* A Clear that comes while outputs are being taken is seen in the next turn at the latest. */
static void a_clear_is_never_lost(void)
{
    write(7);
    fake_at_unlock = the_master_clears;
    ddlm_outputs(outputs);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
}

/* Telegram buffers change hands for ever without one getting lost. */
static void buffers_are_not_used_up_by_any_order_of_commands(void)
{
    static const CODE uint8_t commands[8] = {0x20, 0x10, 0x08, 0x20, 0x02, 0x04, 0x10, 0x22};
    uint8_t i;

    for (i = 0; i < 200; i++) {
        write(i);
        ANSWERED(INPUTS);
        if (i & 1)
            control(commands[(i >> 1) & 7], 0);
        write((uint8_t)(i + 1));
        if ((i & 6) == 2)
            ddlm_outputs(outputs);
        if ((i & 63) == 63) {
            ask_sap(8, 2, 61, "B0 00 00 0B 12 34 05");
            ask_sap(8, 2, 62, "10 20 10 20");
            inputs("31 01");
        }
    }
    control(0x14, 0);
    ddlm_outputs(outputs);
    write(0x5A);
    OUTPUTS(DDLM_OUT_NEW, "5A 5A");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(outputs_come_in_and_inputs_go_out_at_once);
    RUN_TEST(the_newest_outputs_count);
    RUN_TEST(the_newest_inputs_count);
    RUN_TEST(a_repeated_data_exchange_is_answered_alike_and_executed_once);
    RUN_TEST(an_sd3_would_be_too_long_for_two_octets);
    RUN_TEST(another_master_is_refused_rs);
    RUN_TEST(an_sdn_with_outputs_is_no_data_exchange);
    RUN_TEST(one_output_octet_less_is_a_configuration_fault);
    RUN_TEST(one_output_octet_more_is_a_configuration_fault);
    RUN_TEST(no_output_octets_at_all_mean_the_fail_safe_state);
    RUN_TEST(outputs_and_fail_safe_before_the_application_looked_the_later_counts);
    RUN_TEST(inputs_before_data_exchange_are_not_taken);
    RUN_TEST(outputs_answered_but_not_yet_executed_do_not_outlive_the_owner);
    RUN_TEST(any_master_may_read_the_inputs);
    RUN_TEST(any_master_may_read_the_outputs_the_application_has);
    RUN_TEST(reading_with_data_is_refused_rr);
    RUN_TEST(sync_holds_the_outputs_until_the_next_sync);
    RUN_TEST(outputs_before_the_sync_command_are_not_held);
    RUN_TEST(unsync_gives_the_held_outputs_and_ends_the_mode);
    RUN_TEST(unsync_wins_over_sync);
    RUN_TEST(unsync_without_sync_changes_nothing);
    RUN_TEST(freeze_takes_the_inputs_of_its_moment);
    RUN_TEST(unfreeze_gives_the_newest_inputs);
    RUN_TEST(unfreeze_wins_over_freeze);
    RUN_TEST(frozen_inputs_are_read_frozen);
    RUN_TEST(clear_is_the_fail_safe_state_until_the_next_outputs);
    RUN_TEST(clear_drops_outputs_that_are_held_or_waiting);
    RUN_TEST(operate_changes_nothing);
    RUN_TEST(reserved_bits_of_the_command_mean_nothing);
    RUN_TEST(several_commands_at_once_are_all_executed);
    RUN_TEST(a_group_that_is_ours_is_meant);
    RUN_TEST(a_group_that_is_not_ours_is_not_meant);
    RUN_TEST(only_the_owner_controls);
    RUN_TEST(control_may_be_addressed_to_this_slave_alone);
    RUN_TEST(a_control_of_another_length_is_ignored);
    RUN_TEST(control_by_srd_is_refused_rs);
    RUN_TEST(modes_that_were_not_asked_for_are_not_supported);
    RUN_TEST(faults_of_data_exchange_add_up);
    RUN_TEST(a_command_that_is_not_supported_does_not_hide_a_wrong_length);
    RUN_TEST(inputs_and_outputs_cannot_be_read_after_data_exchange);
    RUN_TEST(leaving_data_exchange_ends_sync_and_freeze);
    RUN_TEST(outputs_are_never_a_mixture);
    RUN_TEST(a_clear_is_never_lost);
    RUN_TEST(buffers_are_not_used_up_by_any_order_of_commands);
    return UNITY_END();
}
