/* The secondary, row by row (facts 2.3). The station's address is 5.
 * Octets are worked out from ISO 13239 5.3: I = NR<<5 | P<<4 | NS<<1; RR 01, RNR 05, REJ 09; SNRM 83, DISC 43,
 * UA 63, DM 0F, FRMR 87, XID AF, TEST E3, UI 03; P/F 10H. */
#include "hdlc/hdlc_nrm.h"
#include "hdlc_peer.h"
#include "unity.h"

#include <string.h>

static uint8_t delivered[16][HDLC_INFO_MAX];
static uint8_t delivered_n[16];
static unsigned deliveries, uis, states;
static uint8_t last_state;
static bool mute; /* the application answers I-frames with nothing */

/* The application answers with what it got, first octet + 80H. */
uint8_t hdlc_info_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer)
{
    memcpy(delivered[deliveries % 16], info, n);
    delivered_n[deliveries++ % 16] = n;
    if (mute || n == 0)
        return 0;
    memcpy(answer, info, n);
    answer[0] |= 0x80u;
    return n;
}

uint8_t hdlc_document_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer)
{
    if (n < 2)
        return 0;
    answer[0] = info[0];
    answer[1] = info[1];
    answer[2] = 0x31;
    return 3;
}

void hdlc_ui_ind(const uint8_t XDATA *info, uint8_t n)
{
    (void)info;
    (void)n;
    uis++;
}

uint8_t hdlc_xid_ind(uint8_t XDATA *answer)
{
    answer[0] = 0x42;
    return 1;
}

void hdlc_state_ind(uint8_t state)
{
    states++;
    last_state = state;
}

static void init(void)
{
    TEST_ASSERT_TRUE(hdlc_nrm_init(5, 0xFF, 0));
}

void setUp(void)
{
    deliveries = uis = states = 0;
    mute = false;
    peer_begin(init, hdlc_nrm_poll);
}

void tearDown(void)
{
    peer_end();
}

static void connect(void)
{
    ANSWERS("05 93", "05 73");
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
}

/* ---- NDM ---------------------------------------------------------------------------------------------- */

static void test_ndm_snrm_is_answered_ua_and_connects(void)
{
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    connect();
    TEST_ASSERT_EQUAL(1, states);
    TEST_ASSERT_EQUAL(HDLC_NRM, last_state);
}

static void test_ndm_any_other_command_with_p_is_answered_dm(void)
{
    ANSWERS("05 53", "05 1F"); /* DISC */
    ANSWERS("05 11", "05 1F"); /* RR */
    ANSWERS("05 15", "05 1F"); /* RNR */
    ANSWERS("05 19", "05 1F"); /* REJ */
    ANSWERS("05 10 01 03", "05 1F"); /* I */
    ANSWERS("05 13 01", "05 1F"); /* UI */
    ANSWERS("05 F3 55", "05 1F"); /* TEST */
    ANSWERS("05 BF", "05 1F"); /* XID */
    ANSWERS("05 DF", "05 1F"); /* SNRME */
    ANSWERS("05 93 00", "05 1F"); /* SNRM with information is no SNRM */
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL(0, deliveries);
}

static void test_ndm_commands_without_p_are_ignored(void)
{
    SILENT("05 83");
    SILENT("05 43");
    SILENT("05 01");
    SILENT("05 00 01 03");
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
}

static void test_ndm_document_mode_08_is_answered_09(void)
{
    ANSWERS("05 08 01 03", "05 09 01 03 31");
    TEST_ASSERT_EQUAL(0, deliveries);
    SILENT("05 08 01"); /* the application refuses it */
    TEST_ASSERT_EQUAL(1, hdlc_nrm_counters.unanswered);
}

/* ---- NRM ---------------------------------------------------------------------------------------------- */

static void test_nrm_snrm_resets_the_numbers_and_drops_the_stored_frame(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    connect();
    ANSWERS("05 11", "05 11"); /* RR 0: V(R) 0, nothing to repeat */
    ANSWERS("05 10 02", "05 30 82");
    TEST_ASSERT_EQUAL(1, states);
}

static void test_nrm_disc_is_answered_ua_and_disconnects(void)
{
    connect();
    ANSWERS("05 53", "05 73");
    TEST_ASSERT_EQUAL(HDLC_NDM, last_state);
    ANSWERS("05 11", "05 1F");
}

static void test_nrm_mode_setting_without_p_is_ignored(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    SILENT("05 83");
    SILENT("05 43");
    ANSWERS("05 31", "05 31");
}

