/* What the secondary and a remote module make of bits that are no good frame: on the modelled 8273 only. Their frames are in
 * test_hdlc_nrm.c and test_remote_module.c. */
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "hdlc_peer.h"
#include "remote_board_fake.h"
#include "remote_module.h"
#include "sim/hdlc_bus.h"
#include "unity.h"

static void station(void)
{
    TEST_ASSERT_TRUE(hdlc_nrm_init(5, 0xFF, 0));
}

static void module(void)
{
    TEST_ASSERT_TRUE(rm_init(RM_DI, 5, 0));
}

static void start(void (*init)(void), void (*loop)(void))
{
    board_fake_begin();
    peer_begin(init, loop);
}

void setUp(void)
{
}

void tearDown(void)
{
    peer_end();
}

static void test_bad_frames_and_other_addresses_are_ignored(void)
{
    static const uint8_t snrm[] = {0x05, 0x93, 0xED, 0xD7};
    struct hb_line line = {0};
    start(station, hdlc_nrm_poll);
    SILENT("06 93"); /* another station */
    SILENT("00 93");
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
    ANSWERS("05 93", "05 73");
}

static void test_frames_may_follow_each_other_with_one_flag_between(void)
{
    static const uint8_t no_poll[] = {0x05, 0x83}, poll[] = {0x05, 0x93};
    struct hb_line line = {0};
    start(station, hdlc_nrm_poll);
    hb_frame(&line, no_poll, sizeof no_poll); /* SNRM without P, ignored */
    line.n -= 8;
    hb_frame(&line, poll, sizeof poll);
    hbus_say_bits(&line);
    hbus_run(200);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL(2, hdlc_nrm_counters.commands);
}

static void test_diagnosis_line_counters(void)
{
    static const uint8_t get_page[] = {0x05, 0x10, 0x03, 0x01};
    struct hb_line bad = {0};
    start(module, rm_poll);
    hb_flag(&bad), hb_stuffed(&bad, (uint8_t[]){0x05, 0x93, 0, 0}, 4), hb_flag(&bad);
    hbus_say_bits(&bad);
    hbus_run(40);
    ANSWERS("05 93", "05 73");
    TEST_ASSERT_TRUE(peer_ask(get_page, sizeof get_page));
    TEST_ASSERT_EQUAL(2 + 36, peer.answer_n);
    TEST_ASSERT_EQUAL_HEX8(0x03, peer.answer[2]);
    TEST_ASSERT_EQUAL(2, peer.answer[2 + 3]);  /* good: SNRM and this one */
    TEST_ASSERT_EQUAL(1, peer.answer[2 + 5]);  /* CRC */
    TEST_ASSERT_EQUAL(1, peer.answer[2 + 15]); /* sent: UA */
    TEST_ASSERT_EQUAL(1, peer.answer[2 + 21]); /* delivered */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_bad_frames_and_other_addresses_are_ignored);
    RUN_TEST(test_frames_may_follow_each_other_with_one_flag_between);
    RUN_TEST(test_diagnosis_line_counters);
    return UNITY_END();
}
