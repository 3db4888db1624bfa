/* The secondary, row by row (facts 2.3), over the modelled 8273 on a line of bits. The station's address is 5.
 * Octets are worked out from ISO 13239 5.3: I = NR<<5 | P<<4 | NS<<1; RR 01, RNR 05, REJ 09; SNRM 83, DISC 43,
 * UA 63, DM 0F, FRMR 87, XID AF, TEST E3, UI 03; P/F 10H. */
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "sim/hdlc_bus.h"
#include "sim/hdlc_pcap.h"
#include "unity.h"

#include <stdlib.h>
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

/* HDLC_PCAP=FILE in the environment: all frames of all tests into a capture, for decoders of others
 * (host_tests/hdlc_host.py). */
static FILE *capture;

static void tap(const uint8_t *octets, unsigned n, bool from_station)
{
    (void)from_station;
    hdlc_pcap_frame(capture, octets, n, hbus.now * 1000000u / 7200u);
}

void setUp(void)
{
    deliveries = uis = states = 0;
    mute = false;
    hbus_begin();
    hbus.tap = capture ? tap : NULL;
    hbus_station(init, hdlc_nrm_poll);
    hbus_run(20);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(0, hbus.collisions, "the station spoke while the primary did");
    TEST_ASSERT_EQUAL_MESSAGE(0, hbus.stuck, "an interrupt was left pending");
    TEST_ASSERT_EQUAL_MESSAGE(0, hal_8273_chip.lost_commands + hal_8273_chip.lost_parameters, "8273 misused");
    TEST_ASSERT_EQUAL(0, hal_8273_chip.data_without_request);
}

#define OCTETS(...) ((const uint8_t[]){__VA_ARGS__}), sizeof((const uint8_t[]){__VA_ARGS__})

static void ask(const uint8_t *q, unsigned qn, const uint8_t *a, unsigned an, int line)
{
    UNITY_TEST_ASSERT(hbus_ask(q, qn), line, "no answer, or more than one");
    UNITY_TEST_ASSERT_EQUAL_UINT(an, hbus.answer_n, line, "length of the answer");
    UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(a, hbus.answer, an, line, "answer");
}

static void tell(const uint8_t *q, unsigned qn, int line)
{
    UNITY_TEST_ASSERT(!hbus_ask(q, qn) && hbus.answers == 0, line, "an answer where none is due");
}

/* hears: (command octets), (answer octets). silent: (command octets). */
#define ANSWERS(q, a) (hbus_clear(), ask(OCTETS q, OCTETS a, __LINE__))
#define SILENT(q)     (hbus_clear(), tell(OCTETS q, __LINE__))

static void connect(void)
{
    ANSWERS((0x05, 0x93), (0x05, 0x73));
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
    ANSWERS((0x05, 0x53), (0x05, 0x1F));                   /* DISC */
    ANSWERS((0x05, 0x11), (0x05, 0x1F));                   /* RR */
    ANSWERS((0x05, 0x15), (0x05, 0x1F));                   /* RNR */
    ANSWERS((0x05, 0x19), (0x05, 0x1F));                   /* REJ */
    ANSWERS((0x05, 0x10, 0x01, 0x03), (0x05, 0x1F));       /* I */
    ANSWERS((0x05, 0x13, 0x01), (0x05, 0x1F));             /* UI */
    ANSWERS((0x05, 0xF3, 0x55), (0x05, 0x1F));             /* TEST */
    ANSWERS((0x05, 0xBF), (0x05, 0x1F));                   /* XID */
    ANSWERS((0x05, 0xDF), (0x05, 0x1F));                   /* SNRME */
    ANSWERS((0x05, 0x93, 0x00), (0x05, 0x1F));             /* SNRM with information is no SNRM */
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL(0, deliveries);
}

static void test_ndm_commands_without_p_are_ignored(void)
{
    SILENT((0x05, 0x83));
    SILENT((0x05, 0x43));
    SILENT((0x05, 0x01));
    SILENT((0x05, 0x00, 0x01, 0x03));
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
}

static void test_ndm_document_mode_08_is_answered_09(void)
{
    ANSWERS((0x05, 0x08, 0x01, 0x03), (0x05, 0x09, 0x01, 0x03, 0x31));
    TEST_ASSERT_EQUAL(0, deliveries);
    SILENT((0x05, 0x08, 0x01)); /* the application refuses it */
    TEST_ASSERT_EQUAL(1, hdlc_nrm_counters.unanswered);
}

