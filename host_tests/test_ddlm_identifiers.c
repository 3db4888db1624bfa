/* Identifier bytes: how many octets a configuration means, in the master's words: input = slave to master.
 * Clause: EN 50170-2 part 8, Chk_Cfg; facts 3.8; spec A6.
 * compact: bit 7 consistency, 6 words, 5..4 01 in 10 out 11 both, 3..0 length - 1;
 * special: bits 5..4 = 00, 7..6 lengths that follow, 3..0 manufacturer octets behind them (15 = none). */
#include "ddlm/ddlm_cfg.h"
#include "fake_hal.h"

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    (void)octet;
    (void)err;
}

void line_silence_isr(void) IN_ISR
{
}

void line_sent_isr(void) IN_ISR
{
}

void setUp(void)
{
    fake_begin();
}

void tearDown(void)
{
    fake_end();
}

static uint8_t XDATA cfg[250];
static struct ddlm_cfg_lengths XDATA lengths;

static bool parse(const char *hex)
{
    return ddlm_cfg_lengths(cfg, from_hex(cfg, hex), &lengths);
}

#define MEANS(in, out, hex)                                                                                     \
    do {                                                                                                        \
        TEST_ASSERT_TRUE_MESSAGE(parse(hex), hex);                                                              \
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(in, lengths.input, hex);                                               \
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(out, lengths.output, hex);                                             \
    } while (0)
#define CUT_OFF(hex) TEST_ASSERT_FALSE_MESSAGE(parse(hex), hex)

static void nothing_means_nothing(void)
{
    MEANS(0, 0, "");
}

static void compact_bytes(void)
{
    MEANS(1, 0, "10");
    MEANS(2, 0, "11");
    MEANS(16, 0, "1F");
    MEANS(0, 1, "20");
    MEANS(0, 3, "22");
    MEANS(1, 1, "30");
    MEANS(16, 16, "3F");
}

static void compact_words_are_two_octets_each(void)
{
    MEANS(2, 0, "50");
    MEANS(32, 0, "5F");
    MEANS(0, 4, "61");
    MEANS(32, 32, "7F");
}

static void consistency_changes_no_length(void)
{
    MEANS(1, 0, "90");
    MEANS(0, 1, "A0");
    MEANS(8, 8, "F3");
    MEANS(32, 32, "F3 7B"); /* spec A6: 4 and 12 words, both ways */
}

static void an_empty_slot_means_nothing(void)
{
    MEANS(0, 0, "00");
    MEANS(1, 1, "00 10 00 20");
}

static void special_input_has_one_length_octet(void)
{
    MEANS(1, 0, "40 00");
    MEANS(64, 0, "40 3F");
    MEANS(128, 0, "40 7F"); /* words */
    MEANS(64, 0, "40 BF");  /* consistent */
}

static void special_output_has_one_length_octet(void)
{
    MEANS(0, 1, "80 00");
    MEANS(0, 128, "80 FF");
}

static void special_both_has_output_then_input(void)
{
    MEANS(11, 8, "C0 87 8A");
    MEANS(11, 8, "C4 87 8A 01 02 03 04"); /* facts 3.8, a real one */
}

static void manufacturer_octets_are_skipped(void)
{
    MEANS(0, 0, "03 FF FF FF");
    MEANS(1, 1, "41 00 3F 20");
    MEANS(1, 0, "0E 30 30 30 30 30 30 30 30 30 30 30 30 30 30 10");
}

static void fifteen_manufacturer_octets_mean_none(void)
{
    MEANS(1, 1, "4F 00 20");
    MEANS(0, 1, "0F 20");
}

static void lengths_add_up(void)
{
    MEANS(2, 2, "10 20 10 20");
    MEANS(128 * 2, 0, "40 7F 40 7F");
}

static void an_identifier_that_is_cut_off_is_no_configuration(void)
{
    CUT_OFF("40");
    CUT_OFF("80");
    CUT_OFF("C0");
    CUT_OFF("C0 87");
    CUT_OFF("C4 87 8A 01 02 03");
    CUT_OFF("01");
    CUT_OFF("0E 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D");
    CUT_OFF("10 20 10 4F");
}

/* 244 octets of C0 FF FF would be 81 times 128 octets: the sums do not wrap. */
static void the_longest_configuration_does_not_wrap(void)
{
    uint8_t i;

    for (i = 0; i < 243; i = (uint8_t)(i + 3)) {
        cfg[i] = 0xC0;
        cfg[i + 1] = 0xFF;
        cfg[i + 2] = 0xFF;
    }
    TEST_ASSERT_TRUE(ddlm_cfg_lengths(cfg, 243, &lengths));
    TEST_ASSERT_EQUAL_UINT16(10368, lengths.input);
    TEST_ASSERT_EQUAL_UINT16(10368, lengths.output);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(nothing_means_nothing);
    RUN_TEST(compact_bytes);
    RUN_TEST(compact_words_are_two_octets_each);
    RUN_TEST(consistency_changes_no_length);
    RUN_TEST(an_empty_slot_means_nothing);
    RUN_TEST(special_input_has_one_length_octet);
    RUN_TEST(special_output_has_one_length_octet);
    RUN_TEST(special_both_has_output_then_input);
    RUN_TEST(manufacturer_octets_are_skipped);
    RUN_TEST(fifteen_manufacturer_octets_mean_none);
    RUN_TEST(lengths_add_up);
    RUN_TEST(an_identifier_that_is_cut_off_is_no_configuration);
    RUN_TEST(the_longest_configuration_does_not_wrap);
    return UNITY_END();
}
