/* T47 - T52, T59 - T69: Data_Exchange, Global_Control, Rd_Inp, Rd_Outp. EN 50170-2 part 8; spec A6; facts 3.6, 3.11. */
#include "dp_fixture.h"

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

#define RS_      "10 02 08 03 0D 16"
#define RR_      "10 02 08 02 0C 16"
#define DX_33_44 "68 05 05 68 08 02 6D 33 44 EE 16"
#define DX_55_66 "68 05 05 68 08 02 6D 55 66 32 16"

/* Global_Control of master 2 to everybody: command, group */
#define OPERATE  "68 07 07 68 FF 82 46 3A 3E 00 00 3F 16"
#define CLEAR    "68 07 07 68 FF 82 46 3A 3E 02 00 41 16"
#define UNFREEZE "68 07 07 68 FF 82 46 3A 3E 04 00 43 16"
#define FREEZE   "68 07 07 68 FF 82 46 3A 3E 08 00 47 16"
#define UNSYNC   "68 07 07 68 FF 82 46 3A 3E 10 00 4F 16"
#define SYNC     "68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"

static void T47_Data_Exchange_before_parameters_and_configuration_is_refused(void)
{
    ASK(DX, RS_);
    ASK(SET_PRM, ACK);
    ASK(DX, RS_);
    OUTPUTS(0, 0);
}

static void T47_outputs_are_live_without_any_Global_Control(void)
{
    TO_DATA_EXCH(SET_PRM);
    OUTPUTS(0, 0);
    ASK(DX, DX_OK);
    OUTPUTS(0x11, 0x22);
    dp_in[0] = 0x1F;
    dp_in[1] = 0x01;
    hv_run_for(HV_MS);
    ASK(DX_33_44, "68 05 05 68 02 08 08 1F 01 32 16");
    OUTPUTS(0x33, 0x44);
}

static void T48_one_output_octet_less_or_more_is_refused_and_leaves_data_exchange(void)
{
    static const char *const wrong[] = {"68 04 04 68 08 02 6D 11 88 16",
                                        "68 06 06 68 08 02 6D 11 22 33 DD 16"};
    for (unsigned i = 0; i < 2; i++) {
        TO_DATA_EXCH(SET_PRM);
        ASK(DX, DX_OK);
        ASK(wrong[i], RS_);
        STATE(DDLM_WAIT_PRM);
        OUTPUTS(0, 0);
        DIAG(0x0605); /* Cfg_Fault, parameters awaited */
    }
}

static void T49_no_output_octets_at_all_is_the_fail_safe_state(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    ASK("10 08 02 6D 77 16", DX_OK); /* a master in Clear, to a Fail_Safe device */
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(0, 0);
    ASK(DX, DX_OK);
    OUTPUTS(0x11, 0x22);
}

static void T50_Data_Exchange_of_another_master_is_refused_and_changes_nothing(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    ASK("68 05 05 68 08 03 6D 33 44 EF 16", "10 03 08 03 0E 16");
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(0x11, 0x22);
    ASK(DX_33_44, DX_OK);
}

/* T51, an answer without inputs, and SD2 or SD3 for eight octets: test_dp_replay.c, on a device that adapts. */

static void T52_a_new_diagnosis_is_announced_with_DH_until_the_owner_has_read_it(void)
{
    static const uint8_t block[] = {0x02, 0x01};
    TO_DATA_EXCH(SET_PRM);
    DIAG(0x0004);
    ASK(DX, DX_OK);
    TEST_ASSERT_TRUE(ddlm_diag(block, sizeof block, DDLM_EXT_DIAG));
    ASK(DX, "68 05 05 68 02 08 0A 1E 00 32 16");
    ASK(DX_33_44, "68 05 05 68 02 08 0A 1E 00 32 16");
    OUTPUTS(0x33, 0x44);
    ASK(GET_DIAG, "68 0D 0D 68 82 88 08 3E 3C 08 04 00 02 12 34 02 01 E3 16");
    ASK(DX, DX_OK);
}

/* ---- Global_Control ------------------------------------------------------------------------------------------ */

static void T59_Sync_holds_the_outputs_until_the_next_Sync(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    ASK(DX, DX_OK);
    SILENT(SYNC);
    OUTPUTS(0x11, 0x22);
    ASK(DX_33_44, DX_OK);
    OUTPUTS(0x11, 0x22);
    SILENT(SYNC);
    OUTPUTS(0x33, 0x44);
    ASK(DX_55_66, DX_OK);
    OUTPUTS(0x33, 0x44);
}