static void test_nrm_i_in_sequence_is_delivered_and_answered_i(void)
{
    connect();
    ANSWERS("05 10 01 03", "05 30 81 03"); /* I 0/0 -> I 0/1 */
    ANSWERS("05 32 01 04", "05 52 81 04"); /* I 1/1 -> I 1/2 */
    TEST_ASSERT_EQUAL(2, deliveries);
    TEST_ASSERT_EQUAL_HEX8_ARRAY("\x01\x03", delivered[0], 2);
    TEST_ASSERT_EQUAL_HEX8_ARRAY("\x01\x04", delivered[1], 2);
}

static void test_nrm_i_without_an_answer_is_answered_rr(void)
{
    connect();
    mute = true;
    ANSWERS("05 10 01", "05 31"); /* RR 1 */
    ANSWERS("05 12", "05 51"); /* an empty information field is legal, too: RR 2 */
    TEST_ASSERT_EQUAL(2, deliveries);
}

static void test_nrm_i_without_p_waits_for_the_poll(void)
{
    connect();
    SILENT("05 00 01");
    TEST_ASSERT_EQUAL(1, deliveries);
    ANSWERS("05 11", "05 30 81"); /* I 0/1 */
}

static void test_nrm_numbers_wrap_at_eight(void)
{
    connect();
    for (uint8_t k = 0; k < 20; k++) {
        const uint8_t n = k & 7u, next = (k + 1u) & 7u;
        const uint8_t command[] = {0x05, (uint8_t)(n << 5 | 0x10 | n << 1), k};
        TEST_ASSERT_TRUE(peer_ask(command, sizeof command));
        TEST_ASSERT_EQUAL_HEX8(next << 5 | 0x10 | n << 1, peer.answer[1]);
        TEST_ASSERT_EQUAL_HEX8(k | 0x80, peer.answer[2]);
    }
    TEST_ASSERT_EQUAL(20, deliveries);
}

