/* What happens between header and end of a request, between its end and its answer, and while the answer goes out: main
 * changes what the answer was decided from, the telegram turns out bad, the line is opened anew.
 * Clauses: EN 50170-2 part 4, 4.1.3 (a station answers good telegrams only), 4.7.4 (retries); DESIGN.md, "Decided early".
 * Station 8, asked by station 2; SRD high: FC 6D first, 5D and 7D numbered. */
#include "fdl_unit.h"

void setUp(void)
{
    unit_begin();
    unit_default_sap(FDL_TO_ISR);
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
}

void tearDown(void)
{
    fake_end();
}

#define ANSWER_11 "68 04 04 68 02 08 08 11 23 16"
#define ANSWER_22 "68 04 04 68 02 08 08 22 34 16"

/* The first octets of a request, and the rest of it with its answer. */
static void begin(const char *hex)
{
    fake.sent_len = 0;
    fake_silence();
    hear(hex);
}

static void end(const char *hex)
{
    hear(hex);
    finish_request();
}

static void a_bad_fcs_after_the_decision_leaves_no_trace_but_the_counter(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    request("68 04 04 68 08 02 5D 01 69 16");
    NOT_ANSWERED();
    TEST_ASSERT_EQUAL(1, isr.count);
    COUNTED(1, checksum);
    COUNTED(1, requests);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, isr.count);
    COUNTED(1, retries);
}

static void nor_does_it_take_away_an_answer_that_is_given_once(void)
{
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_SINGLE);
    request("68 04 04 68 08 02 5D 01 69 16");
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED(ANSWER_22);
}

static void data_written_while_the_request_comes_in_are_in_the_answer(void)
{
    begin("68 04 04 68 08 02 6D");
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    end("01 78 16");
    ANSWERED(ANSWER_22);
    begin("68 04 04 68 08 02 5D");
    unit_update(FDL_SAP_NIL, "33 44", FDL_UPDATE_HIGH);
    end("01 68 16");
    ANSWERED("68 05 05 68 02 08 0A 33 44 8B 16");
}

/* An update has three locks: it looks for the SAP, exchanges rooms, makes the plan anew. */
static const char *to_come;
static uint8_t unlocks;

static void hear_at_unlock(void)
{
    if (--unlocks == 0)
        hear(to_come);
}

static void update_22_heard_meanwhile(const char *hex, uint8_t unlock)
{
    to_come = hex;
    unlocks = unlock;
    fake_at_unlock = hear_at_unlock;
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    fake_at_unlock = 0;
}

static void a_request_that_ends_while_its_reply_is_written_has_the_old_data_or_the_new_whole(void)
{
    begin("68 04 04 68 08 02 6D");
    update_22_heard_meanwhile("01 78 16", 1);
    finish_request();
    ANSWERED(ANSWER_11);
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
    begin("68 04 04 68 08 02 5D");
    update_22_heard_meanwhile("01 68 16", 2);
    finish_request();
    ANSWERED(ANSWER_22);
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED(ANSWER_22); /* kept for the retry */
    begin("");
    update_22_heard_meanwhile("68 04 04 68 08 02 7D 01 88 16", 2); /* the one awaited */
    finish_request();
    ANSWERED(ANSWER_22);
}

static void another_telegram_that_begins_while_the_reply_is_written_leaves_its_room_alone(void)
{
    request("68 04 04 68 08 02 6D 01 78 16");
    begin("");
    update_22_heard_meanwhile("68 F9 F9 68 09", 2);
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED(ANSWER_22);
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
    begin("");
    update_22_heard_meanwhile("68 05 05 68 88 82 7D", 2);
    end("0A 3E 4F 16"); /* not active: 88 + 82 + 7D + 0A + 3E = 1CF, so RS to a wrong FCS: silence */
    NOT_ANSWERED();
    request("68 05 05 68 88 82 7D 0A 3E CF 16");
    ANSWERED("10 02 08 03 0D 16");
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED(ANSWER_22);
}

static void data_written_after_the_end_are_in_the_next_answer_whole(void)
{
    uint8_t i;

    begin("68 04 04 68 08 02 6D 01 78 16");
    for (i = 0; i < 5; i++)
        unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    fake_silence(); /* T_SDR is over */
    for (i = 0; i < 5; i++)
        unit_update(FDL_SAP_NIL, "33", FDL_UPDATE_LOW);
    fake_sent();
    ANSWERED(ANSWER_11);
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED("68 04 04 68 02 08 08 33 45 16");
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED("68 04 04 68 02 08 08 33 45 16");
}

static void a_request_is_executed_when_its_answer_is_out(void)
{
    begin("68 04 04 68 08 02 6D 01 78 16");
    fake_silence();
    TEST_ASSERT_EQUAL(0, isr.count);
    fake_sent();
    TEST_ASSERT_EQUAL(1, isr.count);
}

static void a_sap_deactivated_before_the_end_is_not_active(void)
{
    begin("68 04 04 68 08 02 6D");
    fma_sap_deactivate(FDL_SAP_NIL);
    end("01 78 16");
    ANSWERED("10 02 08 03 0D 16");
    TEST_ASSERT_EQUAL(0, isr.count);
}