/* ---- NRM ---------------------------------------------------------------------------------------------- */

static void test_nrm_snrm_resets_the_numbers_and_drops_the_stored_frame(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    connect();
    ANSWERS((0x05, 0x11), (0x05, 0x11)); /* RR 0: V(R) 0, nothing to repeat */
    ANSWERS((0x05, 0x10, 0x02), (0x05, 0x30, 0x82));
    TEST_ASSERT_EQUAL(1, states);
}

static void test_nrm_disc_is_answered_ua_and_disconnects(void)
{
    connect();
    ANSWERS((0x05, 0x53), (0x05, 0x73));
    TEST_ASSERT_EQUAL(HDLC_NDM, last_state);
    ANSWERS((0x05, 0x11), (0x05, 0x1F));
}

static void test_nrm_mode_setting_without_p_is_ignored(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    SILENT((0x05, 0x83));
    SILENT((0x05, 0x43));
    ANSWERS((0x05, 0x31), (0x05, 0x31));
}

static void test_nrm_i_in_sequence_is_delivered_and_answered_i(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01, 0x03), (0x05, 0x30, 0x81, 0x03)); /* I 0/0 -> I 0/1 */
    ANSWERS((0x05, 0x32, 0x01, 0x04), (0x05, 0x52, 0x81, 0x04)); /* I 1/1 -> I 1/2 */
    TEST_ASSERT_EQUAL(2, deliveries);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x01, 0x03}), delivered[0], 2);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x01, 0x04}), delivered[1], 2);
}

static void test_nrm_i_without_an_answer_is_answered_rr(void)
{
    connect();
    mute = true;
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x31)); /* RR 1 */
    ANSWERS((0x05, 0x12), (0x05, 0x51));       /* an empty information field is legal, too: RR 2 */
    TEST_ASSERT_EQUAL(2, deliveries);
}

static void test_nrm_i_without_p_waits_for_the_poll(void)
{
    connect();
    SILENT((0x05, 0x00, 0x01));
    TEST_ASSERT_EQUAL(1, deliveries);
    ANSWERS((0x05, 0x11), (0x05, 0x30, 0x81)); /* I 0/1 */
}

static void test_nrm_numbers_wrap_at_eight(void)
{
    connect();
    for (uint8_t k = 0; k < 20; k++) {
        const uint8_t n = k & 7u, next = (k + 1u) & 7u;
        hbus_clear();
        TEST_ASSERT_TRUE(hbus_ask(OCTETS(0x05, (uint8_t)(n << 5 | 0x10 | n << 1), k)));
        TEST_ASSERT_EQUAL_HEX8(next << 5 | 0x10 | n << 1, hbus.answer[1]);
        TEST_ASSERT_EQUAL_HEX8(k | 0x80, hbus.answer[2]);
    }
    TEST_ASSERT_EQUAL(20, deliveries);
}

static void test_nrm_busy_i_is_not_accepted_and_answered_rnr(void)
{
    connect();
    hdlc_nrm_busy(true);
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x15)); /* RNR 0 */
    ANSWERS((0x05, 0x11), (0x05, 0x15));
    ANSWERS((0x05, 0x12, 0x01), (0x05, 0x15)); /* out of sequence: RNR tells it, too */
    TEST_ASSERT_EQUAL(0, deliveries);
    hdlc_nrm_busy(false);
    ANSWERS((0x05, 0x11), (0x05, 0x11)); /* ready again: RR */
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_nrm_i_out_of_sequence_is_answered_rej_once(void)
{
    connect();
    ANSWERS((0x05, 0x12, 0x01), (0x05, 0x19)); /* N(S) 1, 0 expected: REJ 0 */
    ANSWERS((0x05, 0x12, 0x01), (0x05, 0x11)); /* a second REJ must not be outstanding: RR 0 */
    TEST_ASSERT_EQUAL(0, deliveries);
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81)); /* the right one clears it */
    ANSWERS((0x05, 0x36, 0x01), (0x05, 0x39));       /* N(S) 3, 1 expected, N(R) 1 acknowledges: REJ 1 */
    SILENT((0x05, 0x26, 0x01));                      /* without P: nothing */
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_nrm_duplicate_i_gets_the_stored_answer_again(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81)); /* lost answer: the same I again, the same answer */
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    TEST_ASSERT_EQUAL(1, deliveries);
    TEST_ASSERT_EQUAL(2, hdlc_nrm_counters.resent);
}