static void test_nrm_busy_i_is_not_accepted_and_answered_rnr(void)
{
    connect();
    hdlc_nrm_busy(true);
    ANSWERS("05 10 01", "05 15"); /* RNR 0 */
    ANSWERS("05 11", "05 15");
    ANSWERS("05 12 01", "05 15"); /* out of sequence: RNR tells it, too */
    TEST_ASSERT_EQUAL(0, deliveries);
    hdlc_nrm_busy(false);
    ANSWERS("05 11", "05 11"); /* ready again: RR */
    ANSWERS("05 10 01", "05 30 81");
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_nrm_i_out_of_sequence_is_answered_rej_once(void)
{
    connect();
    ANSWERS("05 12 01", "05 19"); /* N(S) 1, 0 expected: REJ 0 */
    ANSWERS("05 12 01", "05 11"); /* a second REJ must not be outstanding: RR 0 */
    TEST_ASSERT_EQUAL(0, deliveries);
    ANSWERS("05 10 01", "05 30 81"); /* the right one clears it */
    ANSWERS("05 36 01", "05 39"); /* N(S) 3, 1 expected, N(R) 1 acknowledges: REJ 1 */
    SILENT("05 26 01"); /* without P: nothing */
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_nrm_duplicate_i_gets_the_stored_answer_again(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 10 01", "05 30 81"); /* lost answer: the same I again, the same answer */
    ANSWERS("05 10 01", "05 30 81");
    TEST_ASSERT_EQUAL(1, deliveries);
    TEST_ASSERT_EQUAL(2, hdlc_nrm_counters.resent);
}

static void test_nrm_duplicate_i_with_nothing_stored_is_answered_rr(void)
{
    connect();
    mute = true;
    ANSWERS("05 10 01", "05 31");
    ANSWERS("05 10 01", "05 31"); /* TIWAY B-15: RR again */
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_nrm_rr_acknowledges(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 31", "05 31"); /* RR 1 acknowledges I 0: nothing more, RR 1 */
}

static void test_nrm_rr_that_does_not_acknowledge_gets_the_stored_i(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 11", "05 30 81"); /* RR 0 */
    ANSWERS("05 12 02", "05 50 81"); /* I 1 with N(R) 0: accepted, but I 0 again, now with N(R) 2 */
    ANSWERS("05 51 00", "05 97 51 42 03"); /* S-frame with information: FRMR W, X */
    TEST_ASSERT_EQUAL(2, deliveries);
}

static void test_nrm_i_that_does_not_acknowledge_is_kept_behind_the_stored_one(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 12 02", "05 50 81"); /* first slot again */
    ANSWERS("05 14 03", "05 50 81"); /* no slot left: not accepted, V(R) stays 2 */
    TEST_ASSERT_EQUAL(2, deliveries);
    ANSWERS("05 31", "05 52 82"); /* RR 1: I 1 now */
    ANSWERS("05 54 03", "05 74 83"); /* I 2 with N(R) 2: accepted */
    TEST_ASSERT_EQUAL(3, deliveries);
}

static void test_nrm_rnr_stops_our_i(void)
{
    connect();
    SILENT("05 00 01");
    ANSWERS("05 15", "05 31"); /* RNR 0 -> RR 1 though an I waits */
    ANSWERS("05 11", "05 30 81"); /* RR 0 ends it */
    ANSWERS("05 35", "05 31");
    connect(); /* so does SNRM */
    ANSWERS("05 10 02", "05 30 82");
}

static void test_nrm_rej_gets_the_frame_again(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 19", "05 30 81"); /* REJ 0 */
    ANSWERS("05 39", "05 31"); /* REJ 1: nothing from 1 on, RR */
    ANSWERS("05 35", "05 31"); /* RNR 1 */
    ANSWERS("05 39", "05 31"); /* REJ ends the primary's busy condition, too */
}

static void test_nrm_ui_test_xid(void)
{
    connect();
    SILENT("05 03 01");
    ANSWERS("05 13 01", "05 11"); /* UI P: RR 0 */
    TEST_ASSERT_EQUAL(2, uis);
    ANSWERS("05 F3 55 AA", "05 F3 55 AA"); /* TEST P: the same back */
    ANSWERS("05 F3", "05 F3");
    SILENT("05 E3 55");
    ANSWERS("05 BF", "05 BF 42"); /* XID P: the application's identification */
    SILENT("05 AF");
}

static void test_nrm_08_is_an_ordinary_i_frame(void)
{
    connect();
    SILENT("05 08 01 03"); /* I N(S) 4 N(R) 0 P 0: out of sequence */
    TEST_ASSERT_EQUAL(0, deliveries);
}

/* ---- frame reject ----------------------------------------------------------------------------------------- */

static void test_frmr_undefined_command(void)
{
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 1D", "05 97 1D 22 01"); /* SREJ: V(R) 1, V(S) 1, W */
    TEST_ASSERT_EQUAL(HDLC_FRJ, hdlc_nrm_state());
}

static void test_frmr_for_each_command_we_do_not_have(void)
{
    static const uint8_t codes[] = {0x1D, 0xDF, 0x73, 0x1F, 0x97, 0x33, 0x17, 0x9F, 0x7F, 0x5F};
    for (unsigned i = 0; i < sizeof codes; i++) { /* SREJ SNRME UA DM FRMR UP SIM RSET SABME ?? */
        const uint8_t command[] = {0x05, codes[i]}, frmr[] = {0x05, 0x97, codes[i], 0x00, 0x01};
        connect();
        TEST_ASSERT_TRUE(peer_ask(command, sizeof command));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(frmr, peer.answer, sizeof frmr);
    }
}

static void test_frmr_information_where_none_is_allowed(void)
{
    connect();
    ANSWERS("05 11 00", "05 97 11 00 03"); /* W and X */
    ANSWERS("05 93", "05 73");
    ANSWERS("05 53 00", "05 97 53 00 03"); /* DISC with information */
    ANSWERS("05 93 00", "05 97 53 00 03"); /* SNRM with information: FRMR repeated */
}

static void long_frame(uint8_t control, unsigned info)
{
    static uint8_t octets[PEER_OCTETS];
    octets[0] = 0x05;
    octets[1] = control;
    peer_ask(octets, 2 + info);
}

static void test_frmr_information_too_long(void)
{
    connect();
    long_frame(0x10, HDLC_INFO_MAX); /* just fits: 64 octets, I 0/1 of 64 octets back */
    TEST_ASSERT_EQUAL_HEX8(0x30, peer.answer[1]);
    TEST_ASSERT_EQUAL(2 + HDLC_INFO_MAX, peer.answer_n);
    long_frame(0x32, HDLC_INFO_MAX + 1);
    ANSWER_IS("05 97 32 22 04"); /* Y */
    connect();
    long_frame(0xF3, 260); /* longer than eight bits can count */
    ANSWER_IS("05 97 F3 00 04");
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_frmr_invalid_nr(void)
{
    connect();
    ANSWERS("05 31", "05 97 31 00 08"); /* RR 1, V(S) 0: Z */
    connect();
    ANSWERS("05 10 01", "05 30 81");
    ANSWERS("05 31", "05 31");
    ANSWERS("05 12 01", "05 97 12 22 08"); /* N(R) 0 after 1 was acknowledged */
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_frmr_is_repeated_whenever_polled(void)
{
    connect();
    SILENT("05 0D"); /* SREJ without P: rejected, told at the next poll */
    TEST_ASSERT_EQUAL(HDLC_FRJ, hdlc_nrm_state());
    ANSWERS("05 11", "05 97 0D 00 01");
    ANSWERS("05 10 01", "05 97 0D 00 01");
    ANSWERS("05 1D", "05 97 0D 00 01");
    SILENT("05 01");
    SILENT("05 83"); /* SNRM without P */
    TEST_ASSERT_EQUAL(0, deliveries);
}

static void test_frmr_snrm_and_disc_help(void)
{
    connect();
    ANSWERS("05 1D", "05 97 1D 00 01");
    connect();
    ANSWERS("05 11", "05 11");
    ANSWERS("05 1D", "05 97 1D 00 01");
    ANSWERS("05 53", "05 73");
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
}

/* ---- any state -------------------------------------------------------------------------------------------- */

static void test_all_station_ui_is_taken_and_nothing_answered(void)
{
    SILENT("FF 93");
    SILENT("FF 13 01");
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    connect();
    SILENT("FF 03 01");
    SILENT("FF 13 01");
    SILENT("FF 53");
    SILENT("FF 10 01");
    TEST_ASSERT_EQUAL(2, uis);
    TEST_ASSERT_EQUAL(0, deliveries);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
}

static void test_inactivity_disconnects(void)
{
    static const uint8_t other[] = {0x06, 0x11};
    connect();
    hdlc_nrm_inactivity(500);
    peer_run(3400); /* 472 ms */
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    ANSWERS("05 11", "05 11"); /* a frame to us starts it anew */
    peer_run(3300);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    peer_say(other, sizeof other); /* one to another station does not */
    peer_run(200);
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL(1, hdlc_nrm_counters.inactive);
    ANSWERS("05 11", "05 1F"); /* DM tells the primary */
    connect();
}

static void test_worked_session_of_a_plc_network(void)
{
    /* TIWAY I B-13, B-14: connect, poll, one error-free exchange, a wrong N(S), disconnect */
    ANSWERS("05 11", "05 1F");
    ANSWERS("05 93", "05 73");
    ANSWERS("05 11", "05 11");
    ANSWERS("05 10 02", "05 30 82");
    ANSWERS("05 31", "05 31");
    ANSWERS("05 34 02", "05 39"); /* N(S) 2, 1 expected: REJ 1 */
    ANSWERS("05 32 02", "05 52 82");
    ANSWERS("05 97", "05 97 97 44 01"); /* FRMR as a command: FRMR */
    ANSWERS("05 53", "05 73");
    TEST_ASSERT_EQUAL(2, deliveries);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_ndm_snrm_is_answered_ua_and_connects);
    RUN_TEST(test_ndm_any_other_command_with_p_is_answered_dm);
    RUN_TEST(test_ndm_commands_without_p_are_ignored);
    RUN_TEST(test_ndm_document_mode_08_is_answered_09);
    RUN_TEST(test_nrm_snrm_resets_the_numbers_and_drops_the_stored_frame);
    RUN_TEST(test_nrm_disc_is_answered_ua_and_disconnects);
    RUN_TEST(test_nrm_mode_setting_without_p_is_ignored);
    RUN_TEST(test_nrm_i_in_sequence_is_delivered_and_answered_i);
    RUN_TEST(test_nrm_i_without_an_answer_is_answered_rr);
    RUN_TEST(test_nrm_i_without_p_waits_for_the_poll);
    RUN_TEST(test_nrm_numbers_wrap_at_eight);
    RUN_TEST(test_nrm_busy_i_is_not_accepted_and_answered_rnr);
    RUN_TEST(test_nrm_i_out_of_sequence_is_answered_rej_once);
    RUN_TEST(test_nrm_duplicate_i_gets_the_stored_answer_again);
    RUN_TEST(test_nrm_duplicate_i_with_nothing_stored_is_answered_rr);
    RUN_TEST(test_nrm_rr_acknowledges);
    RUN_TEST(test_nrm_rr_that_does_not_acknowledge_gets_the_stored_i);
    RUN_TEST(test_nrm_i_that_does_not_acknowledge_is_kept_behind_the_stored_one);
    RUN_TEST(test_nrm_rnr_stops_our_i);
    RUN_TEST(test_nrm_rej_gets_the_frame_again);
    RUN_TEST(test_nrm_ui_test_xid);
    RUN_TEST(test_nrm_08_is_an_ordinary_i_frame);
    RUN_TEST(test_frmr_undefined_command);
    RUN_TEST(test_frmr_for_each_command_we_do_not_have);
    RUN_TEST(test_frmr_information_where_none_is_allowed);
    RUN_TEST(test_frmr_information_too_long);
    RUN_TEST(test_frmr_invalid_nr);
    RUN_TEST(test_frmr_is_repeated_whenever_polled);
    RUN_TEST(test_frmr_snrm_and_disc_help);
    RUN_TEST(test_all_station_ui_is_taken_and_nothing_answered);
    RUN_TEST(test_inactivity_disconnects);
    RUN_TEST(test_worked_session_of_a_plc_network);
    return UNITY_END();
}
