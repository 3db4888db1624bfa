/* T01 - T18: who is meant, what is a telegram, and what is not answered. Formats: EN 50170-2 part 4, 4.7;
 * spec A3. */
#include "dp_fixture.h"

#include <string.h>

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

#define STATUS        "10 08 02 49 53 16"
#define STATUS_OK     "10 02 08 00 0A 16"
#define STILL_ANSWERS ASK(STATUS, STATUS_OK)

/* SD1: FDL status. SD2: Slave_Diag. SD3: Chk_Cfg with six identifiers (SAPs and six octets make eight). */
static const uint8_t sd1[] = {0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
static const uint8_t sd2[] = {0x68, 0x05, 0x05, 0x68, 0x88, 0x82, 0x6D, 0x3C, 0x3E, 0xF1, 0x16};
static const uint8_t sd3[] = {0xA2, 0x88, 0x82, 0x6D, 0x3E, 0x3E, 0, 0, 0, 0, 0, 0, 0xF3, 0x16};

/* Change octet `at` by d and the FCS with it. */
static void shifted(const uint8_t *from, unsigned n, unsigned at, uint8_t d, uint8_t *to)
{
    memcpy(to, from, n);
    to[at] = (uint8_t)(to[at] + d);
    to[n - 2] = (uint8_t)(to[n - 2] + d);
}

static unsigned ask_shifted(const uint8_t *from, unsigned n, unsigned at, uint8_t d)
{
    uint8_t octets[16];
    shifted(from, n, at, d, octets);
    return dp_ask_octets(octets, n, __LINE__);
}

static void T01_telegrams_to_the_own_address_are_answered_in_SD1_SD2_and_SD3(void)
{
    ASK(STATUS, STATUS_OK);
    ASK(GET_DIAG, "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
    ASK("A2 88 82 6D 3E 3E 00 00 00 00 00 00 F3 16", ACK);
}

static void T02_telegrams_to_all_other_stations_are_not_answered(void)
{
    for (uint8_t d = 1; d < 126; d++) { /* 8 + d mod 126, which never is 8 */
        const uint8_t shift = (uint8_t)((8 + d) % 126 - 8);
        TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd1, sizeof sd1, 1, shift));
        TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd2, sizeof sd2, 4, shift));
        TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd3, sizeof sd3, 1, shift));
    }
    STILL_ANSWERS;
}

static void T03_an_addressed_station_does_not_answer_at_126(void)
{
    TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd1, sizeof sd1, 1, 126 - 8));
    TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd2, sizeof sd2, 4, 126 - 8));
    TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd3, sizeof sd3, 1, 126 - 8));
    STILL_ANSWERS;
}

static void T04_a_broadcast_is_never_answered_but_SDN_is_taken(void)
{
    TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd1, sizeof sd1, 1, 127 - 8));
    TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd2, sizeof sd2, 4, 127 - 8));
    TEST_ASSERT_EQUAL_UINT(0, ask_shifted(sd3, sizeof sd3, 1, 127 - 8));
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    OUTPUTS(0x11, 0x22);
    SILENT("68 07 07 68 FF 82 46 3A 3E 02 00 41 16"); /* Global_Control: Clear_Data */
    OUTPUTS(0, 0);
}

static void T05_a_station_without_address_answers_at_126(void)
{
    dp_begin(126, PHY_BAUD_19K2);
    ASK("10 7E 02 49 C9 16", "10 02 7E 00 80 16");
    SILENT(STATUS);
}

static void T06_every_master_address_is_answered_to_itself(void)
{
    for (uint8_t d = 0; d <= 124; d++) {
        const uint8_t sa = (uint8_t)(2 + d);
        TEST_ASSERT_EQUAL_UINT(6, ask_shifted(sd1, sizeof sd1, 2, d));
        TEST_ASSERT_EQUAL_HEX8(sa, seg_said.octets[1]);
        TEST_ASSERT_EQUAL_HEX8((uint8_t)(sa + 8), seg_said.octets[4]);
    }
}

static void T07_a_wrong_FCS_is_dropped(void)
{
    SILENT("10 08 02 49 54 16");
    SILENT("68 05 05 68 88 82 6D 3C 3E F0 16");
    SILENT("A2 88 82 6D 3E 3E 00 00 00 00 00 00 F4 16");
    STILL_ANSWERS;
}

static void T08_a_wrong_end_delimiter_is_dropped(void)
{
    SILENT("10 08 02 49 53 17");
    SILENT("68 05 05 68 88 82 6D 3C 3E F1 15");
    SILENT("A2 88 82 6D 3E 3E 00 00 00 00 00 00 F3 00");
    STILL_ANSWERS;
}