static void test_nrm_duplicate_i_with_nothing_stored_is_answered_rr(void)
{
    connect();
    mute = true;
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x31));
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x31)); /* TIWAY B-15: RR again */
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_nrm_rr_acknowledges(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x31), (0x05, 0x31)); /* RR 1 acknowledges I 0: nothing more, RR 1 */
}

static void test_nrm_rr_that_does_not_acknowledge_gets_the_stored_i(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x11), (0x05, 0x30, 0x81)); /* RR 0 */
    ANSWERS((0x05, 0x12, 0x02), (0x05, 0x50, 0x81)); /* I 1 with N(R) 0: accepted, but I 0 again, now with N(R) 2 */
    ANSWERS((0x05, 0x51, 0x00), (0x05, 0x97, 0x51, 0x42, 0x03)); /* S-frame with information: FRMR W, X */
    TEST_ASSERT_EQUAL(2, deliveries);
}

static void test_nrm_i_that_does_not_acknowledge_is_kept_behind_the_stored_one(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x12, 0x02), (0x05, 0x50, 0x81)); /* first slot again */
    ANSWERS((0x05, 0x14, 0x03), (0x05, 0x50, 0x81)); /* no slot left: not accepted, V(R) stays 2 */
    TEST_ASSERT_EQUAL(2, deliveries);
    ANSWERS((0x05, 0x31), (0x05, 0x52, 0x82));       /* RR 1: I 1 now */
    ANSWERS((0x05, 0x54, 0x03), (0x05, 0x74, 0x83)); /* I 2 with N(R) 2: accepted */
    TEST_ASSERT_EQUAL(3, deliveries);
}

static void test_nrm_rnr_stops_our_i(void)
{
    connect();
    SILENT((0x05, 0x00, 0x01));
    ANSWERS((0x05, 0x15), (0x05, 0x31));       /* RNR 0 -> RR 1 though an I waits */
    ANSWERS((0x05, 0x11), (0x05, 0x30, 0x81)); /* RR 0 ends it */
    ANSWERS((0x05, 0x35), (0x05, 0x31));
    connect(); /* so does SNRM */
    ANSWERS((0x05, 0x10, 0x02), (0x05, 0x30, 0x82));
}

static void test_nrm_rej_gets_the_frame_again(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x19), (0x05, 0x30, 0x81)); /* REJ 0 */
    ANSWERS((0x05, 0x39), (0x05, 0x31));       /* REJ 1: nothing from 1 on, RR */
    ANSWERS((0x05, 0x35), (0x05, 0x31));       /* RNR 1 */
    ANSWERS((0x05, 0x39), (0x05, 0x31));       /* REJ ends the primary's busy condition, too */
}

static void test_nrm_ui_test_xid(void)
{
    connect();
    SILENT((0x05, 0x03, 0x01));
    ANSWERS((0x05, 0x13, 0x01), (0x05, 0x11)); /* UI P: RR 0 */
    TEST_ASSERT_EQUAL(2, uis);
    ANSWERS((0x05, 0xF3, 0x55, 0xAA), (0x05, 0xF3, 0x55, 0xAA)); /* TEST P: the same back */
    ANSWERS((0x05, 0xF3), (0x05, 0xF3));
    SILENT((0x05, 0xE3, 0x55));
    ANSWERS((0x05, 0xBF), (0x05, 0xBF, 0x42)); /* XID P: the application's identification */
    SILENT((0x05, 0xAF));
}

static void test_nrm_08_is_an_ordinary_i_frame(void)
{
    connect();
    SILENT((0x05, 0x08, 0x01, 0x03)); /* I N(S) 4 N(R) 0 P 0: out of sequence */
    TEST_ASSERT_EQUAL(0, deliveries);
}

/* ---- frame reject ----------------------------------------------------------------------------------------- */

static void test_frmr_undefined_command(void)
{
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x1D), (0x05, 0x97, 0x1D, 0x22, 0x01)); /* SREJ: V(R) 1, V(S) 1, W */
    TEST_ASSERT_EQUAL(HDLC_FRJ, hdlc_nrm_state());
}