/* Header as before, so its plan is still there when the SAPs come: 88 + 82 + 5D + 0A + 3E + 01 = B0, 7D: D0. */
static void a_sap_deactivated_between_a_known_header_and_its_saps_is_not_active(void)
{
    unit_srd_sap(FDL_TO_ISR);
    request("68 06 06 68 88 82 5D 0A 3E 01 B0 16");
    ANSWERED("E5");
    begin("68 06 06 68 88 82 7D");
    fma_sap_deactivate(10);
    end("0A 3E 01 D0 16");
    ANSWERED("10 02 08 03 0D 16");
    TEST_ASSERT_EQUAL(1, isr.count);
}

static void a_sap_activated_before_the_end_is_active(void)
{
    begin("68 06 06 68 88 82 4D 0A 3E");
    unit_srd_sap(FDL_TO_ISR);
    end("01 A0 16");
    ANSWERED("E5");
    TEST_ASSERT_EQUAL(1, isr.count);
}

static void a_request_answered_and_not_yet_executed_goes_with_its_sap(void)
{
    begin("68 04 04 68 08 02 6D 01 78 16");
    fake_silence();
    fma_sap_deactivate(FDL_SAP_NIL);
    unit_default_sap(FDL_TO_ISR);
    fake_sent();
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(0, isr.count);
}

static void a_line_opened_anew_drops_the_request_and_its_repetition_is_new(void)
{
    begin("68 04 04 68 08 02 7D 01 88 16");
    fma_set_value(FMA_BAUD_RATE, 0);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, isr.count);
    COUNTED(0, retries);
    COUNTED(1, requests);
}

static void a_reset_drops_the_request(void)
{
    begin("68 04 04 68 08 02 7D 01 88 16");
    fma_reset(8);
    fake_silence();
    fake_sent();
    TEST_ASSERT_EQUAL(0, isr.count);
    COUNTED(0, requests);
}

static void a_disabled_transmitter_does_not_keep_a_request_from_being_executed(void)
{
    fma_set_value(FMA_TRANSMITTER, 0);
    request("68 04 04 68 08 02 6D 01 78 16");
    NOT_ANSWERED();
    TEST_ASSERT_EQUAL(1, isr.count);
}

static void headers_of_others_in_between_leave_the_retry_octet_identical(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_HIGH);
    begin("68 04 04 68 08 03 7D"); /* another master, and then silence */
    fake_silence();
    request("68 04 04 68 08 03 7D 01 00 16"); /* wrong FCS */
    request("68 04 04 68 09 03 7D 01 8A 16"); /* another slave */
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, isr.count);
}

static void masters_by_turns_are_each_answered_by_their_address(void)
{
    uint8_t i;

    for (i = 0; i < 3; i++) {
        request("68 04 04 68 08 02 7D 01 88 16");
        ANSWERED(ANSWER_11);
        request("68 04 04 68 08 03 7D 01 89 16");
        ANSWERED("68 04 04 68 03 08 08 11 24 16");
    }
}

static void box_request(const char *octet, const char *fcs)
{
    begin("68 06 06 68 88 82 4D 0A 3E");
    hear(octet);
    hear(fcs);
    end("16");
}

