/* T53 - T58, T71 - T74: Slave_Diag and Set_Slave_Add. EN 50170-2 part 8; spec A6; facts 3.9, 3.12. */
#include "dp_fixture.h"

#include <string.h>

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

#define DX_DH "68 05 05 68 02 08 0A 1E 00 32 16"

/* ---- Slave_Diag ---------------------------------------------------------------------------------------------- */

static void T53_the_six_octets_tell_each_state(void)
{
    /* Station_Not_Ready; Prm_Req and the bit that is always 1; no owner; ident 1234 */
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
    ASK(SET_PRM, ACK);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 04 00 02 12 34 DA 16");
    ASK(CHK_CFG, ACK);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16");
    ASK(SET_PRM_WD, ACK); /* WD_On */
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 0C 00 02 12 34 E2 16");
}

static void T53_with_data_it_is_answered_RR(void)
{
    ASK("68 06 06 68 88 82 6D 3C 3E 00 F1 16", "10 02 08 02 0C 16");
}

static void T54_extended_diagnosis_blocks_follow_the_six_octets(void)
{
    /* identifier related, device related, channel related: facts 3.9 */
    static const uint8_t blocks[] = {0x44, 0x00, 0x01, 0x00, 0x88, 0x41, 0x21, 0x04, 0x10, 0x20, 0x30};
    TO_DATA_EXCH(SET_PRM);
    TEST_ASSERT_TRUE(ddlm_diag(blocks, sizeof blocks, DDLM_EXT_DIAG));
    ASK(DX, DX_DH);
    ASK(GET_DIAG, "68 16 16 68 82 88 08 3E 3C 08 04 00 02 12 34 44 00 01 00 88 41 21 04 10 20 30 73 16");
    TEST_ASSERT_TRUE(ddlm_diag(blocks, 0, 0)); /* the cause is gone: told once more */
    ASK(DX, DX_DH);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16");
    ASK(DX, DX_OK);
}

static void T54_blocks_that_are_none_are_refused(void)
{
    static const uint8_t too_long[] = {0x03, 0x01}, too_short[] = {0x01}, reserved[] = {0xC2, 0x00};
    TEST_ASSERT_FALSE(ddlm_diag(too_long, sizeof too_long, DDLM_EXT_DIAG));
    TEST_ASSERT_FALSE(ddlm_diag(too_short, sizeof too_short, DDLM_EXT_DIAG));
    TEST_ASSERT_FALSE(ddlm_diag(reserved, sizeof reserved, DDLM_EXT_DIAG));
    DIAG(0x0205);
}

static void T54_the_applications_own_diagnosis_comes_and_goes(void)
{
    /* user parameter octet 1 bit 0: diagnose more than octet 2 = 40 degrees */
    TO_DATA_EXCH("68 0E 0E 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 01 28 E4 16");
    ASK(DX, DX_OK);
    dp_in[0] = 41;
    hv_run_for(HV_MS);
    ASK(DX, "68 05 05 68 02 08 0A 29 00 3D 16");
    ASK(GET_DIAG, "68 0D 0D 68 82 88 08 3E 3C 08 04 00 02 12 34 02 01 E3 16");
    ASK(DX, "68 05 05 68 02 08 08 29 00 3B 16");
    dp_in[0] = 40;
    hv_run_for(HV_MS);
    ASK(DX, "68 05 05 68 02 08 0A 28 00 3C 16");
    DIAG(0x0004);
    ASK(DX, "68 05 05 68 02 08 08 28 00 3A 16");
}

static void T55_what_does_not_fit_is_left_out_and_marked_as_overflow(void)
{
    uint8_t blocks[DEV_EXT_DIAG_MAX + 3];
    memset(blocks, 0, sizeof blocks);
    blocks[0] = DEV_EXT_DIAG_MAX; /* one device related block that just fits, then a channel that does not */
    blocks[DEV_EXT_DIAG_MAX] = 0x80;
    TEST_ASSERT_TRUE(ddlm_diag(blocks, DEV_EXT_DIAG_MAX, DDLM_EXT_DIAG));
    DIAG(0x0A05);
    TEST_ASSERT_EQUAL_UINT(9 + 6 + DEV_EXT_DIAG_MAX + 2, seg_said.n);
    TEST_ASSERT_EQUAL_HEX8(0x00, seg_said.octets[11]);
    TEST_ASSERT_TRUE(ddlm_diag(blocks, sizeof blocks, DDLM_EXT_DIAG));
    DIAG(0x0A05);
    TEST_ASSERT_EQUAL_UINT(9 + 6 + DEV_EXT_DIAG_MAX + 2, seg_said.n);
    TEST_ASSERT_EQUAL_HEX8(0x80, seg_said.octets[11]); /* Ext_Diag_Overflow */
}

