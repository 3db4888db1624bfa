/* T89 - T91, spec A12: recorded conversations, octet for octet, and what the recorded devices have that DP-TEST01
 * has not (T46, T50, T51): configurations that are adapted to, no inputs, eight octets in SD2 or SD3, 244 octets.
 *
 * The device is host_tests/config/dp_any.h, ident 00AAH as in A12. In the other conversations the ident is put in place
 * of the recorded one; nothing else is changed. */
#include "dp_fixture.h"

#include <string.h>

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
    dp_adapts = true;
}

void tearDown(void)
{
}

static void at_address(uint8_t address)
{
    dp_begin(address, PHY_BAUD_19K2);
}

static void inputs(const char *text)
{
    memcpy(dp_in, text, strlen(text));
    hv_run_for(HV_MS);
}

/* ---- spec A12: master 0, slave 16 ------------------------------------------------------------------------ */

#define A12_DIAG "68 05 05 68 90 80 6D 3C 3E F7 16"
#define A12_DX                                                                                               \
    "68 23 23 68 10 00 5D 61 62 63 64 65 66 67 68 69 6A 6B 6C 6D 6E 6F 70 41 42 43 44 45 46 47 48 49 4A 4B " \
    "4C "                                                                                                    \
    "4D 4E 4F 50 7D 16"

static void A12_the_start_of_a_slave_as_traced(void)
{
    at_address(16);
    inputs("abcdefghijklmnopABCDEFGHIJKLMNOP");
    ASK(A12_DIAG, "68 0B 0B 68 80 90 08 3E 3C 02 05 00 FF 00 AA 42 16");
    ASK("68 0C 0C 68 90 80 5D 3D 3E 88 64 01 0B 00 AA 00 8A 16", ACK);
    TEST_ASSERT_EQUAL_UINT32(1000, dp_info()->wd_ms);
    TEST_ASSERT_EQUAL(11, dp_info()->min_t_sdr);
    ASK("68 07 07 68 90 80 7D 3E 3E F3 7B 77 16", ACK);
    ASK("68 05 05 68 90 80 5D 3C 3E E7 16", "68 0B 0B 68 80 90 08 3E 3C 00 0C 00 00 00 AA 48 16");
    SILENT("68 07 07 68 FF 80 46 3A 3E 00 00 3D 16");
    ASK(A12_DX,
        "68 23 23 68 00 10 08 61 62 63 64 65 66 67 68 69 6A 6B 6C 6D 6E 6F 70 41 42 43 44 45 46 47 48 49 4A "
        "4B 4C 4D 4E 4F 50 28 16");
    TEST_ASSERT_EQUAL_MEMORY("abcdefghijklmnopABCDEFGHIJKLMNOP", dp_out, 32);
}

static void A12_SD2_with_a_right_FCS_is_received(void)
{
    struct fdl_counters c;
    at_address(8);
    SILENT("68 0D 0D 68 08 09 06 61 62 63 64 65 66 67 68 69 6A 0E 16"); /* FC 06 is nobody's request */
    fdl_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT16(0, c.checksum);
    TEST_ASSERT_EQUAL_UINT16(0, c.format);
    SILENT("68 0D 0D 68 08 09 06 61 62 63 64 65 66 67 68 69 6A 0D 16");
    fdl_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT16(1, c.checksum);
}

static void A12_SD1_with_a_wrong_FCS_is_dropped_and_counted(void)
{
    struct fdl_counters c;
    at_address(0x56);
    SILENT("10 56 65 03 88 16");
    fdl_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT16(1, c.checksum);
    SILENT("10 56 65 03 BE 16"); /* right, but an answer */
    fdl_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT16(1, c.checksum);
}

/* The prototype's own Set_Prm, slave 3, master 9, SSAP 60; ident put in. min_T_SDR 8 is less than the standard's 11. */
static void A12_the_prototypes_Set_Prm(void)
{
    at_address(3);
    ASK("68 0C 0C 68 83 89 5D 3D 3C 88 64 01 0B 00 AA 00 84 16", ACK);
    STATE(DDLM_WAIT_CFG);
    TEST_ASSERT_EQUAL(9, dp_info()->master);
    ASK("68 05 05 68 83 89 6D 3C 3C F1 16", "68 0B 0B 68 89 83 08 3C 3C 02 0C 00 09 00 AA 4D 16");
    ASK("68 0C 0C 68 83 89 5D 3D 3C 88 64 01 08 00 AA 00 81 16", ACK);
    STATE(DDLM_WAIT_PRM);
}

/* ---- facts 3.10: master 1 brings up an ET200S ------------------------------------------------------------ */