static void T09_different_LE_and_LEr_are_dropped(void)
{
    SILENT("68 05 06 68 88 82 6D 3C 3E F1 16");
    SILENT("68 06 05 68 88 82 6D 3C 3E F1 16");
    STILL_ANSWERS;
}

static void T10_LE_0_2_and_3_are_dropped(void)
{
    SILENT("68 00 00 68 00 16");
    SILENT("68 02 02 68 08 02 0A 16");
    SILENT("68 03 03 68 08 02 49 53 16"); /* right but for its format: an SD1 would be answered */
    STILL_ANSWERS;
}

static void T11_LE_250_and_255_are_dropped(void)
{
    uint8_t octets[300] = {0x68, 250, 250, 0x68, 0x08, 0x02, 0x6D};
    octets[254] = 0x77; /* 08 + 02 + 6D, the rest zero: FCS and ED in their places */
    octets[255] = 0x16;
    TEST_ASSERT_EQUAL_UINT(0, dp_ask_octets(octets, 256, __LINE__));
    octets[1] = octets[2] = 255;
    octets[254] = 0;
    octets[259] = 0x77;
    octets[260] = 0x16;
    TEST_ASSERT_EQUAL_UINT(0, dp_ask_octets(octets, 261, __LINE__));
    STILL_ANSWERS;
}

static void T11_LE_249_is_received_whole_and_checked(void)
{
    uint8_t octets[256] = {0x68, 249, 249, 0x68, 0x08, 0x02, 0x6D};
    octets[253] = 0x77;
    octets[254] = 0x16;
    /* Data_Exchange outside DATA_EXCH: RS */
    TEST_ASSERT_EQUAL_UINT(6, dp_ask_octets(octets, 255, __LINE__));
    TEST_ASSERT_EQUAL_HEX8(0x03, seg_said.octets[3]);
    octets[253] = 0x78;
    TEST_ASSERT_EQUAL_UINT(0, dp_ask_octets(octets, 255, __LINE__));
    STILL_ANSWERS;
}

static void T12_a_wrong_second_start_delimiter_is_dropped(void)
{
    SILENT("68 05 05 10 88 82 6D 3C 3E F1 16");
    SILENT("68 05 05 69 88 82 6D 3C 3E F1 16");
    STILL_ANSWERS;
}

static void T13_a_telegram_too_short_or_too_long_is_dropped(void)
{
    SILENT("10 08 02 49 53");
    STILL_ANSWERS;
    SILENT("68 05 05 68 88 82 6D 3C 3E F1");
    STILL_ANSWERS;
    SILENT("68 05 05 68 88 82 6D 3C F1 16");
    SILENT("A2 88 82 6D 3E 3E 00 00 00 00 00 F3 16");
    STILL_ANSWERS;
    SILENT("10 08 02 49 53 16 16"); /* octets behind the end: the line was not silent for T_SDR */
    STILL_ANSWERS;
    SILENT("68 05 05 68 88 82 6D 3C 3E F1 16 E5");
    STILL_ANSWERS;
}

static void T14_an_octet_with_wrong_parity_or_stop_bit_drops_the_telegram(void)
{
    SILENT("10! 08 02 49 53 16");
    SILENT("10 08 02! 49 53 16");
    SILENT("10 08 02 49 53 16!");
    SILENT("10 08 02 49~ 53 16");
    SILENT("68 05 05 68 88 82 6D 3C! 3E F1 16");
    SILENT("A2 88 82 6D 3E 3E 00 00~ 00 00 00 00 F3 16");
    STILL_ANSWERS;
}

static void T14_silence_inside_a_telegram_drops_it(void)
{
    SILENT("10 _33 08 02 49 53 16");
    SILENT("10 08 02 49 53 _33 16");
    SILENT("68 05 05 68 88 82 6D _40 3C 3E F1 16");
    STILL_ANSWERS;
}

static void T14_a_good_telegram_right_behind_a_dropped_one_needs_T_SYN(void)
{
    SILENT("10 08 02 49 54 16 10 08 02 49 53 16");
    SILENT("10 08 02 49 54 16 _21 10 08 02 49 53 16");
    ASK("10 08 02 49 54 16 _33 10 08 02 49 53 16", STATUS_OK);
}

static bool hold_interrupts;

/* The application masks interrupts for three characters, once. */
static void rude_loop(void)
{
    if (hold_interrupts) {
        hold_interrupts = false;
        const uint8_t state = hal_irq_save();
        hv_spend(33 * hv_bit());
        hal_irq_restore(state);
    }
    dp_station_poll();
}