static void T59_Unsync_gives_the_last_outputs_and_lets_the_next_ones_through(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT(SYNC);
    ASK(DX_33_44, DX_OK);
    OUTPUTS(0, 0);
    SILENT(UNSYNC);
    OUTPUTS(0x33, 0x44);
    ASK(DX_55_66, DX_OK);
    OUTPUTS(0x55, 0x66);
}

static void T60_Freeze_holds_the_inputs_of_its_moment(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT(FREEZE);
    dp_in[0] = 0x21;
    hv_run_for(HV_MS);
    ASK(DX, DX_OK);
    SILENT(FREEZE);
    dp_in[0] = 0x22;
    hv_run_for(HV_MS);
    ASK(DX, "68 05 05 68 02 08 08 21 00 33 16");
    SILENT(UNFREEZE);
    ASK(DX, "68 05 05 68 02 08 08 22 00 34 16");
    dp_in[0] = 0x23;
    hv_run_for(HV_MS);
    ASK(DX, "68 05 05 68 02 08 08 23 00 35 16");
}

static void T61_Un_wins_when_both_bits_are_set(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT("68 07 07 68 FF 82 46 3A 3E 3C 00 7B 16"); /* Sync, Unsync, Freeze, Unfreeze */
    TEST_ASSERT_FALSE(dp_info()->sync);
    TEST_ASSERT_FALSE(dp_info()->freeze);
    SILENT("68 07 07 68 FF 82 46 3A 3E 28 00 67 16");
    TEST_ASSERT_TRUE(dp_info()->sync && dp_info()->freeze);
    SILENT("68 07 07 68 FF 82 46 3A 3E 3C 00 7B 16");
    TEST_ASSERT_FALSE(dp_info()->sync || dp_info()->freeze);
}

static void T62_Clear_sets_the_outputs_to_the_fail_safe_state(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    SILENT(CLEAR);
    OUTPUTS(0, 0);
    STATE(DDLM_DATA_EXCH);
    ASK(DX_33_44, DX_OK);
    OUTPUTS(0x33, 0x44);
}

static void T62_Clear_reaches_outputs_under_Sync_too(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    ASK(DX, DX_OK);
    SILENT(SYNC);
    ASK(DX_33_44, DX_OK);
    SILENT(CLEAR);
    OUTPUTS(0, 0);
    SILENT(UNSYNC);
    OUTPUTS(0, 0);
}

static void T63_Operate_changes_nothing(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    ASK(DX, DX_OK);
    SILENT(OPERATE);
    OUTPUTS(0x11, 0x22);
    DIAG(0x0004);
}

static void T64_only_a_matching_group_obeys(void)
{
    TO_DATA_EXCH(SET_PRM_SF); /* group 1 */
    SILENT("68 07 07 68 FF 82 46 3A 3E 20 02 61 16");
    TEST_ASSERT_FALSE(dp_info()->sync);
    SILENT("68 07 07 68 FF 82 46 3A 3E 20 FE 5D 16");
    TEST_ASSERT_FALSE(dp_info()->sync);
    SILENT("68 07 07 68 FF 82 46 3A 3E 20 03 62 16");
    TEST_ASSERT_TRUE(dp_info()->sync);
}

static void T64_a_station_may_be_addressed_alone(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT("68 07 07 68 88 82 44 3A 3E 20 00 E6 16");
    TEST_ASSERT_TRUE(dp_info()->sync);
    SILENT("68 07 07 68 89 82 44 3A 3E 10 00 D7 16"); /* the neighbour */
    TEST_ASSERT_TRUE(dp_info()->sync);
}

static void T65_another_master_has_nothing_to_say(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    ASK(DX, DX_OK);
    SILENT("68 07 07 68 FF 83 46 3A 3E 22 00 62 16");
    OUTPUTS(0x11, 0x22);
    TEST_ASSERT_FALSE(dp_info()->sync);
}

static void T65_outside_DATA_EXCH_it_is_ignored(void)
{
    SILENT(SYNC);
    ASK(SET_PRM_SF, ACK);
    SILENT(SYNC);
    TO_DATA_EXCH(SET_PRM_SF);
    TEST_ASSERT_FALSE(dp_info()->sync);
}