static void T56_static_diagnosis_stays_announced_until_it_is_cleared(void)
{
    TO_DATA_EXCH(SET_PRM);
    TEST_ASSERT_TRUE(ddlm_diag(0, 0, DDLM_STAT_DIAG));
    ASK(DX, DX_DH);
    DIAG(0x0006);
    ASK(DX, DX_DH);
    DIAG(0x0006);
    TEST_ASSERT_TRUE(ddlm_diag(0, 0, 0));
    ASK(DX, DX_DH);
    DIAG(0x0004);
    ASK(DX, DX_OK);
}

static void T57_a_status_carries_data_without_the_Ext_Diag_bit(void)
{
    static const uint8_t status[] = {0x02, 0x00};
    TO_DATA_EXCH(SET_PRM);
    TEST_ASSERT_TRUE(ddlm_diag(status, sizeof status, 0));
    ASK(DX, DX_DH);
    ASK(GET_DIAG, "68 0D 0D 68 82 88 08 3E 3C 00 04 00 02 12 34 02 00 DA 16");
    ASK(DX, DX_OK);
}

static void T58_another_master_may_look_without_taking_the_news_away(void)
{
    TO_DATA_EXCH(SET_PRM);
    TEST_ASSERT_TRUE(ddlm_diag(0, 0, 0));
    ASK(DX, DX_DH);
    ASK("68 05 05 68 88 83 6D 3C 3E F2 16", "68 0B 0B 68 83 88 08 3E 3C 00 04 00 02 12 34 D9 16");
    ASK(DX, DX_DH);
    DIAG(0x0004);
    ASK(DX, DX_OK);
}

/* ---- Set_Slave_Add: New_Slave_Add, Ident high, low, No_Add_Chg ------------------------------------------------- */

#define STATUS_AT_126 "10 7E 02 49 C9 16"
#define STATUS_AT_9   "10 09 02 49 54 16"
#define OK_FROM_126   "10 02 7E 00 80 16"
#define OK_FROM_9     "10 02 09 00 0B 16"

static void unaddressed(void)
{
    dp_begin(126, PHY_BAUD_19K2);
    STATE(DDLM_POWER_ON);
    ASK(STATUS_AT_126, OK_FROM_126);
}

static void T71_a_station_without_address_takes_the_one_it_is_given(void)
{
    unaddressed();
    ASK("68 09 09 68 FE 82 6D 37 3E 09 12 34 00 B1 16", ACK);
    seg_set_address(9);
    ASK(STATUS_AT_9, OK_FROM_9);
    SILENT(STATUS_AT_126);
    STATE(DDLM_WAIT_PRM);
    ASK("68 05 05 68 89 82 6D 3C 3E F2 16", "68 0B 0B 68 82 89 08 3E 3C 02 05 00 FF 12 34 D9 16");
}

static void T71_the_address_is_kept_through_a_power_failure_and_may_change_again(void)
{
    unaddressed();
    ASK("68 09 09 68 FE 82 6D 37 3E 09 12 34 00 B1 16", ACK);
    dp_power_cycle();
    seg_set_address(9);
    ASK(STATUS_AT_9, OK_FROM_9);
    ASK("68 09 09 68 89 82 6D 37 3E 7D 12 34 00 B0 16", ACK); /* to 125 */
    seg_set_address(125);
    ASK("10 7D 02 49 C8 16", "10 02 7D 00 7F 16");
}

static void T72_it_is_refused_where_the_address_comes_from_switches(void)
{
    ASK("68 09 09 68 88 82 6D 37 3E 09 12 34 00 3B 16", "10 02 08 03 0D 16");
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
}

