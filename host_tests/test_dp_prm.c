/* T26 - T37: Set_Prm. Octets: EN 50170-2 part 8, Set_Prm; spec A6; facts 3.7.
 * Set_Prm is acknowledged whatever it says; what was wrong shows in Slave_Diag octets 1, 2:
 *   0205 waits for parameters   4205 Prm_Fault   5205 and Not_Supported   0204 waits for configuration */
#include "dp_fixture.h"

#include <string.h>

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

#define WAITS_PRM 0x0205
#define WAITS_CFG 0x0204
#define FAULT     0x4205

static void T26_a_good_Set_Prm_leads_to_WAIT_CFG_and_names_the_owner(void)
{
    DIAG(WAITS_PRM);
    ASK(SET_PRM, ACK);
    STATE(DDLM_WAIT_CFG);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 04 00 02 12 34 DA 16");
    TEST_ASSERT_EQUAL(2, dp_info()->master);
    TEST_ASSERT_EQUAL_HEX8(1, dp_info()->groups);
}

static void T27_a_wrong_ident_is_a_parameter_fault(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 35 01 BC 16", ACK);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 42 05 00 FF 12 34 18 16");
    STATE(DDLM_WAIT_PRM);
    ASK(SET_PRM, ACK);
    DIAG(WAITS_CFG);
}

static void T27_a_wrong_ident_throws_the_owner_out_of_DATA_EXCH(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 35 01 BC 16", ACK);
    STATE(DDLM_WAIT_PRM);
    OUTPUTS(0, 0);
    DIAG(FAULT);
}

static void T28_Set_Prm_of_0_to_6_octets_is_a_parameter_fault(void)
{
    ASK("68 05 05 68 88 82 6D 3D 3E F2 16", ACK);
    DIAG(FAULT);
    ASK("68 06 06 68 88 82 6D 3D 3E 80 72 16", ACK);
    DIAG(FAULT);
    ASK("68 07 07 68 88 82 6D 3D 3E 80 01 73 16", ACK);
    ASK("A2 88 82 6D 3D 3E 80 01 01 00 12 34 BA 16", ACK); /* six octets and two SAPs: an SD3 */
    DIAG(FAULT);
    STATE(DDLM_WAIT_PRM);
}

static void T29_as_many_user_parameters_as_the_device_has_are_taken(void)
{
    /* octet 1 bit 0, octet 2 limit 50, octet 3 zero */
    ASK("68 0D 0D 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 BC 16", ACK);
    DIAG(WAITS_CFG);
    ASK("68 0E 0E 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 EE 16", ACK);
    DIAG(WAITS_CFG);
    ASK("68 0F 0F 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 00 EE 16", ACK);
    DIAG(WAITS_CFG);
}

static void T29_one_user_parameter_more_is_a_parameter_fault(void)
{
    ASK("68 10 10 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 00 00 EE 16", ACK);
    DIAG(FAULT);
}

static void T29_the_longest_Set_Prm_is_a_parameter_fault_and_nothing_worse(void)
{
    uint8_t octets[255] = {0x68, 249, 249, 0x68, 0x88, 0x82, 0x6D, 0x3D, 0x3E, 0x80, 1, 1, 0, 0x12, 0x34, 1};
    octets[253] = 0xBB; /* the sum of SET_PRM: the rest is zero */
    octets[254] = 0x16;
    TEST_ASSERT_EQUAL_UINT(1, dp_ask_octets(octets, sizeof octets, __LINE__));
    DIAG(FAULT);
}

static void T30_without_lock_and_unlock_only_min_T_SDR_changes(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 08 01 01 1E 12 34 01 61 16", ACK);
    STATE(DDLM_WAIT_PRM);
    TEST_ASSERT_EQUAL(30, dp_info()->min_t_sdr);
    TEST_ASSERT_FALSE(dp_info()->wd_on);
    TEST_ASSERT_EQUAL(0, dp_info()->groups);
    TEST_ASSERT_EQUAL(DDLM_NO_MASTER, dp_info()->master);
    seg_set_min_t_sdr(30);
    DIAG(WAITS_PRM);
    TEST_ASSERT_EQUAL_UINT64(30 * 30000u, seg_said.t_sdr);
}