static void T66_a_Global_Control_of_another_length_is_ignored(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT("68 06 06 68 FF 82 46 3A 3E 20 5F 16");
    SILENT("68 08 08 68 FF 82 46 3A 3E 20 00 00 5F 16");
    SILENT("68 05 05 68 FF 82 46 3A 3E 3F 16");
    TEST_ASSERT_FALSE(dp_info()->sync);
    STATE(DDLM_DATA_EXCH);
}

static void T66_Sync_and_Freeze_end_when_data_exchange_ends(void)
{
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT("68 07 07 68 FF 82 46 3A 3E 28 00 67 16");
    DIAG(0x0034);
    TO_DATA_EXCH(SET_PRM_SF);
    DIAG(0x0004);
    ASK(DX, DX_OK);
    OUTPUTS(0x11, 0x22);
}

/* ---- Rd_Inp, Rd_Outp ----------------------------------------------------------------------------------------- */

#define RD_INP  "68 05 05 68 88 83 6D 38 3E EE 16" /* by master 3: class 2 */
#define RD_OUTP "68 05 05 68 88 83 6D 39 3E EF 16"

static void T67_Rd_Inp_shows_the_inputs_to_any_master(void)
{
    ASK(RD_INP, "10 03 08 03 0E 16");
    ASK(SET_PRM, ACK);
    ASK(RD_INP, "10 03 08 03 0E 16");
    TO_DATA_EXCH(SET_PRM);
    ASK(RD_INP, "68 07 07 68 83 88 08 3E 38 1E 00 A7 16");
    ASK("68 05 05 68 88 82 6D 38 3E ED 16", "68 07 07 68 82 88 08 3E 38 1E 00 A6 16");
}

static void T68_Rd_Outp_shows_the_outputs_to_any_master(void)
{
    ASK(RD_OUTP, "10 03 08 03 0E 16");
    TO_DATA_EXCH(SET_PRM);
    ASK(RD_OUTP, "68 07 07 68 83 88 08 3E 39 00 00 8A 16");
    ASK(DX, DX_OK);
    ASK(RD_OUTP, "68 07 07 68 83 88 08 3E 39 11 22 BD 16");
    SILENT(CLEAR);
    ASK(RD_OUTP, "68 07 07 68 83 88 08 3E 39 00 00 8A 16");
}

static void T69_Rd_Inp_and_Rd_Outp_with_data_are_answered_RR(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK("68 06 06 68 88 82 6D 38 3E 00 ED 16", RR_);
    ASK("68 06 06 68 88 82 6D 39 3E 00 EE 16", RR_);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T47_Data_Exchange_before_parameters_and_configuration_is_refused);
    RUN_TEST(T47_outputs_are_live_without_any_Global_Control);
    RUN_TEST(T48_one_output_octet_less_or_more_is_refused_and_leaves_data_exchange);
    RUN_TEST(T49_no_output_octets_at_all_is_the_fail_safe_state);
    RUN_TEST(T50_Data_Exchange_of_another_master_is_refused_and_changes_nothing);
    RUN_TEST(T52_a_new_diagnosis_is_announced_with_DH_until_the_owner_has_read_it);
    RUN_TEST(T59_Sync_holds_the_outputs_until_the_next_Sync);
    RUN_TEST(T59_Unsync_gives_the_last_outputs_and_lets_the_next_ones_through);
    RUN_TEST(T60_Freeze_holds_the_inputs_of_its_moment);
    RUN_TEST(T61_Un_wins_when_both_bits_are_set);
    RUN_TEST(T62_Clear_sets_the_outputs_to_the_fail_safe_state);
    RUN_TEST(T62_Clear_reaches_outputs_under_Sync_too);
    RUN_TEST(T63_Operate_changes_nothing);
    RUN_TEST(T64_only_a_matching_group_obeys);
    RUN_TEST(T64_a_station_may_be_addressed_alone);
    RUN_TEST(T65_another_master_has_nothing_to_say);
    RUN_TEST(T65_outside_DATA_EXCH_it_is_ignored);
    RUN_TEST(T66_a_Global_Control_of_another_length_is_ignored);
    RUN_TEST(T66_Sync_and_Freeze_end_when_data_exchange_ends);
    RUN_TEST(T67_Rd_Inp_shows_the_inputs_to_any_master);
    RUN_TEST(T68_Rd_Outp_shows_the_outputs_to_any_master);
    RUN_TEST(T69_Rd_Inp_and_Rd_Outp_with_data_are_answered_RR);
    return UNITY_END();
}
