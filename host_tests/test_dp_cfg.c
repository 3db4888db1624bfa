/* T38 - T46 and T70: Chk_Cfg and Get_Cfg. Identifiers: EN 50170-2 part 8, Chk_Cfg; spec A6; facts 3.8.
 * Slave_Diag octets 1, 2: 0204 waits for configuration, 0604 would be Cfg_Fault in place, 0605 Cfg_Fault and
 * parameters awaited, 0004 exchanges data. DP-TEST01 is 10 20 10 20 and adapts to nothing else. */
#include "ddlm/ddlm_cfg.h"
#include "dp_fixture.h"

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

#define CFG_FAULT 0x0605

#define REFUSED(chk_cfg)                                                                                     \
    do {                                                                                                     \
        ASK(SET_PRM, ACK);                                                                                   \
        STATE(DDLM_WAIT_CFG);                                                                                \
        ASK((chk_cfg), ACK);                                                                                 \
        STATE(DDLM_WAIT_PRM);                                                                                \
        DIAG(CFG_FAULT);                                                                                     \
    } while (0)

static void T38_the_real_configuration_leads_to_DATA_EXCH(void)
{
    ASK(SET_PRM, ACK);
    ASK(CHK_CFG, ACK);
    hv_run_for(HV_MS);
    STATE(DDLM_DATA_EXCH);
    DIAG(0x0004);
    ASK(DX, DX_OK);
}

static void T39_a_missing_module_is_refused(void)
{
    REFUSED("68 08 08 68 88 82 6D 3E 3E 10 20 10 33 16");
    REFUSED("68 05 05 68 88 82 6D 3E 3E F3 16"); /* none at all */
}

static void T40_a_module_too_many_is_refused(void)
{
    REFUSED("68 0A 0A 68 88 82 6D 3E 3E 10 20 10 20 10 63 16");
    REFUSED("68 0A 0A 68 88 82 6D 3E 3E 10 20 10 20 00 53 16"); /* an empty slot counts */
}

static void T41_an_empty_slot_or_an_input_in_place_of_an_output_is_refused(void)
{
    REFUSED("68 09 09 68 88 82 6D 3E 3E 00 20 10 20 43 16");
    REFUSED("68 09 09 68 88 82 6D 3E 3E 10 20 10 10 43 16");
}

static void T41_modules_in_another_order_are_refused(void)
{
    REFUSED("68 09 09 68 88 82 6D 3E 3E 10 10 20 20 53 16"); /* the same lengths */
    REFUSED("68 09 09 68 88 82 6D 3E 3E 20 10 20 10 53 16");
}

static void T41_another_consistency_or_length_is_refused(void)
{
    REFUSED("68 09 09 68 88 82 6D 3E 3E 90 20 10 20 D3 16"); /* whole instead of byte consistency */
    REFUSED("68 09 09 68 88 82 6D 3E 3E 11 20 10 20 54 16");
    REFUSED("68 09 09 68 88 82 6D 3E 3E 50 20 10 20 93 16"); /* word instead of byte */
}

/* identifier -> octets of input and output that a master means by it */
struct reading {
    uint8_t cfg[6], len;
    bool good;
    uint16_t input, output;
};

static void read_all(const struct reading *r, unsigned n)
{
    struct ddlm_cfg_lengths lengths;
    for (unsigned i = 0; i < n; i++) {
        TEST_ASSERT_EQUAL(r[i].good, ddlm_cfg_lengths(r[i].cfg, r[i].len, &lengths));
        if (r[i].good) {
            TEST_ASSERT_EQUAL_UINT16(r[i].input, lengths.input);
            TEST_ASSERT_EQUAL_UINT16(r[i].output, lengths.output);
        }
    }
}

static void T42_special_formats_are_read(void)
{
    static const struct reading readings[] = {
        {{0x00}, 1, true, 0, 0},                    /* empty slot */
        {{0x40, 0x03}, 2, true, 4, 0},              /* one length octet: input, 4 bytes */
        {{0x80, 0xC1}, 2, true, 0, 4},              /* output, 2 words, whole */
        {{0xC0, 0x01, 0x42}, 3, true, 6, 2},        /* output first, then input */
        {{0x41, 0x3F, 0x99}, 3, true, 64, 0},       /* one manufacturer octet behind */
        {{0xC2, 0x87, 0x8A, 1, 2}, 5, true, 11, 8}, /* two */
        {{0xF3, 0x7B}, 2, true, 32, 32},            /* compact: 4 + 12 words both ways */
        {{0x11, 0x22}, 2, true, 2, 3},              /* 2 in, 3 out */
        {{0x01, 0x77}, 2, true, 0, 0},              /* no data, one manufacturer octet */
    };
    read_all(readings, sizeof readings / sizeof readings[0]);
}

static void T43_manufacturer_length_15_means_none(void)
{
    static const struct reading readings[] = {
        {{0x0F}, 1, true, 0, 0},
        {{0x4F, 0x00, 0x20}, 3, true, 1, 1},
        {{0xCF, 0x00, 0x01, 0x10}, 4, true, 3, 1},
    };
    read_all(readings, sizeof readings / sizeof readings[0]);
}