static void test_frmr_for_each_command_we_do_not_have(void)
{
    static const uint8_t codes[] = {0x1D, 0xDF, 0x73, 0x1F, 0x97, 0x33, 0x17, 0x9F, 0x7F, 0x5F};
    for (unsigned i = 0; i < sizeof codes; i++) { /* SREJ SNRME UA DM FRMR UP SIM RSET SABME ?? */
        connect();
        hbus_clear();
        TEST_ASSERT_TRUE(hbus_ask(OCTETS(0x05, codes[i])));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x05, 0x97, codes[i], 0x00, 0x01}), hbus.answer, 5);
    }
}

static void test_frmr_information_where_none_is_allowed(void)
{
    connect();
    ANSWERS((0x05, 0x11, 0x00), (0x05, 0x97, 0x11, 0x00, 0x03)); /* W and X */
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    ANSWERS((0x05, 0x53, 0x00), (0x05, 0x97, 0x53, 0x00, 0x03)); /* DISC with information */
    ANSWERS((0x05, 0x93, 0x00), (0x05, 0x97, 0x53, 0x00, 0x03)); /* SNRM with information: FRMR repeated */
}

static void long_frame(uint8_t control, unsigned info)
{
    static uint8_t octets[HB_OCTETS] = {0x05};
    octets[1] = control;
    hbus_clear();
    hbus_ask(octets, 2 + info);
}

static void test_frmr_information_too_long(void)
{
    connect();
    long_frame(0x10, HDLC_INFO_MAX); /* just fits: 64 octets, I 0/1 of 64 octets back */
    TEST_ASSERT_EQUAL_HEX8(0x30, hbus.answer[1]);
    TEST_ASSERT_EQUAL(2 + HDLC_INFO_MAX, hbus.answer_n);
    long_frame(0x32, HDLC_INFO_MAX + 1);
    TEST_ASSERT_EQUAL(5, hbus.answer_n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x05, 0x97, 0x32, 0x22, 0x04}), hbus.answer, 5); /* Y */
    connect();
    long_frame(0xF3, 260); /* longer than eight bits can count */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x05, 0x97, 0xF3, 0x00, 0x04}), hbus.answer, 5);
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_frmr_invalid_nr(void)
{
    connect();
    ANSWERS((0x05, 0x31), (0x05, 0x97, 0x31, 0x00, 0x08)); /* RR 1, V(S) 0: Z */
    connect();
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x81));
    ANSWERS((0x05, 0x31), (0x05, 0x31));
    ANSWERS((0x05, 0x12, 0x01), (0x05, 0x97, 0x12, 0x22, 0x08)); /* N(R) 0 after 1 was acknowledged */
    TEST_ASSERT_EQUAL(1, deliveries);
}

static void test_frmr_is_repeated_whenever_polled(void)
{
    connect();
    SILENT((0x05, 0x0D)); /* SREJ without P: rejected, told at the next poll */
    TEST_ASSERT_EQUAL(HDLC_FRJ, hdlc_nrm_state());
    ANSWERS((0x05, 0x11), (0x05, 0x97, 0x0D, 0x00, 0x01));
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x97, 0x0D, 0x00, 0x01));
    ANSWERS((0x05, 0x1D), (0x05, 0x97, 0x0D, 0x00, 0x01));
    SILENT((0x05, 0x01));
    SILENT((0x05, 0x83)); /* SNRM without P */
    TEST_ASSERT_EQUAL(0, deliveries);
}

static void test_frmr_snrm_and_disc_help(void)
{
    connect();
    ANSWERS((0x05, 0x1D), (0x05, 0x97, 0x1D, 0x00, 0x01));
    connect();
    ANSWERS((0x05, 0x11), (0x05, 0x11));
    ANSWERS((0x05, 0x1D), (0x05, 0x97, 0x1D, 0x00, 0x01));
    ANSWERS((0x05, 0x53), (0x05, 0x73));
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
}

/* ---- any state -------------------------------------------------------------------------------------------- */