static void T89_the_ET200S_conversation(void)
{
    SILENT("68 07 07 68 FF 81 46 3A 3E 00 00 3E 16");
    ASK("68 05 05 68 88 81 6D 3C 3E F0 16", "68 0B 0B 68 81 88 08 3E 3C 02 05 00 FF 00 AA 3B 16");
    ASK("68 05 05 68 88 81 5D 3B 3E DF 16", "68 07 07 68 81 88 08 3E 3B F3 7B F8 16"); /* its own modules */
    ASK("68 25 25 68 88 81 7D 3D 3E B8 0D 0F 0B 00 AA 00 C0 00 00 11 21 00 00 00 00 00 00 00 00 00 00 00 00 "
        "00 00 "
        "00 20 01 00 18 18 CD 16",
        ACK);
    TEST_ASSERT_EQUAL_UINT32(1950, dp_info()->wd_ms);
    TEST_ASSERT_TRUE(dp_info()->sync_enabled && dp_info()->freeze_enabled);
    ASK("68 08 08 68 88 81 5D 3E 3E 00 10 10 02 16", ACK);
    ASK("68 05 05 68 88 81 7D 3C 3E 00 16", "68 0B 0B 68 81 88 08 3E 3C 00 0C 00 01 00 AA 42 16");
    ASK("68 05 05 68 88 81 5D 3B 3E DF 16", "68 08 08 68 81 88 08 3E 3B 00 10 10 AA 16");
    inputs("\x12\x34");
    ASK("10 08 01 7D 86 16", "68 05 05 68 01 08 08 12 34 57 16"); /* no outputs: the request is an SD1 */
}

/* ---- facts 2.1: pyprofibus 1.13 -------------------------------------------------------------------------- */

static void T90_the_pyprofibus_conversation(void)
{
    inputs("\xBD\xDB");
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
    ASK("68 05 05 68 88 82 6D 3C 3E F1 16", "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 00 AA 3C 16");
    ASK("68 10 10 68 88 82 5D 3D 3E 88 1E 01 00 00 AA 01 00 00 00 42 76 16", ACK);
    ASK("68 0A 0A 68 88 82 7D 3E 3E 00 20 20 10 10 63 16", ACK);
    ASK("68 05 05 68 88 82 5D 3C 3E E1 16", "68 0B 0B 68 82 88 08 3E 3C 00 0C 00 02 00 AA 44 16");
    ASK("68 05 05 68 08 02 7D 42 24 ED 16", "68 05 05 68 02 08 08 BD DB AA 16");
    TEST_ASSERT_EQUAL_HEX8(0x42, dp_out[0]);
    TEST_ASSERT_TRUE(ddlm_diag(0, 0, 0));
    ASK("68 05 05 68 08 02 5D 42 24 CD 16", "68 05 05 68 02 08 0A BD DB AC 16");
    SILENT("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16");
    ASK("68 05 05 68 88 82 4D 3B 3E D0 16",
        "68 0A 0A 68 82 88 08 3E 3B 00 20 20 10 10 EB 16"); /* FCB 0 FCV 0 */
}

/* ---- facts 2.2: profirust 0.6.0 -------------------------------------------------------------------------- */

static void T91_the_profirust_conversation(void)
{
    inputs("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF");
    SILENT("DC 02 02");
    SILENT("DC 02 02");
    ASK("68 05 05 68 88 82 6C 3C 3E F0 16", "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 00 AA 3C 16");
    SILENT("10 03 02 49 4E 16");
    SILENT("DC 02 02");
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
    SILENT("68 07 07 68 FF 82 44 3A 3E 00 00 3D 16");
    ASK("68 0F 0F 68 88 82 5C 3D 3E 80 00 00 0B 00 AA 00 00 00 00 16 16", ACK);
    ASK("68 07 07 68 88 82 7C 3E 3E 27 17 40 16", ACK);
    ASK("68 05 05 68 88 82 5C 3C 3E E0 16", "68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 00 AA 3C 16");
    ASK("A2 08 02 7D 00 00 00 00 00 00 00 00 87 16", "A2 02 08 08 FF FF FF FF FF FF FF FF 0A 16");
}

/* ---- configurations that are adapted to ------------------------------------------------------------------ */

#define ANY_PRM "68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 00 AA 01 1F 16"

static void T46_a_device_that_adapts_takes_another_configuration_and_shows_it(void)
{
    ASK(ANY_PRM, ACK);
    ASK("68 07 07 68 88 82 6D 3E 3E 10 21 24 16", ACK); /* 1 in, 2 out */
    hv_run_for(HV_MS);
    STATE(DDLM_DATA_EXCH);
    TEST_ASSERT_EQUAL(1, dp_info()->input_len);
    TEST_ASSERT_EQUAL(2, dp_info()->output_len);
    ASK("68 05 05 68 88 82 6D 3B 3E F0 16", "68 07 07 68 82 88 08 3E 3B 10 21 BC 16");
    /* another one while exchanging: outputs safe, then it goes on with that */
    ASK("68 06 06 68 88 82 6D 3E 3E 10 03 16", ACK);
    hv_run_for(HV_MS);
    STATE(DDLM_DATA_EXCH);
    TEST_ASSERT_EQUAL(0, dp_info()->output_len);
}

static void T46_more_than_244_octets_are_refused_even_by_one_that_adapts(void)
{
    ASK(ANY_PRM, ACK);
    /* 4 x 64 octets of input in special format */
    ASK("68 0D 0D 68 88 82 6D 3E 3E 40 3F 40 3F 40 3F 40 3F EF 16", ACK);
    DIAG(0x0605);
}

