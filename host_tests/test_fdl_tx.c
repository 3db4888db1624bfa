/* Answers: the frames built around what stands in an update buffer, and how its three rooms turn.
 * Clauses: EN 50170-2 part 4, 4.7.1 (formats), 4.7.4 (FC of an answer: 0, station type 00, function); spec A3, A4.
 * Station 8 answers station 2. */
#include "fdl_unit.h"

static uint8_t XDATA rooms[3][FDL_ROOM(246)];
static struct fdl_reply PAGED reply;
static uint8_t XDATA lsdu[246];

static uint8_t dsap, ssap;
static bool by_sd3;

static void asked_with_saps(uint8_t d, uint8_t s)
{
    dsap = d;
    ssap = s;
}

void setUp(void)
{
    unit_begin();
    fdl_reply_init(&reply, rooms[0], 246, FDL_SAP_NIL);
    fma_rsap_activate(FDL_SAP_NIL, FDL_ALL, 246, FDL_ANSWER_ONLY, &reply);
    fma_rsap_activate(59, FDL_ALL, 246, FDL_ANSWER_ONLY, &reply);
    fma_rsap_activate(60, FDL_ALL, 246, FDL_ANSWER_ONLY, &reply);
    asked_with_saps(FDL_SAP_NIL, FDL_SAP_NIL);
    by_sd3 = false;
}

void tearDown(void)
{
    fake_end();
}

static void write(const char *hex, uint8_t how)
{
    fdl_reply_write(&reply, lsdu, from_hex(lsdu, hex), how);
}

static uint8_t check;

static void say(uint8_t octet)
{
    fake_octet(octet, 0);
    check = (uint8_t)(check + octet);
}

/* SRD high from station 2, not numbered, without data; as SD3 with as many zeros as there is room for. */
static void ask(void)
{
    const uint8_t saps = (uint8_t)((dsap != FDL_SAP_NIL) + (ssap != FDL_SAP_NIL));
    uint8_t i;

    fake.sent_len = 0;
    fake_silence();
    if (by_sd3) {
        say(0xA2);
    } else if (saps == 0) {
        say(0x10);
    } else {
        say(0x68);
        say((uint8_t)(3 + saps));
        say((uint8_t)(3 + saps));
        say(0x68);
    }
    check = 0;
    say(dsap == FDL_SAP_NIL ? 0x08 : 0x88);
    say(ssap == FDL_SAP_NIL ? 0x02 : 0x82);
    say(0x4D);
    if (dsap != FDL_SAP_NIL)
        say(dsap);
    if (ssap != FDL_SAP_NIL)
        say(ssap);
    for (i = saps; by_sd3 && i < 8; i++)
        say(0);
    say(check);
    say(0x16);
    finish_request();
}

/* The next answer. */
#define ANSWER(hex)                                                                                             \
    do {                                                                                                        \
        ask();                                                                                                  \
        ANSWERED(hex);                                                                                          \
    } while (0)

/* ---- frames ---- */

static void a_refusal_is_an_sd1_with_its_function(void)
{
    asked_with_saps(61, 62);
    ANSWER("10 02 08 03 0D 16"); /* 02 + 08 + 03 = 0D; facts 3.5 */
}

static void a_status_answer_leaves_the_refusal_kept_for_a_retry_alone(void)
{
    request("68 05 05 68 88 82 7D 3D 3E 02 16");
    ANSWERED("10 02 08 03 0D 16");
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
    request("68 05 05 68 88 82 7D 3D 3E 02 16");
    ANSWERED("10 02 08 03 0D 16");
}

static void data_without_saps_go_out_as_sd2(void)
{
    write("BD DB", FDL_UPDATE_LOW);
    ANSWER("68 05 05 68 02 08 08 BD DB AA 16"); /* facts 2.1 */
}

static void saps_come_back_mirrored_between_fc_and_data(void)
{
    asked_with_saps(60, 62);
    write("02 05 00 FF 42 24", FDL_UPDATE_LOW);
    ANSWER("68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 42 24 F8 16"); /* facts 2.1 */
}

static void one_sap_alone_extends_one_address_alone(void)
{
    write("AA", FDL_UPDATE_LOW);
    asked_with_saps(60, FDL_SAP_NIL);
    ANSWER("68 05 05 68 02 88 08 3C AA 78 16");
    asked_with_saps(FDL_SAP_NIL, 62);
    ANSWER("68 05 05 68 82 08 08 3E AA 7A 16");
}