static void boxes_full_when_the_request_began_take_it_if_one_is_free_at_its_end(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    box_request("01", "A0");
    box_request("02", "A1");
    box_request("03", "A2");
    begin("68 06 06 68 88 82 4D 0A 3E");
    fdl_poll();
    end("04 A3 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(4, ind.count);
    box_request("05", "A4");
    ANSWERED("E5");
}

static void the_owner_set_between_two_like_requests_counts_for_the_second(void)
{
    request("68 04 04 68 08 02 4D 01 58 16");
    fdl_heard();
    fdl_watch(2);
    request("68 04 04 68 08 02 4D 01 58 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY | FDL_HEARD_OWN | FDL_HEARD_OWNER, fdl_heard());
}

static void what_was_heard_is_known_before_the_answer_is_out(void)
{
    begin("68 04 04 68 08 02 6D 01 78 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY | FDL_HEARD_OWN, fdl_heard());
    finish_request();
}

/* The header but for the FCB is that of the last request, its SAPs come by themselves. 88 + 82 + 5D + 0A + 3E + 02 = B1. */
static void the_owner_set_between_a_known_header_and_its_saps_leaves_the_data_whole(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    request("68 06 06 68 88 82 5D 0A 3E 01 B0 16");
    begin("68 06 06 68 88 82 5D");
    fdl_watch(2);
    end("0A 3E 02 B1 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(2, ind.count);
    TEST_ASSERT_EQUAL(1, ind.last.len);
    TEST_ASSERT_EQUAL_HEX8(0x02, ind.last.lsdu[0]);
}

/* Asked from SSAP 62: 246 octets do not fit beside it, a UE is planned; then there is only one. 08 + 82 + 5D + 3E + 01 = 26;
 * 82 + 08 + 08 + 3E + 22 = F2. */
static void data_that_fit_come_instead_of_those_that_did_not_until_the_end_of_the_request(void)
{
    static uint8_t XDATA lsdu[246];

    fdl_reply_update(FDL_SAP_NIL, lsdu, 246, FDL_UPDATE_LOW);
    request("68 05 05 68 08 82 6D 3E 01 36 16");
    ANSWERED("10 02 08 01 0B 16");
    begin("68 05 05 68");
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    end("08 82 5D 3E 01 26 16");
    ANSWERED("68 05 05 68 82 08 08 3E 22 F2 16");
}

static void a_new_address_before_the_telegram_awaited_leaves_it_to_the_old_one(void)
{
    request("68 04 04 68 08 02 4D 01 58 16");
    ANSWERED(ANSWER_11);
    begin("");
    fdl_set_address(9);
    end("68 04 04 68 08 02 4D 01 58 16");
    NOT_ANSWERED();
    COUNTED(1, requests);
    COUNTED(1, foreign);
    request("68 04 04 68 09 02 4D 01 59 16");
    ANSWERED("68 04 04 68 02 09 08 11 24 16");
}

static void nor_where_the_station_leaves_telegrams_of_others_at_their_address(void)
{
    fdl_listen(false);
    a_new_address_before_the_telegram_awaited_leaves_it_to_the_old_one();
}

/* What the plan of a header is kept for the next one like it for: the reply has been addressed for it. Here one reply
 * answers two SAPs, the boxes are full of requests to SAP 10 and the default SAP refuses RR. */
static void a_reply_that_could_not_be_given_is_addressed_when_it_can(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    fma_sap_deactivate(FDL_SAP_NIL);
    TEST_ASSERT_EQUAL(FMA_OK, fma_rsap_activate(FDL_SAP_NIL, FDL_ALL, 16, FDL_TO_MAIN, &reply_10));
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
    box_request("01", "A0");
    box_request("02", "A1");
    box_request("03", "A2");
    request("68 04 04 68 08 02 4D 01 58 16");
    ANSWERED("10 02 08 02 0C 16");
    fdl_poll();
    request("68 04 04 68 08 02 4D 01 58 16");
    ANSWERED(ANSWER_11);
}

/* From SSAP 62: 08 + 82 + 4D + 3E + 01 = 16; 82 + 08 + 08 + 3E + 11 = E1. */
static void nor_is_it_while_another_one_answers_in_its_place(void)
{
    unit_srd_sap(FDL_ANSWER_ONLY);
    unit_update(10, "22", FDL_UPDATE_LOW);
    isr.reply = &reply_10;
    request("68 05 05 68 08 82 4D 3E 01 16 16");
    ANSWERED("68 05 05 68 82 08 08 3E 22 F2 16");
    isr.reply = 0;
    request("68 05 05 68 08 82 4D 3E 01 16 16");
    ANSWERED("68 05 05 68 82 08 08 3E 11 E1 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_bad_fcs_after_the_decision_leaves_no_trace_but_the_counter);
    RUN_TEST(nor_does_it_take_away_an_answer_that_is_given_once);
    RUN_TEST(data_written_while_the_request_comes_in_are_in_the_answer);
    RUN_TEST(a_request_that_ends_while_its_reply_is_written_has_the_old_data_or_the_new_whole);
    RUN_TEST(another_telegram_that_begins_while_the_reply_is_written_leaves_its_room_alone);
    RUN_TEST(data_written_after_the_end_are_in_the_next_answer_whole);
    RUN_TEST(a_request_is_executed_when_its_answer_is_out);
    RUN_TEST(a_sap_deactivated_before_the_end_is_not_active);
    RUN_TEST(a_sap_deactivated_between_a_known_header_and_its_saps_is_not_active);
    RUN_TEST(a_sap_activated_before_the_end_is_active);
    RUN_TEST(a_request_answered_and_not_yet_executed_goes_with_its_sap);
    RUN_TEST(a_line_opened_anew_drops_the_request_and_its_repetition_is_new);
    RUN_TEST(a_reset_drops_the_request);
    RUN_TEST(a_disabled_transmitter_does_not_keep_a_request_from_being_executed);
    RUN_TEST(headers_of_others_in_between_leave_the_retry_octet_identical);
    RUN_TEST(masters_by_turns_are_each_answered_by_their_address);
    RUN_TEST(boxes_full_when_the_request_began_take_it_if_one_is_free_at_its_end);
    RUN_TEST(the_owner_set_between_two_like_requests_counts_for_the_second);
    RUN_TEST(what_was_heard_is_known_before_the_answer_is_out);
    RUN_TEST(the_owner_set_between_a_known_header_and_its_saps_leaves_the_data_whole);
    RUN_TEST(data_that_fit_come_instead_of_those_that_did_not_until_the_end_of_the_request);
    RUN_TEST(a_new_address_before_the_telegram_awaited_leaves_it_to_the_old_one);
    RUN_TEST(nor_where_the_station_leaves_telegrams_of_others_at_their_address);
    RUN_TEST(a_reply_that_could_not_be_given_is_addressed_when_it_can);
    RUN_TEST(nor_is_it_while_another_one_answers_in_its_place);
    return UNITY_END();
}
