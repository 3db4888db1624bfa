/* A modular device that adapts to the configuration the master expects.
 * Clause: EN 50170-2 part 8, Chk_Cfg; facts 3.8 ("correct, incorrect or adaptable"). By itself 10 20; up to 8 octets each
 * way in up to 6 identifier octets. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = true;
    station_begin(8);
    app.cfg_count = 0;
    to_wait_cfg();
}

void tearDown(void)
{
    fake_end();
}

#define CHK_CFG(du) ask_sap(8, 2, 62, du)

static void rejected(uint8_t asked)
{
    ANSWERED("E5");
    STATE(DDLM_WAIT_PRM);
    DIAG("06 05 00 FF 12 34");
    TEST_ASSERT_EQUAL(asked, app.cfg_count);
}

static void the_own_configuration_needs_no_adaption(void)
{
    app.adapts = false;
    CHK_CFG("10 20");
    TEST_ASSERT_EQUAL(0, app.cfg_count);
    inputs("01");
    STATE(DDLM_DATA_EXCH);
    INFO(1, input_len);
    INFO(1, output_len);
}

static void another_one_is_taken_with_its_own_lengths(void)
{
    CHK_CFG("51 22"); /* two words in, three octets out */
    ANSWERED("E5");
    TEST_ASSERT_EQUAL(1, app.cfg_count);
    TEST_ASSERT_EQUAL(2, app.cfg_len);
    INFO(4, input_len);
    INFO(3, output_len);
    inputs("11 12 13 14");
    STATE(DDLM_DATA_EXCH);
    request("68 06 06 68 08 02 6D 21 22 23 DD 16");
    ANSWERED("68 07 07 68 02 08 08 11 12 13 14 5C 16");
    ddlm_outputs(outputs);
    OCTETS("21 22 23", outputs, 3);
    request("68 05 05 68 88 82 6D 3B 3E F0 16");
    ANSWERED("68 07 07 68 82 88 08 3E 3B 51 22 FE 16"); /* Get_Cfg */
}

static void the_application_may_refuse(void)
{
    app.adapts = false;
    CHK_CFG("51 22");
    rejected(1);
    INFO(1, input_len);
}

static void eight_octets_each_way_are_the_most(void)
{
    CHK_CFG("17 27");
    INFO(8, input_len);
    INFO(8, output_len);
}

static void nine_octets_in_are_too_many(void)
{
    CHK_CFG("18 27");
    rejected(0);
}

static void nine_octets_out_are_too_many(void)
{
    CHK_CFG("17 28");
    rejected(0);
}

static void six_identifier_octets_are_the_most(void)
{
    CHK_CFG("10 10 10 10 10 10");
    INFO(6, input_len);
}

static void seven_identifier_octets_are_too_many(void)
{
    CHK_CFG("10 10 10 10 10 10 10");
    rejected(0);
}

static void an_identifier_that_is_cut_off_is_refused_unasked(void)
{
    CHK_CFG("10 C0 01");
    rejected(0);
}

static void eight_octets_go_out_in_the_format_they_came_in(void)
{
    CHK_CFG("17 27");
    inputs("01 02 03 04 05 06 07 08");
    request("A2 08 02 6D 11 12 13 14 15 16 17 18 1B 16");
    ANSWERED("A2 02 08 08 01 02 03 04 05 06 07 08 36 16");
    OUTPUTS(DDLM_OUT_NEW, "11 12 13 14 15 16 17 18");
}

static void a_master_may_change_its_mind_before_data_exchange(void)
{
    CHK_CFG("51 22");
    CHK_CFG("10 20");
    INFO(1, input_len);
    inputs("01");
    request("68 04 04 68 08 02 6D 21 98 16");
    ANSWERED("68 04 04 68 02 08 08 01 13 16");
    request("68 05 05 68 88 82 6D 3B 3E F0 16");
    ANSWERED("68 07 07 68 82 88 08 3E 3B 10 20 BB 16");
}

static void the_adapted_configuration_in_data_exchange_changes_nothing(void)
{
    CHK_CFG("51 22");
    inputs("11 12 13 14");
    ddlm_outputs(outputs);
    CHK_CFG("51 22");
    STATE(DDLM_DATA_EXCH);
    TEST_ASSERT_EQUAL(1, app.cfg_count);
    OUTPUTS(DDLM_OUT_SAME, "00 00 00");
}

static void another_one_in_data_exchange_begins_anew(void)
{
    CHK_CFG("51 22");
    inputs("11 12 13 14");
    request("68 06 06 68 08 02 6D 21 22 23 DD 16");
    CHK_CFG("11 27");
    STATE(DDLM_WAIT_CFG);
    OUTPUTS(DDLM_OUT_SAFE, "00 00 00 00 00 00 00 00");
    inputs("31 32");
    STATE(DDLM_DATA_EXCH);
    request("68 0B 0B 68 08 02 6D 01 02 03 04 05 06 07 08 9B 16");
    ANSWERED("68 05 05 68 02 08 08 31 32 75 16");
    OUTPUTS(DDLM_OUT_NEW, "01 02 03 04 05 06 07 08");
}

static void an_old_data_exchange_comes(void)
{
    request("68 06 06 68 08 02 6D 21 22 23 DD 16");
    ANSWERED("10 02 08 03 0D 16"); /* RS: facts 3.6 */
}

static void while_another_one_is_looked_at_no_data_are_exchanged(void)
{
    CHK_CFG("51 22");
    inputs("11 12 13 14");
    app.while_adapting = an_old_data_exchange_comes;
    CHK_CFG("11 27");
    app.while_adapting = 0;
    TEST_ASSERT_EQUAL(2, app.cfg_count);
    COUNTED(0, data_exchange);
    COUNTED(0, wrong_length);
    STATE(DDLM_WAIT_CFG);
}

static void the_own_configuration_in_data_exchange_of_another_begins_anew(void)
{
    CHK_CFG("51 22");
    inputs("11 12 13 14");
    CHK_CFG("10 20");
    STATE(DDLM_WAIT_CFG);
    INFO(1, input_len);
}

/* Empty slots alone: nothing to exchange, and so nothing to wait for. */
static void a_configuration_without_data_is_exchanged_as_sc(void)
{
    CHK_CFG("00 00");
    STATE(DDLM_DATA_EXCH);
    request("10 08 02 6D 77 16");
    ANSWERED("E5");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_own_configuration_needs_no_adaption);
    RUN_TEST(another_one_is_taken_with_its_own_lengths);
    RUN_TEST(the_application_may_refuse);
    RUN_TEST(eight_octets_each_way_are_the_most);
    RUN_TEST(nine_octets_in_are_too_many);
    RUN_TEST(nine_octets_out_are_too_many);
    RUN_TEST(six_identifier_octets_are_the_most);
    RUN_TEST(seven_identifier_octets_are_too_many);
    RUN_TEST(an_identifier_that_is_cut_off_is_refused_unasked);
    RUN_TEST(eight_octets_go_out_in_the_format_they_came_in);
    RUN_TEST(a_master_may_change_its_mind_before_data_exchange);
    RUN_TEST(the_adapted_configuration_in_data_exchange_changes_nothing);
    RUN_TEST(another_one_in_data_exchange_begins_anew);
    RUN_TEST(while_another_one_is_looked_at_no_data_are_exchanged);
    RUN_TEST(the_own_configuration_in_data_exchange_of_another_begins_anew);
    RUN_TEST(a_configuration_without_data_is_exchanged_as_sc);
    return UNITY_END();
}
