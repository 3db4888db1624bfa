/* Retries: a request repeated by its master is answered again and not executed again.
 * Clauses: EN 50170-2 part 4, 4.7.4 (FCB, FCV), part 3 ("the indication primitive shall not be repeated"); facts 3.3 and
 * section 0: a frame is a retry only if it has FCV, the same SA, the same FCB and the same octets.
 * FC of SRD high: 6D FCB 1 FCV 0 (first), 5D FCB 0 FCV 1, 7D FCB 1 FCV 1, 4D not numbered. */
#include "fdl_unit.h"

void setUp(void)
{
    unit_begin();
    unit_default_sap(FDL_TO_MAIN);
    unit_update(FDL_SAP_NIL, "11", FDL_UPDATE_LOW);
}

void tearDown(void)
{
    fake_end();
}

#define ANSWER_11 "68 04 04 68 02 08 08 11 23 16"
#define ANSWER_22 "68 04 04 68 02 08 08 22 34 16"

/* Indications since the last call. */
static uint8_t executed(void)
{
    uint8_t n;

    fdl_poll();
    n = ind.count;
    ind.count = 0;
    return n;
}

static void alternating_frames_are_each_executed(void)
{
    request("68 04 04 68 08 02 6D 01 78 16");
    request("68 04 04 68 08 02 5D 01 68 16");
    request("68 04 04 68 08 02 7D 01 88 16");
    TEST_ASSERT_EQUAL(3, executed());
    request("68 04 04 68 08 02 5D 01 68 16");
    TEST_ASSERT_EQUAL(1, executed());
    COUNTED(0, retries);
}

static void a_repeated_frame_is_answered_from_what_was_sent_and_not_executed(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, executed());
    COUNTED(2, retries);
    COUNTED(3, answers);
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED(ANSWER_22);
    TEST_ASSERT_EQUAL(1, executed());
}

static void repeated_first_frames_and_unnumbered_ones_are_executed_each_time(void)
{
    request("68 04 04 68 08 02 6D 01 78 16");
    request("68 04 04 68 08 02 6D 01 78 16");
    TEST_ASSERT_EQUAL(2, executed());
    request("68 04 04 68 08 02 4D 01 58 16");
    request("68 04 04 68 08 02 4D 01 58 16");
    TEST_ASSERT_EQUAL(2, executed());
    COUNTED(0, retries);
}

static void the_very_first_frame_may_be_numbered(void)
{
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, executed());
}

static void the_same_fcb_with_other_data_is_a_new_request(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    request("68 04 04 68 08 02 7D 02 89 16");
    TEST_ASSERT_EQUAL(2, executed());
    OCTETS("02", ind.lsdu, 1);
}

static void the_same_fcb_with_more_data_is_a_new_request(void)
{
    request("68 05 05 68 08 02 7D 01 00 88 16");
    request("68 04 04 68 08 02 7D 01 88 16");
    request("10 08 02 7D 87 16");
    TEST_ASSERT_EQUAL(3, executed());
}

static void the_same_fcb_to_another_sap_is_a_new_request(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    fma_rsap_activate(11, FDL_ALL, 16, FDL_TO_MAIN, 0);
    request("68 06 06 68 88 82 7D 0A 3E 02 D1 16");
    request("68 06 06 68 88 82 7D 0B 3E 01 D1 16"); /* same length, same FCS */
    TEST_ASSERT_EQUAL(2, executed());
}

static void the_same_frame_in_another_priority_is_a_new_request(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    request("68 04 04 68 08 02 7C 02 88 16");
    TEST_ASSERT_EQUAL(2, executed());
}

static void the_same_frame_from_another_master_is_a_new_request(void)
{
    request("68 04 04 68 08 02 7D 02 89 16");
    request("68 04 04 68 08 03 7D 01 89 16");
    TEST_ASSERT_EQUAL(2, executed());
    COUNTED(0, retries);
}

/* One request is remembered, whoever sent it. */
static void a_request_of_another_master_in_between_makes_the_repeated_frame_new(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    request("68 04 04 68 08 03 7D 01 89 16");
    request("68 04 04 68 08 02 7D 01 88 16");
    TEST_ASSERT_EQUAL(3, executed());
}

static void what_is_not_numbered_in_between_leaves_the_retry_a_retry(void)
{
    fma_sap_activate(58, FDL_ALL, FDL_SDN, 2, FDL_ANSWER_ONLY);
    request("68 04 04 68 08 02 7D 01 88 16");
    request("10 08 02 49 53 16");                         /* FDL status            */
    request("10 08 02 4E 58 16");                         /* Ident                 */
    request("10 08 02 4F 59 16");                         /* LSAP status           */
    request("68 05 05 68 88 82 4F 0A 3E A1 16");          /* refused: RS           */
    request("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16");    /* Global_Control        */
    request("68 04 04 68 09 03 7D 01 8A 16");             /* for another station   */
    request("10 08 02 49 54 16");                         /* wrong FCS             */
    request("DC 02 03");
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, executed());
    COUNTED(1, retries);
}