/* The frame that stands there is for another header: once as it was left by the last answer, once written by main after it. */
static void each_answer_has_the_saps_of_its_request(void)
{
    uint8_t round;

    for (round = 0; round < 2; round++) {
        write("AA", FDL_UPDATE_LOW);
        asked_with_saps(60, 62);
        ANSWER("68 06 06 68 82 88 08 3E 3C AA 36 16"); /* 82 + 88 + 08 + 3E + 3C + AA = 236 */
        if (round)
            write("AA", FDL_UPDATE_LOW);
        asked_with_saps(FDL_SAP_NIL, FDL_SAP_NIL);
        ANSWER("68 04 04 68 02 08 08 AA BC 16");
        if (round)
            write("AA", FDL_UPDATE_LOW);
        asked_with_saps(60, FDL_SAP_NIL);
        ANSWER("68 05 05 68 02 88 08 3C AA 78 16");
        if (round)
            write("AA", FDL_UPDATE_LOW);
        asked_with_saps(FDL_SAP_NIL, 62);
        ANSWER("68 05 05 68 82 08 08 3E AA 7A 16");
        if (round)
            write("AA", FDL_UPDATE_LOW);
        asked_with_saps(FDL_SAP_NIL, 61);
        ANSWER("68 05 05 68 82 08 08 3D AA 79 16");
        asked_with_saps(59, 62);
        ANSWER("68 06 06 68 82 88 08 3E 3B AA 35 16");
        asked_with_saps(59, 61);
        ANSWER("68 06 06 68 82 88 08 3D 3B AA 34 16");
    }
}

static void high_priority_data_say_diagnosis_pending(void)
{
    write("BD DB", FDL_UPDATE_HIGH);
    ANSWER("68 05 05 68 02 08 0A BD DB AC 16"); /* facts 2.1 */
}

static void eight_octets_answer_an_sd3_as_sd3_and_an_sd2_as_sd2(void)
{
    write("01 02 03 04 05 06 07 08", FDL_UPDATE_LOW);
    ANSWER("68 0B 0B 68 02 08 08 01 02 03 04 05 06 07 08 36 16");
    by_sd3 = true;
    ANSWER("A2 02 08 08 01 02 03 04 05 06 07 08 36 16");
}

static void saps_count_among_the_eight_octets_of_sd3(void)
{
    by_sd3 = true;
    asked_with_saps(59, 62);
    write("01 02 03 04 05 06", FDL_UPDATE_LOW);
    ANSWER("A2 82 88 08 3E 3B 01 02 03 04 05 06 A0 16");
    write("01 02 03 04 05 06 07 08", FDL_UPDATE_LOW);
    ANSWER("68 0D 0D 68 82 88 08 3E 3B 01 02 03 04 05 06 07 08 AF 16");
}

static void no_data_is_a_short_acknowledge(void)
{
    ANSWER("E5"); /* never written */
    write("", FDL_UPDATE_LOW);
    ANSWER("E5");
}

static void no_data_with_diagnosis_pending_is_an_sd1(void)
{
    write("", FDL_UPDATE_HIGH);
    ANSWER("10 02 08 0A 14 16"); /* facts 3.9 */
}

static void priority_without_a_valid_buffer_is_a_short_acknowledge(void)
{
    reply.is = FDL_HIGH;
    ANSWER("E5");
}

static void fill(uint8_t octet)
{
    uint8_t i;

    for (i = 0; i < 246; i++)
        lsdu[i] = octet;
}

static void the_longest_answer_has_246_octets_of_data_and_255_in_all(void)
{
    fill(1);
    fdl_reply_write(&reply, lsdu, 246, FDL_UPDATE_LOW);
    ask();
    TEST_ASSERT_EQUAL(255, fake.sent_len);
    OCTETS("68 F9 F9 68 02 08 08 01", fake.sent, 8);
    OCTETS("01 08 16", fake.sent + 252, 3); /* 02 + 08 + 08 + 246 = 108H */
}

static void with_two_saps_the_longest_answer_has_244_octets(void)
{
    fill(1);
    asked_with_saps(60, 62);
    fdl_reply_write(&reply, lsdu, 244, FDL_UPDATE_LOW);
    ask();
    TEST_ASSERT_EQUAL(255, fake.sent_len);
    OCTETS("68 F9 F9 68 82 88 08 3E 3C 01", fake.sent, 10);
    OCTETS("01 80 16", fake.sent + 252, 3); /* 82 + 88 + 08 + 3E + 3C + F4 = 280H */
}

static void data_that_do_not_fit_beside_the_saps_are_a_user_error(void)
{
    asked_with_saps(60, 62);
    fdl_reply_write(&reply, lsdu, 245, FDL_UPDATE_LOW);
    ANSWER("10 02 08 01 0B 16");
    fdl_reply_write(&reply, lsdu, 246, FDL_UPDATE_LOW);
    ANSWER("10 02 08 01 0B 16");
    COUNTED(2, refused);
}

/* ---- rooms ---- */