static void test_bad_frames_and_other_addresses_are_ignored(void)
{
    static const uint8_t snrm[] = {0x05, 0x93, 0xED, 0xD7};
    struct hb_line line = {0};

    SILENT((0x06, 0x93)); /* another station */
    SILENT((0x00, 0x93));
    hb_flag(&line), hb_stuffed(&line, snrm, 3), hb_flag(&line); /* 24 bits */
    hb_flag(&line), hb_stuffed(&line, snrm, 2), hb_stuffed(&line, (uint8_t[]){0xED, 0xD6}, 2), hb_flag(&line); /* FCS */
    hb_flag(&line), hb_stuffed(&line, snrm, 4), hb_raw(&line, 1, 1), hb_flag(&line); /* 33 bits */
    hb_flag(&line), hb_stuffed(&line, snrm, 4), hb_raw(&line, 0xFF, 8); /* abort */
    hbus_say_bits(&line);
    hbus_run(200);
    TEST_ASSERT_EQUAL(0, hbus.driven);
    TEST_ASSERT_EQUAL(1, hdlc_8273_counters.rx[HDLC_RX_SHORT]);
    TEST_ASSERT_EQUAL(2, hdlc_8273_counters.rx[HDLC_RX_CRC]);
    TEST_ASSERT_EQUAL(1, hdlc_8273_counters.rx[HDLC_RX_ABORT]);
    TEST_ASSERT_EQUAL(0, hdlc_nrm_counters.commands);
    connect();
}

static void test_frames_may_follow_each_other_with_one_flag_between(void)
{
    struct hb_line line = {0};
    hb_frame(&line, OCTETS(0x05, 0x83)); /* SNRM without P, ignored */
    line.n -= 8;
    hb_frame(&line, OCTETS(0x05, 0x93));
    hbus_say_bits(&line);
    hbus_run(200);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL(2, hdlc_nrm_counters.commands);
}

static void test_all_station_ui_is_taken_and_nothing_answered(void)
{
    SILENT((0xFF, 0x93));
    SILENT((0xFF, 0x13, 0x01));
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    connect();
    SILENT((0xFF, 0x03, 0x01));
    SILENT((0xFF, 0x13, 0x01));
    SILENT((0xFF, 0x53));
    SILENT((0xFF, 0x10, 0x01));
    TEST_ASSERT_EQUAL(2, uis);
    TEST_ASSERT_EQUAL(0, deliveries);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
}

static void test_inactivity_disconnects(void)
{
    connect();
    hdlc_nrm_inactivity(500);
    hbus_run(3400); /* 472 ms */
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    ANSWERS((0x05, 0x11), (0x05, 0x11)); /* a frame to us starts it anew */
    hbus_run(3300);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    hbus_say(OCTETS(0x06, 0x11)); /* one to another station does not */
    hbus_run(200);
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL(1, hdlc_nrm_counters.inactive);
    ANSWERS((0x05, 0x11), (0x05, 0x1F)); /* DM tells the primary */
    connect();
}

static void test_worked_session_of_a_plc_network(void)
{
    /* TIWAY I B-13, B-14: connect, poll, one error-free exchange, a wrong N(S), disconnect */
    ANSWERS((0x05, 0x11), (0x05, 0x1F));
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    ANSWERS((0x05, 0x11), (0x05, 0x11));
    ANSWERS((0x05, 0x10, 0x02), (0x05, 0x30, 0x82));
    ANSWERS((0x05, 0x31), (0x05, 0x31));
    ANSWERS((0x05, 0x34, 0x02), (0x05, 0x39)); /* N(S) 2, 1 expected: REJ 1 */
    ANSWERS((0x05, 0x32, 0x02), (0x05, 0x52, 0x82));
    ANSWERS((0x05, 0x97), (0x05, 0x97, 0x97, 0x44, 0x01)); /* FRMR as a command: FRMR */
    ANSWERS((0x05, 0x53), (0x05, 0x73));
    TEST_ASSERT_EQUAL(2, deliveries);
}

int main(void)
{
    if (getenv("HDLC_PCAP"))
        capture = hdlc_pcap_open(getenv("HDLC_PCAP"));
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
    RUN_TEST(test_bad_frames_and_other_addresses_are_ignored);
    RUN_TEST(test_frames_may_follow_each_other_with_one_flag_between);
    RUN_TEST(test_all_station_ui_is_taken_and_nothing_answered);
    RUN_TEST(test_inactivity_disconnects);
    RUN_TEST(test_worked_session_of_a_plc_network);
    return UNITY_END();
}