static void T43_an_identifier_that_promises_more_octets_than_there_are_is_refused(void)
{
    static const struct reading readings[] = {
        {{0x40}, 1, false, 0, 0},
        {{0xC0, 0x01}, 2, false, 0, 0},
        {{0x0E, 1, 2, 3}, 4, false, 0, 0},
    };
    read_all(readings, sizeof readings / sizeof readings[0]);
    REFUSED("68 06 06 68 88 82 6D 3E 3E 40 33 16");
    REFUSED("68 06 06 68 88 82 6D 3E 3E C0 B3 16");
    REFUSED("68 07 07 68 88 82 6D 3E 3E 0E 01 02 16");
}

static void T44_the_longest_Chk_Cfg_is_refused_and_nothing_worse(void)
{
    uint8_t octets[255] = {0x68, 249, 249, 0x68, 0x88, 0x82, 0x6D, 0x3E, 0x3E};
    octets[253] = 0xF3; /* 88 + 82 + 6D + 3E + 3E: 244 empty slots */
    octets[254] = 0x16;
    ASK(SET_PRM, ACK);
    TEST_ASSERT_EQUAL_UINT(1, dp_ask_octets(octets, sizeof octets, __LINE__));
    DIAG(CFG_FAULT);
}

static void T45_Chk_Cfg_in_WAIT_PRM_is_not_processed(void)
{
    ASK(CHK_CFG, ACK);
    STATE(DDLM_WAIT_PRM);
    DIAG(0x0205);
    ASK("68 05 05 68 88 82 6D 3E 3E F3 16", ACK);
    DIAG(0x0205);
}

static void T45_Chk_Cfg_of_another_master_is_not_processed(void)
{
    ASK(SET_PRM, ACK);
    ASK("68 09 09 68 88 83 6D 3E 3E 10 20 10 20 54 16", ACK);
    STATE(DDLM_WAIT_CFG);
    TO_DATA_EXCH(SET_PRM);
    ASK("68 05 05 68 88 83 6D 3E 3E F4 16", ACK);
    STATE(DDLM_DATA_EXCH);
}

static void T45_Chk_Cfg_in_DATA_EXCH_is_checked_again(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(DX, DX_OK);
    ASK("68 09 09 68 88 82 5D 3E 3E 10 20 10 20 43 16", ACK);
    STATE(DDLM_DATA_EXCH);
    OUTPUTS(0x11, 0x22);
    ASK("68 08 08 68 88 82 7D 3E 3E 10 20 10 43 16", ACK);
    STATE(DDLM_WAIT_PRM);
    OUTPUTS(0, 0);
    DIAG(CFG_FAULT);
}

static void T46_this_device_adapts_to_no_other_configuration(void)
{
    REFUSED("68 09 09 68 88 82 6D 3E 3E 10 10 20 20 53 16");
    /* a device that does: test_dp_replay.c */
}

static void a_configuration_fault_goes_with_the_next_good_parameters(void)
{
    REFUSED("68 08 08 68 88 82 6D 3E 3E 10 20 10 33 16");
    ASK(SET_PRM, ACK);
    DIAG(0x0204);
}

static void T70_Get_Cfg_is_answered_in_every_state_and_RR_with_data(void)
{
    static const char get[] = "68 05 05 68 88 82 6D 3B 3E F0 16";
    static const char cfg[] = "68 09 09 68 82 88 08 3E 3B 10 20 10 20 EB 16";
    ASK(get, cfg);
    ASK(SET_PRM, ACK);
    ASK(get, cfg);
    TO_DATA_EXCH(SET_PRM);
    ASK(get, cfg);
    ASK("68 05 05 68 88 84 6D 3B 3E F2 16", "68 09 09 68 84 88 08 3E 3B 10 20 10 20 ED 16");
    ASK("68 06 06 68 88 82 6D 3B 3E 00 F0 16", "10 02 08 02 0C 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T38_the_real_configuration_leads_to_DATA_EXCH);
    RUN_TEST(T39_a_missing_module_is_refused);
    RUN_TEST(T40_a_module_too_many_is_refused);
    RUN_TEST(T41_an_empty_slot_or_an_input_in_place_of_an_output_is_refused);
    RUN_TEST(T41_modules_in_another_order_are_refused);
    RUN_TEST(T41_another_consistency_or_length_is_refused);
    RUN_TEST(T42_special_formats_are_read);
    RUN_TEST(T43_manufacturer_length_15_means_none);
    RUN_TEST(T43_an_identifier_that_promises_more_octets_than_there_are_is_refused);
    RUN_TEST(T44_the_longest_Chk_Cfg_is_refused_and_nothing_worse);
    RUN_TEST(T45_Chk_Cfg_in_WAIT_PRM_is_not_processed);
    RUN_TEST(T45_Chk_Cfg_of_another_master_is_not_processed);
    RUN_TEST(T45_Chk_Cfg_in_DATA_EXCH_is_checked_again);
    RUN_TEST(T46_this_device_adapts_to_no_other_configuration);
    RUN_TEST(a_configuration_fault_goes_with_the_next_good_parameters);
    RUN_TEST(T70_Get_Cfg_is_answered_in_every_state_and_RR_with_data);
    return UNITY_END();
}