static void rooms_are_a_permutation(void)
{
    TEST_ASSERT_EQUAL(3, (reply.sent - reply.rooms) + (reply.ready - reply.rooms) + (reply.spare - reply.rooms));
    TEST_ASSERT_NOT_EQUAL(reply.sent, reply.ready);
    TEST_ASSERT_NOT_EQUAL(reply.sent, reply.spare);
    TEST_ASSERT_NOT_EQUAL(reply.ready, reply.spare);
}

static void the_newest_update_is_sent_and_sent_again_until_there_is_a_newer_one(void)
{
    write("01", FDL_UPDATE_LOW);
    write("02", FDL_UPDATE_LOW);
    rooms_are_a_permutation();
    ANSWER("68 04 04 68 02 08 08 02 14 16");
    ANSWER("68 04 04 68 02 08 08 02 14 16");
    write("03", FDL_UPDATE_LOW);
    rooms_are_a_permutation();
    ANSWER("68 04 04 68 02 08 08 03 15 16");
    rooms_are_a_permutation();
}

/* A retry is answered from the same room: no update may touch it, nor a change of priority. */
static void an_answer_once_sent_stands_unchanged_under_any_number_of_updates(void)
{
    write("01 02", FDL_UPDATE_LOW);
    request("10 08 02 7D 87 16");
    write("03 04", FDL_UPDATE_LOW);
    write("05 06", FDL_UPDATE_HIGH);
    write("07 08", FDL_UPDATE_LOW);
    request("10 08 02 7D 87 16");
    ANSWERED("68 05 05 68 02 08 08 01 02 15 16");
}

static void a_single_update_is_gone_once_it_is_sent(void)
{
    write("01", FDL_UPDATE_SINGLE);
    ANSWER("68 04 04 68 02 08 08 01 13 16");
    ANSWER("E5");
    write("", FDL_UPDATE_SINGLE | FDL_UPDATE_HIGH);
    ANSWER("10 02 08 0A 14 16");
    ANSWER("E5");
    write("02", FDL_UPDATE_LOW);
    ANSWER("68 04 04 68 02 08 08 02 14 16");
    ANSWER("68 04 04 68 02 08 08 02 14 16");
}

static void an_update_may_keep_the_priority_as_it_is(void)
{
    write("01", FDL_UPDATE_HIGH);
    write("02", FDL_UPDATE_KEEP);
    ANSWER("68 04 04 68 02 08 0A 02 16 16");
    write("03", FDL_UPDATE_LOW);
    write("04", FDL_UPDATE_KEEP);
    ANSWER("68 04 04 68 02 08 08 04 16 16");
}

static void under_hold_the_answer_stays_until_it_is_released(void)
{
    write("01", FDL_UPDATE_LOW);
    ANSWER("68 04 04 68 02 08 08 01 13 16");
    reply.is |= FDL_HOLD;
    write("02", FDL_UPDATE_LOW);
    ANSWER("68 04 04 68 02 08 08 01 13 16");
    fdl_reply_release_isr(&reply);
    ANSWER("68 04 04 68 02 08 08 02 14 16");
    fdl_reply_release_isr(&reply); /* nothing newer */
    ANSWER("68 04 04 68 02 08 08 02 14 16");
    write("03", FDL_UPDATE_LOW);
    reply.is &= (uint8_t)~FDL_HOLD;
    ANSWER("68 04 04 68 02 08 08 03 15 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_refusal_is_an_sd1_with_its_function);
    RUN_TEST(a_status_answer_leaves_the_refusal_kept_for_a_retry_alone);
    RUN_TEST(data_without_saps_go_out_as_sd2);
    RUN_TEST(saps_come_back_mirrored_between_fc_and_data);
    RUN_TEST(one_sap_alone_extends_one_address_alone);
    RUN_TEST(each_answer_has_the_saps_of_its_request);
    RUN_TEST(high_priority_data_say_diagnosis_pending);
    RUN_TEST(eight_octets_answer_an_sd3_as_sd3_and_an_sd2_as_sd2);
    RUN_TEST(saps_count_among_the_eight_octets_of_sd3);
    RUN_TEST(no_data_is_a_short_acknowledge);
    RUN_TEST(no_data_with_diagnosis_pending_is_an_sd1);
    RUN_TEST(priority_without_a_valid_buffer_is_a_short_acknowledge);
    RUN_TEST(the_longest_answer_has_246_octets_of_data_and_255_in_all);
    RUN_TEST(with_two_saps_the_longest_answer_has_244_octets);
    RUN_TEST(data_that_do_not_fit_beside_the_saps_are_a_user_error);
    RUN_TEST(the_newest_update_is_sent_and_sent_again_until_there_is_a_newer_one);
    RUN_TEST(an_answer_once_sent_stands_unchanged_under_any_number_of_updates);
    RUN_TEST(a_single_update_is_gone_once_it_is_sent);
    RUN_TEST(an_update_may_keep_the_priority_as_it_is);
    RUN_TEST(under_hold_the_answer_stays_until_it_is_released);
    return UNITY_END();
}