static void T50_eight_octets_are_taken_in_SD3_and_in_SD2(void)
{
    ASK(ANY_PRM, ACK);
    ASK("68 07 07 68 88 82 6D 3E 3E 27 17 31 16", ACK);
    hv_run_for(HV_MS);
    ASK("A2 08 02 6D 01 02 03 04 05 06 07 08 9B 16", "A2 02 08 08 1E 00 00 00 00 00 00 00 30 16");
    TEST_ASSERT_EQUAL_HEX8(8, dp_out[7]);
    ASK("68 0B 0B 68 08 02 6D 11 12 13 14 15 16 17 18 1B 16",
        "68 0B 0B 68 02 08 08 1E 00 00 00 00 00 00 00 30 16");
    TEST_ASSERT_EQUAL_HEX8(0x18, dp_out[7]);
}

static void outputs_only(void)
{
    ASK(ANY_PRM, ACK);
    ASK("68 06 06 68 88 82 6D 3E 3E 21 14 16", ACK);
    hv_run_for(HV_MS);
    STATE(DDLM_DATA_EXCH);
}

static void T51_without_inputs_Data_Exchange_is_acknowledged_with_E5(void)
{
    outputs_only();
    ASK("68 05 05 68 08 02 6D 11 22 AA 16", ACK);
    ASK("68 05 05 68 08 02 5D 33 44 DE 16", ACK);
    ASK("68 05 05 68 08 02 7D 55 66 42 16", ACK);
    TEST_ASSERT_EQUAL_HEX8(0x55, dp_out[0]);
}

static void T51_without_inputs_a_diagnosis_is_announced_by_an_SD1_with_DH(void)
{
    outputs_only();
    TEST_ASSERT_TRUE(ddlm_diag(0, 0, 0));
    ASK("68 05 05 68 08 02 6D 11 22 AA 16", "10 02 08 0A 14 16");
    DIAG(0x0004);
    ASK("68 05 05 68 08 02 6D 33 44 EE 16", ACK);
}

static void T51_without_Fail_Safe_an_exchange_without_octets_is_of_wrong_length(void)
{
    outputs_only();
    ASK("10 08 02 6D 77 16", "10 02 08 03 0D 16");
    STATE(DDLM_WAIT_PRM);
}

static void the_longest_exchange_is_244_octets_each_way(void)
{
    uint8_t dx[253] = {0x68, 247, 247, 0x68, 0x08, 0x02, 0x6D};
    unsigned sum = 0x08 + 0x02 + 0x6D;
    ASK(ANY_PRM, ACK);
    /* output 64 64 64 52, then input the same, each in special format */
    ASK("68 15 15 68 88 82 6D 3E 3E 80 3F 80 3F 80 3F 80 33 40 3F 40 3F 40 3F 40 33 D3 16", ACK);
    hv_run_for(HV_MS);
    TEST_ASSERT_EQUAL(244, dp_info()->input_len);
    TEST_ASSERT_EQUAL(244, dp_info()->output_len);
    for (unsigned i = 0; i < 244; i++) {
        dx[7 + i] = (uint8_t)(i * 7);
        sum += dx[7 + i];
        dp_in[i] = (uint8_t)(255 - i);
    }
    dx[251] = (uint8_t)sum;
    dx[252] = 0x16;
    hv_run_for(HV_MS);
    TEST_ASSERT_EQUAL_UINT(253, dp_ask_octets(dx, sizeof dx, __LINE__));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(dp_in, seg_said.octets + 7, 244);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(dx + 7, dp_out, 244);
    TEST_ASSERT_EQUAL_UINT(255, strlen(dp_ask("68 05 05 68 88 83 6D 38 3E EE 16", __LINE__)) / 3 +
                                    1); /* Rd_Inp: LE 249 */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(A12_the_start_of_a_slave_as_traced);
    RUN_TEST(A12_SD2_with_a_right_FCS_is_received);
    RUN_TEST(A12_SD1_with_a_wrong_FCS_is_dropped_and_counted);
    RUN_TEST(A12_the_prototypes_Set_Prm);
    RUN_TEST(T89_the_ET200S_conversation);
    RUN_TEST(T90_the_pyprofibus_conversation);
    RUN_TEST(T91_the_profirust_conversation);
    RUN_TEST(T46_a_device_that_adapts_takes_another_configuration_and_shows_it);
    RUN_TEST(T46_more_than_244_octets_are_refused_even_by_one_that_adapts);
    RUN_TEST(T50_eight_octets_are_taken_in_SD3_and_in_SD2);
    RUN_TEST(T51_without_inputs_Data_Exchange_is_acknowledged_with_E5);
    RUN_TEST(T51_without_inputs_a_diagnosis_is_announced_by_an_SD1_with_DH);
    RUN_TEST(T51_without_Fail_Safe_an_exchange_without_octets_is_of_wrong_length);
    RUN_TEST(the_longest_exchange_is_244_octets_each_way);
    return UNITY_END();
}