static void T30_min_T_SDR_alone_changes_even_with_a_wrong_ident(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 00 01 01 14 FF FF 00 06 16", ACK);
    TEST_ASSERT_EQUAL(20, dp_info()->min_t_sdr);
    DIAG(WAITS_PRM);
}

static void T31_unlock_gives_the_station_to_anyone_and_outputs_go_safe(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 40 01 01 00 12 34 01 7B 16", ACK);
    STATE(DDLM_WAIT_PRM);
    OUTPUTS(0, 0);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
}

static void T31_lock_and_unlock_together_unlock(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E C0 01 01 00 12 34 01 FB 16", ACK);
    STATE(DDLM_WAIT_PRM);
    DIAG(WAITS_PRM);
}

static void T32_a_locked_station_ignores_other_masters(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK("68 0C 0C 68 88 83 6D 3D 3E 80 01 01 00 12 34 01 BC 16", ACK); /* master 3 locks */
    ASK("68 0C 0C 68 88 83 6D 3D 3E 40 01 01 00 12 34 01 7C 16", ACK); /* master 3 unlocks */
    STATE(DDLM_DATA_EXCH);
    TEST_ASSERT_EQUAL(2, dp_info()->master);
    ASK(DX, DX_OK);
}

static void T33_Sync_and_Freeze_are_enabled_by_Set_Prm_only(void)
{
    TO_DATA_EXCH(SET_PRM);
    SILENT("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16"); /* Sync, not enabled */
    TEST_ASSERT_FALSE(dp_info()->sync);
    DIAG(0x1004); /* Not_Supported */
    TO_DATA_EXCH(SET_PRM_SF);
    SILENT("68 07 07 68 FF 82 46 3A 3E 28 00 67 16");
    TEST_ASSERT_TRUE(dp_info()->sync);
    TEST_ASSERT_TRUE(dp_info()->freeze);
    DIAG(0x0034); /* Sync_Mode, Freeze_Mode */
}

static void T34_the_watchdog_is_on_or_off_as_Set_Prm_says(void)
{
    ASK(SET_PRM_WD, ACK);
    TEST_ASSERT_TRUE(dp_info()->wd_on);
    TEST_ASSERT_EQUAL_UINT32(50, dp_info()->wd_ms);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 12 34 E2 16");
    ASK(SET_PRM, ACK);
    TEST_ASSERT_FALSE(dp_info()->wd_on);
    DIAG(WAITS_CFG);
}

static void T35_watchdog_factors_are_1_to_255(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 88 01 01 00 12 34 01 C3 16", ACK);
    TEST_ASSERT_EQUAL_UINT32(10, dp_info()->wd_ms);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 88 FF FF 00 12 34 01 BF 16", ACK);
    TEST_ASSERT_EQUAL_UINT32(650250, dp_info()->wd_ms);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 88 00 01 00 12 34 01 C2 16", ACK);
    DIAG(FAULT);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 88 01 00 00 12 34 01 C2 16", ACK);
    DIAG(FAULT);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 00 12 34 01 B9 16", ACK); /* off: the factors mean nothing */
    DIAG(WAITS_CFG);
}

static void T36_min_T_SDR_0_keeps_and_11_to_max_T_SDR_is_taken(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 3C 12 34 01 F7 16", ACK); /* 60: max_T_SDR at this rate */
    TEST_ASSERT_EQUAL(60, dp_info()->min_t_sdr);
    seg_set_min_t_sdr(60);
    ASK(SET_PRM, ACK);
    TEST_ASSERT_EQUAL(60, dp_info()->min_t_sdr);
    TEST_ASSERT_EQUAL_UINT64(60 * 30000u, seg_said.t_sdr);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 0B 12 34 01 C6 16", ACK);
    TEST_ASSERT_EQUAL(11, dp_info()->min_t_sdr);
}