static void a_refusal_is_repeated_too(void)
{
    request("68 05 05 68 88 82 7D 3D 3E 02 16");
    ANSWERED("10 02 08 03 0D 16");
    fma_rsap_activate(61, FDL_ALL, 16, FDL_TO_MAIN, 0);
    request("10 08 02 49 53 16");
    request("68 05 05 68 88 82 7D 3D 3E 02 16");
    ANSWERED("10 02 08 03 0D 16");
    TEST_ASSERT_EQUAL(0, executed());
    COUNTED(1, refused);
    request("68 05 05 68 88 82 5D 3D 3E E2 16");
    ANSWERED("E5");
}

static void an_acknowledged_sda_is_repeated_too(void)
{
    fma_sap_activate(20, FDL_ALL, FDL_SDA, 4, FDL_TO_MAIN);
    request("68 06 06 68 88 82 73 14 3E 01 D0 16");
    ANSWERED("E5");
    request("68 06 06 68 88 82 73 14 3E 01 D0 16");
    ANSWERED("E5");
    TEST_ASSERT_EQUAL(1, executed());
}

static void a_single_answer_is_repeated_though_its_buffer_is_empty(void)
{
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_SINGLE);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_22);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_22);
    request("68 04 04 68 08 02 5D 01 68 16");
    ANSWERED("E5");
}

static void an_answer_that_was_cancelled_is_sent_at_the_retry(void)
{
    fake_silence();
    hear("68 04 04 68 08 02 7D 01 88 16");
    hear("00");
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, executed());
}

static void a_request_refused_for_want_of_a_box_is_executed_when_it_comes_with_the_next_fcb(void)
{
    request("68 04 04 68 08 02 6D 01 78 16");
    request("68 04 04 68 08 02 6D 02 79 16");
    request("68 04 04 68 08 02 6D 03 7A 16");
    request("68 04 04 68 08 02 5D 04 6B 16");
    ANSWERED("10 02 08 02 0C 16");
    TEST_ASSERT_EQUAL(3, executed());
    request("68 04 04 68 08 02 5D 04 6B 16");
    ANSWERED("10 02 08 02 0C 16");
    request("68 04 04 68 08 02 7D 04 8B 16");
    ANSWERED(ANSWER_11);
    TEST_ASSERT_EQUAL(1, executed());
}

/* Freeze takes newer inputs into the room of the next answer; updates after it may write over the old one. The retry is
 * then answered with the newer data, as ASICs do (facts 3.3), and never with half of each. */
static void a_retry_whose_answer_was_given_up_meanwhile_gets_a_whole_newer_one(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_11);
    unit_update(FDL_SAP_NIL, "22", FDL_UPDATE_LOW);
    fdl_reply_release_isr(&reply_nil);
    unit_update(FDL_SAP_NIL, "33", FDL_UPDATE_LOW);
    unit_update(FDL_SAP_NIL, "44", FDL_UPDATE_LOW);
    reply_nil.is |= FDL_HOLD;
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_22);
    request("68 04 04 68 08 02 7D 01 88 16");
    ANSWERED(ANSWER_22);
    TEST_ASSERT_EQUAL(1, executed());
}

static void a_new_address_or_a_reset_starts_without_memory(void)
{
    request("68 04 04 68 08 02 7D 01 88 16");
    fma_set_value(FMA_TS, 8);
    request("68 04 04 68 08 02 7D 01 88 16");
    TEST_ASSERT_EQUAL(2, executed());
    fdl_reset(8);
    unit_default_sap(FDL_TO_MAIN);
    request("68 04 04 68 08 02 7D 01 88 16");
    TEST_ASSERT_EQUAL(1, executed());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(alternating_frames_are_each_executed);
    RUN_TEST(a_repeated_frame_is_answered_from_what_was_sent_and_not_executed);
    RUN_TEST(repeated_first_frames_and_unnumbered_ones_are_executed_each_time);
    RUN_TEST(the_very_first_frame_may_be_numbered);
    RUN_TEST(the_same_fcb_with_other_data_is_a_new_request);
    RUN_TEST(the_same_fcb_with_more_data_is_a_new_request);
    RUN_TEST(the_same_fcb_to_another_sap_is_a_new_request);
    RUN_TEST(the_same_frame_in_another_priority_is_a_new_request);
    RUN_TEST(the_same_frame_from_another_master_is_a_new_request);
    RUN_TEST(a_request_of_another_master_in_between_makes_the_repeated_frame_new);
    RUN_TEST(what_is_not_numbered_in_between_leaves_the_retry_a_retry);
    RUN_TEST(a_refusal_is_repeated_too);
    RUN_TEST(an_acknowledged_sda_is_repeated_too);
    RUN_TEST(a_single_answer_is_repeated_though_its_buffer_is_empty);
    RUN_TEST(an_answer_that_was_cancelled_is_sent_at_the_retry);
    RUN_TEST(a_request_refused_for_want_of_a_box_is_executed_when_it_comes_with_the_next_fcb);
    RUN_TEST(a_retry_whose_answer_was_given_up_meanwhile_gets_a_whole_newer_one);
    RUN_TEST(a_new_address_or_a_reset_starts_without_memory);
    return UNITY_END();
}