static void T14_an_octet_lost_in_the_receiver_drops_the_telegram_and_is_counted(void)
{
    struct fdl_counters c;
    hv_set_loop(rude_loop, NULL);
    hold_interrupts = true;
    hv_run_for(HV_MS);
    hold_interrupts = true; /* at the next turn, when the telegram is on its way */
    SILENT("10 08 02 49 53 16");
    TEST_ASSERT_GREATER_THAN_UINT(0, hv_seen.octets_lost);
    fdl_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT16(1, c.overrun);
    STILL_ANSWERS;
}

static void T15_FDL_status_is_answered_in_every_state(void)
{
    STATE(DDLM_WAIT_PRM);
    ASK(STATUS, STATUS_OK);
    ASK(SET_PRM, ACK);
    STATE(DDLM_WAIT_CFG);
    ASK(STATUS, STATUS_OK);
    TO_DATA_EXCH(SET_PRM);
    ASK(STATUS, STATUS_OK);
    dp_begin(126, PHY_BAUD_19K2);
    STATE(DDLM_POWER_ON);
    ASK("10 7E 02 49 C9 16", "10 02 7E 00 80 16");
}

static void T16_ident_tells_vendor_controller_and_releases(void)
{
    /* four lengths, then "Fieldling" "DP-TEST01" "V1.0" "V0.1" */
    ASK("10 08 02 4E 58 16", "68 21 21 68 02 08 08 09 09 04 04 46 69 65 6C 64 6C 69 6E 67 "
                             "44 50 2D 54 45 53 54 30 31 56 31 2E 30 56 30 2E 31 E6 16");
}

static void T16_LSAP_status_tells_what_a_SAP_offers(void)
{
    /* Slave_Diag: all stations; SDA, SDN not activated; SRD, CSRD responder */
    ASK("68 05 05 68 88 82 4F 3C 3E D3 16", "68 0B 0B 68 82 88 08 3E 3C 7F 00 30 31 13 15 94 16");
    /* Set_Prm in WAIT_PRM is active, SAP 11 is not: RS */
    ASK("68 05 05 68 88 82 4F 0B 3E A2 16", "10 02 08 03 0D 16");
}

static void T17_a_token_is_ignored(void)
{
    SILENT("DC 08 02");
    SILENT("DC 02 02");
    ASK("DC 02 02 _33 10 08 02 49 53 16", STATUS_OK);
}

static void T18_answers_of_other_stations_are_ignored(void)
{
    SILENT("E5");
    SILENT("10 02 07 00 09 16");
    SILENT("10 08 02 00 0A 16"); /* an answer to us: we have not asked */
    SILENT("68 05 05 68 08 02 08 11 22 45 16");
    SILENT("A2 08 02 08 00 00 00 00 00 00 00 00 12 16");
    ASK("E5 _33 10 08 02 49 53 16", STATUS_OK);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T01_telegrams_to_the_own_address_are_answered_in_SD1_SD2_and_SD3);
    RUN_TEST(T02_telegrams_to_all_other_stations_are_not_answered);
    RUN_TEST(T03_an_addressed_station_does_not_answer_at_126);
    RUN_TEST(T04_a_broadcast_is_never_answered_but_SDN_is_taken);
    RUN_TEST(T05_a_station_without_address_answers_at_126);
    RUN_TEST(T06_every_master_address_is_answered_to_itself);
    RUN_TEST(T07_a_wrong_FCS_is_dropped);
    RUN_TEST(T08_a_wrong_end_delimiter_is_dropped);
    RUN_TEST(T09_different_LE_and_LEr_are_dropped);
    RUN_TEST(T10_LE_0_2_and_3_are_dropped);
    RUN_TEST(T11_LE_250_and_255_are_dropped);
    RUN_TEST(T11_LE_249_is_received_whole_and_checked);
    RUN_TEST(T12_a_wrong_second_start_delimiter_is_dropped);
    RUN_TEST(T13_a_telegram_too_short_or_too_long_is_dropped);
    RUN_TEST(T14_an_octet_with_wrong_parity_or_stop_bit_drops_the_telegram);
    RUN_TEST(T14_silence_inside_a_telegram_drops_it);
    RUN_TEST(T14_a_good_telegram_right_behind_a_dropped_one_needs_T_SYN);
    RUN_TEST(T14_an_octet_lost_in_the_receiver_drops_the_telegram_and_is_counted);
    RUN_TEST(T15_FDL_status_is_answered_in_every_state);
    RUN_TEST(T16_ident_tells_vendor_controller_and_releases);
    RUN_TEST(T16_LSAP_status_tells_what_a_SAP_offers);
    RUN_TEST(T17_a_token_is_ignored);
    RUN_TEST(T18_answers_of_other_stations_are_ignored);
    return UNITY_END();
}