static void T36_min_T_SDR_below_11_or_above_max_T_SDR_is_a_parameter_fault(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 0A 12 34 01 C5 16", ACK);
    DIAG(FAULT);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 FF 12 34 01 BA 16", ACK);
    DIAG(FAULT);
    TEST_ASSERT_EQUAL(11, dp_info()->min_t_sdr);
}

static void T37_the_group_is_taken_only_with_lock(void)
{
    ASK("68 0C 0C 68 88 82 6D 3D 3E 00 01 01 00 12 34 F0 2A 16", ACK);
    TEST_ASSERT_EQUAL_HEX8(0, dp_info()->groups);
    ASK("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 34 F0 AA 16", ACK);
    TEST_ASSERT_EQUAL_HEX8(0xF0, dp_info()->groups);
}

static void T37_user_parameters_the_application_refuses_are_a_parameter_fault(void)
{
    ASK("68 0D 0D 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 80 3B 16", ACK); /* a bit that must be 0 */
    DIAG(FAULT);
    ASK("68 0F 0F 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 32 01 EF 16", ACK); /* octet 3 must be 0 */
    DIAG(FAULT);
    STATE(DDLM_WAIT_PRM);
}

/* DP-V1 status octets are user parameters 1..3 to a DP-V0 slave: this device has its own meaning for them, so
 * DPV1_Enable (80H) falls under "a bit that must be 0". */
static void T37_DPV1_bits_are_refused_by_a_device_without_DPV1(void)
{
    ASK("68 0F 0F 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 C0 00 00 7B 16", ACK);
    DIAG(FAULT);
}

static void a_Set_Prm_in_DATA_EXCH_starts_the_configuration_anew(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    ASK("68 0C 0C 68 88 82 5D 3D 3E 80 01 01 00 12 34 02 AC 16", ACK);
    STATE(DDLM_WAIT_CFG);
    OUTPUTS(0, 0);
    TEST_ASSERT_EQUAL_HEX8(2, dp_info()->groups);
    ASK(DX, "10 02 08 03 0D 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T26_a_good_Set_Prm_leads_to_WAIT_CFG_and_names_the_owner);
    RUN_TEST(T27_a_wrong_ident_is_a_parameter_fault);
    RUN_TEST(T27_a_wrong_ident_throws_the_owner_out_of_DATA_EXCH);
    RUN_TEST(T28_Set_Prm_of_0_to_6_octets_is_a_parameter_fault);
    RUN_TEST(T29_as_many_user_parameters_as_the_device_has_are_taken);
    RUN_TEST(T29_one_user_parameter_more_is_a_parameter_fault);
    RUN_TEST(T29_the_longest_Set_Prm_is_a_parameter_fault_and_nothing_worse);
    RUN_TEST(T30_without_lock_and_unlock_only_min_T_SDR_changes);
    RUN_TEST(T30_min_T_SDR_alone_changes_even_with_a_wrong_ident);
    RUN_TEST(T31_unlock_gives_the_station_to_anyone_and_outputs_go_safe);
    RUN_TEST(T31_lock_and_unlock_together_unlock);
    RUN_TEST(T32_a_locked_station_ignores_other_masters);
    RUN_TEST(T33_Sync_and_Freeze_are_enabled_by_Set_Prm_only);
    RUN_TEST(T34_the_watchdog_is_on_or_off_as_Set_Prm_says);
    RUN_TEST(T35_watchdog_factors_are_1_to_255);
    RUN_TEST(T36_min_T_SDR_0_keeps_and_11_to_max_T_SDR_is_taken);
    RUN_TEST(T36_min_T_SDR_below_11_or_above_max_T_SDR_is_a_parameter_fault);
    RUN_TEST(T37_the_group_is_taken_only_with_lock);
    RUN_TEST(T37_user_parameters_the_application_refuses_are_a_parameter_fault);
    RUN_TEST(T37_DPV1_bits_are_refused_by_a_device_without_DPV1);
    RUN_TEST(a_Set_Prm_in_DATA_EXCH_starts_the_configuration_anew);
    return UNITY_END();
}
