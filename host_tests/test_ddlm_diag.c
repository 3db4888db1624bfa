/* Slave_Diag: what the master is told, extended diagnosis, and who has been told (Diag_Flag).
 * Clause: EN 50170-2 part 8, Slave_Diag; spec A6; facts 3.9.
 * 1: 02 not ready 04 Cfg_Fault 08 Ext_Diag 10 Not_Supported 40 Prm_Fault; 2: 01 Prm_Req 02 Stat_Diag 04 always 08 WD_On
 * 10 Freeze 20 Sync; 3: 80 overflow; 4 master, FF none; 5, 6 ident. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    app.data_count = 0;
}

void tearDown(void)
{
    fake_end();
}

static bool diag(const char *hex, uint8_t flags)
{
    static uint8_t XDATA ext[255];

    return ddlm_diag(ext, from_hex(ext, hex), flags);
}

/* Data_Exchange of the owner, answered low or high. */
#define EXCHANGE "68 05 05 68 08 02 6D 01 02 7A 16"
#define LOW      "68 05 05 68 02 08 08 31 01 44 16"
#define HIGH     "68 05 05 68 02 08 0A 31 01 46 16"
#define READ     "68 05 05 68 88 82 6D 3C 3E F1 16"

/* ---- six octets ---- */

static void after_power_up_parameters_are_requested(void)
{
    request("68 05 05 68 88 82 6D 3C 3E F1 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
    request("68 05 05 68 88 80 6C 3C 3E EE 16");
    ANSWERED("68 0B 0B 68 80 88 08 3E 3C 02 05 00 FF 12 34 D6 16");
}

static void each_state_shows(void)
{
    to_wait_cfg();
    DIAG("02 04 00 02 12 34");
    to_data_exch();
    DIAG("00 04 00 02 12 34");
}

static void the_watchdog_shows(void)
{
    ask_sap(8, 2, 61, "88 0A 0A 0B 12 34 00");
    DIAG("02 0C 00 02 12 34");
}

static void sync_and_freeze_mode_show_while_they_last(void)
{
    ask_sap(8, 2, 61, "B0 00 00 0B 12 34 00");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    ask("68 07 07 68 FF 82 46 3A 3E 20 00 5F 16");
    DIAG("00 24 00 02 12 34");
    ask("68 07 07 68 FF 82 46 3A 3E 08 00 47 16");
    DIAG("00 34 00 02 12 34");
    ask("68 07 07 68 FF 82 46 3A 3E 10 00 4F 16");
    DIAG("00 14 00 02 12 34");
    ask("68 07 07 68 FF 82 46 3A 3E 04 00 43 16");
    DIAG("00 04 00 02 12 34");
}

static void slave_diag_with_data_is_refused_rr(void)
{
    request("68 06 06 68 88 82 6D 3C 3E 00 F1 16");
    ANSWERED("10 02 08 02 0C 16");
}

/* ---- parameters acknowledged and not looked at yet ---- */

static void while_parameters_or_configuration_wait_the_station_is_not_ready_and_asks_for_nothing(void)
{
    request("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 0B 12 34 00 C3 16");
    request(READ);
    ANSWERED("68 0B 0B 68 82 88 08 3E 3C 02 04 00 FF 12 34 D7 16");
    turn();
    request("68 09 09 68 88 82 6D 3E 3E 10 20 10 20 53 16");
    request(READ);
    ANSWERED("68 0B 0B 68 82 88 08 3E 3C 02 04 00 FF 12 34 D7 16");
    turn();
    request(READ);
    ANSWERED("68 0B 0B 68 82 88 08 3E 3C 02 04 00 02 12 34 DA 16");
}

/* Otherwise a class-2 master, or data for a SAP of the application, would make the owner believe the station is gone. */
static void what_waits_during_data_exchange_leaves_the_diagnosis_alone(void)
{
    to_data_exch();
    request("68 0C 0C 68 88 83 6D 3D 3E 80 00 00 0B 12 34 00 C4 16");
    request(READ);
    ANSWERED("68 0B 0B 68 82 88 08 3E 3C 00 04 00 02 12 34 D8 16");
    turn();
    STATE(DDLM_DATA_EXCH);
}

/* ---- extended diagnosis ---- */

static void device_identifier_and_channel_blocks_follow_the_six_octets(void)
{
    TEST_ASSERT_TRUE(diag("44 00 01 00 88 41 21 04 10 20 30", DDLM_EXT_DIAG)); /* facts 3.9 */
    DIAG("0A 05 00 FF 12 34 44 00 01 00 88 41 21 04 10 20 30");
}

static void blocks_may_be_a_status_and_no_fault(void)
{
    TEST_ASSERT_TRUE(diag("02 01", 0));
    DIAG("02 05 00 FF 12 34 02 01");
}

static void diagnosis_goes_as_it_came(void)
{
    diag("02 01", DDLM_EXT_DIAG);
    diag("", 0);
    DIAG("02 05 00 FF 12 34");
}

static void static_diagnosis_shows(void)
{
    diag("", DDLM_STAT_DIAG);
    DIAG("02 07 00 FF 12 34");
}

static void what_fits_exactly_is_no_overflow(void)
{
    TEST_ASSERT_TRUE(diag("06 01 02 03 04 05 06 01 02 03 04 05", DDLM_EXT_DIAG)); /* 12 octets */
    DIAG("0A 05 00 FF 12 34 06 01 02 03 04 05 06 01 02 03 04 05");
}

static void only_whole_blocks_are_sent_and_the_rest_is_an_overflow(void)
{
    TEST_ASSERT_TRUE(diag("06 01 02 03 04 05 05 01 02 03 04 02 FF", DDLM_EXT_DIAG));
    DIAG("0A 05 80 FF 12 34 06 01 02 03 04 05 05 01 02 03 04");
    TEST_ASSERT_TRUE(diag("0D 01 02 03 04 05 06 07 08 09 0A 0B 0C", DDLM_EXT_DIAG));
    DIAG("0A 05 80 FF 12 34");
    diag("", 0);
    DIAG("02 05 00 FF 12 34");
}

static void malformed_blocks_change_nothing(void)
{
    diag("02 01", DDLM_EXT_DIAG);
    TEST_ASSERT_FALSE(diag("00 01", 0));          /* no length           */
    TEST_ASSERT_FALSE(diag("01", 0));             /* header alone        */
    TEST_ASSERT_FALSE(diag("41 01", 0));
    TEST_ASSERT_FALSE(diag("03 01", 0));          /* longer than given   */
    TEST_ASSERT_FALSE(diag("88 41", 0));          /* channel: 3 octets   */
    TEST_ASSERT_FALSE(diag("C3 00 00", 0));       /* reserved kind       */
    TEST_ASSERT_FALSE(diag("02 01 44 00 01", 0)); /* the second is short */
    TEST_ASSERT_FALSE(diag("02 02", 0x04));       /* no such flag        */
    DIAG("0A 05 00 FF 12 34 02 01");
}

static void the_longest_list_of_blocks_is_cut_like_any_other(void)
{
    static uint8_t XDATA ext[255];
    uint8_t i;

    for (i = 0; i < 255; i = (uint8_t)(i + 3))
        from_hex(ext + i, "88 41 21");
    TEST_ASSERT_TRUE(ddlm_diag(ext, 255, DDLM_EXT_DIAG));
    DIAG("0A 05 80 FF 12 34 88 41 21 88 41 21 88 41 21 88 41 21");
}

/* ---- Diag_Flag ---- */

static void a_change_makes_data_exchange_answer_high_until_the_owner_has_read_it(void)
{
    to_data_exch();
    request(EXCHANGE);
    ANSWERED(LOW);
    diag("02 01", DDLM_EXT_DIAG);
    request(EXCHANGE);
    ANSWERED(HIGH);
    inputs("31 01");
    request(EXCHANGE);
    ANSWERED(HIGH);
    request(READ);
    ANSWERED("68 0D 0D 68 82 88 08 3E 3C 08 04 00 02 12 34 02 01 E3 16");
    request(EXCHANGE);
    ANSWERED(LOW);
}

static void another_master_looks_without_taking_the_news_away(void)
{
    to_data_exch();
    diag("02 01", DDLM_EXT_DIAG);
    DIAG("08 04 00 02 12 34 02 01");
    request(EXCHANGE);
    ANSWERED(HIGH);
}

static void static_diagnosis_keeps_the_flag_until_it_is_cleared(void)
{
    to_data_exch();
    diag("", DDLM_STAT_DIAG);
    request(READ);
    request(EXCHANGE);
    ANSWERED(HIGH);
    diag("", 0);
    request(EXCHANGE);
    ANSWERED(HIGH);
    request(READ);
    request(EXCHANGE);
    ANSWERED(LOW);
}

static void a_slave_diag_that_is_refused_is_not_read(void)
{
    to_data_exch();
    diag("02 01", DDLM_EXT_DIAG);
    request("68 06 06 68 88 82 6D 3C 3E 00 F1 16");
    request(EXCHANGE);
    ANSWERED(HIGH);
}

static void a_diagnosis_raised_while_the_one_before_is_being_sent_is_still_to_be_read(void)
{
    to_data_exch();
    diag("02 01", DDLM_EXT_DIAG);
    fake_silence();
    hear(READ);
    diag("02 02", DDLM_EXT_DIAG); /* the answer has been decided */
    finish_request();
    request(EXCHANGE);
    ANSWERED(HIGH);
    request(READ);
    request(EXCHANGE);
    ANSWERED(LOW);
}

static void a_diagnosis_raised_while_data_exchange_comes_in_answers_high_at_once(void)
{
    to_data_exch();
    request(EXCHANGE);
    ANSWERED(LOW);
    fake_silence();
    hear("68 05 05 68 08 02 6D");
    diag("02 01", DDLM_EXT_DIAG);
    hear("A1 A2 BA 16");
    finish_request();
    ANSWERED(HIGH);
}

static void malformed_blocks_raise_no_flag(void)
{
    to_data_exch();
    diag("00", 0);
    request(EXCHANGE);
    ANSWERED(LOW);
}

static void diagnosis_told_before_data_exchange_is_known_once_it_starts(void)
{
    diag("02 01", DDLM_EXT_DIAG);
    to_wait_cfg();
    request(READ);
    to_data_exch();
    request(EXCHANGE);
    ANSWERED(LOW);
}

/* ---- interrupts at every unlock ---- */

static void the_owner_reads(void)
{
    request(READ);
}

/* However a read falls into an update: at its end the news have been read, or the flag is still up. */
static void no_news_are_lost_between_interrupt_and_main(void)
{
    to_data_exch();
    fake_at_unlock = the_owner_reads;
    diag("02 01", DDLM_EXT_DIAG);
    fake_at_unlock = 0;
    if (fake.sent_len != 19) { /* the last read did not show the two octets */
        request(EXCHANGE);
        ANSWERED(HIGH);
    }
    OCTETS("02 01", fake.sent + 15, 2);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(after_power_up_parameters_are_requested);
    RUN_TEST(each_state_shows);
    RUN_TEST(the_watchdog_shows);
    RUN_TEST(sync_and_freeze_mode_show_while_they_last);
    RUN_TEST(slave_diag_with_data_is_refused_rr);
    RUN_TEST(while_parameters_or_configuration_wait_the_station_is_not_ready_and_asks_for_nothing);
    RUN_TEST(what_waits_during_data_exchange_leaves_the_diagnosis_alone);
    RUN_TEST(device_identifier_and_channel_blocks_follow_the_six_octets);
    RUN_TEST(blocks_may_be_a_status_and_no_fault);
    RUN_TEST(diagnosis_goes_as_it_came);
    RUN_TEST(static_diagnosis_shows);
    RUN_TEST(what_fits_exactly_is_no_overflow);
    RUN_TEST(only_whole_blocks_are_sent_and_the_rest_is_an_overflow);
    RUN_TEST(malformed_blocks_change_nothing);
    RUN_TEST(the_longest_list_of_blocks_is_cut_like_any_other);
    RUN_TEST(a_change_makes_data_exchange_answer_high_until_the_owner_has_read_it);
    RUN_TEST(another_master_looks_without_taking_the_news_away);
    RUN_TEST(static_diagnosis_keeps_the_flag_until_it_is_cleared);
    RUN_TEST(a_slave_diag_that_is_refused_is_not_read);
    RUN_TEST(a_diagnosis_raised_while_the_one_before_is_being_sent_is_still_to_be_read);
    RUN_TEST(a_diagnosis_raised_while_data_exchange_comes_in_answers_high_at_once);
    RUN_TEST(malformed_blocks_raise_no_flag);
    RUN_TEST(diagnosis_told_before_data_exchange_is_known_once_it_starts);
    RUN_TEST(no_news_are_lost_between_interrupt_and_main);
    return UNITY_END();
}