static void T72_with_an_owner_it_is_not_processed(void)
{
    unaddressed();
    ASK("68 09 09 68 FE 82 6D 37 3E 08 12 34 00 B0 16", ACK);
    seg_set_address(8);
    TO_DATA_EXCH(SET_PRM);
    ASK("68 09 09 68 88 82 6D 37 3E 09 12 34 00 3B 16", ACK);
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
    STATE(DDLM_DATA_EXCH);
}

static void T73_a_wrong_ident_an_impossible_address_or_too_few_octets_change_nothing(void)
{
    unaddressed();
    ASK("68 09 09 68 FE 82 6D 37 3E 09 12 35 00 B2 16", ACK);
    ASK("68 09 09 68 FE 82 6D 37 3E 7E 12 34 00 26 16", ACK);
    ASK("68 09 09 68 FE 82 6D 37 3E 7F 12 34 00 27 16", ACK);
    ASK("A2 FE 82 6D 37 3E 09 12 34 00 00 00 B1 16", ACK); /* Rem_Slave_Data is allowed: this one is taken */
    seg_set_address(9);
    ASK(STATUS_AT_9, OK_FROM_9);
    unaddressed();
    ASK("68 08 08 68 FE 82 6D 37 3E 09 12 34 B1 16", ACK);
    ASK(STATUS_AT_126, OK_FROM_126);
    TEST_ASSERT_EQUAL_UINT(0, hv_seen.nv_writes);
}

static void T74_No_Add_Chg_locks_the_address_until_the_factory_reset(void)
{
    unaddressed();
    ASK("68 09 09 68 FE 82 6D 37 3E 09 12 34 01 B2 16", ACK);
    seg_set_address(9);
    ASK("68 09 09 68 89 82 6D 37 3E 0A 12 34 00 3D 16", ACK);
    ASK(STATUS_AT_9, OK_FROM_9);
    dp_power_cycle();
    ASK("68 09 09 68 89 82 6D 37 3E 0A 12 34 00 3D 16", ACK);
    ASK(STATUS_AT_9, OK_FROM_9);
    TEST_ASSERT_TRUE(ddlm_factory_reset());
    dp_power_cycle();
    seg_set_address(126);
    ASK(STATUS_AT_126, OK_FROM_126);
}

static void T74_a_memory_that_does_not_store_leaves_the_old_address(void)
{
    unaddressed();
    hv_nv_broken = true;
    ASK("68 09 09 68 FE 82 6D 37 3E 09 12 34 00 B1 16", ACK);
    ASK(STATUS_AT_126, OK_FROM_126);
    TEST_ASSERT_EQUAL_UINT(1, dp_reports);
}

static void T74_a_half_written_address_is_none(void)
{
    unaddressed();
    hv_nv[0] = 9; /* the complement is still erased */
    dp_power_cycle();
    ASK(STATUS_AT_126, OK_FROM_126);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T53_the_six_octets_tell_each_state);
    RUN_TEST(T53_with_data_it_is_answered_RR);
    RUN_TEST(T54_extended_diagnosis_blocks_follow_the_six_octets);
    RUN_TEST(T54_blocks_that_are_none_are_refused);
    RUN_TEST(T54_the_applications_own_diagnosis_comes_and_goes);
    RUN_TEST(T55_what_does_not_fit_is_left_out_and_marked_as_overflow);
    RUN_TEST(T56_static_diagnosis_stays_announced_until_it_is_cleared);
    RUN_TEST(T57_a_status_carries_data_without_the_Ext_Diag_bit);
    RUN_TEST(T58_another_master_may_look_without_taking_the_news_away);
    RUN_TEST(T71_a_station_without_address_takes_the_one_it_is_given);
    RUN_TEST(T71_the_address_is_kept_through_a_power_failure_and_may_change_again);
    RUN_TEST(T72_it_is_refused_where_the_address_comes_from_switches);
    RUN_TEST(T72_with_an_owner_it_is_not_processed);
    RUN_TEST(T73_a_wrong_ident_an_impossible_address_or_too_few_octets_change_nothing);
    RUN_TEST(T74_No_Add_Chg_locks_the_address_until_the_factory_reset);
    RUN_TEST(T74_a_memory_that_does_not_store_leaves_the_old_address);
    RUN_TEST(T74_a_half_written_address_is_none);
    return UNITY_END();
}
