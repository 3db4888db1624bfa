/* The four remote modules (spec C2, C3). Octets of the document's mode are the document's own
 * (address 05 for A); in I-frames the same information fields ride in 10/30, 32/52, ... */
#include "hdlc/hdlc_nrm.h"
#include "hdlc_peer.h"
#include "remote_board_fake.h"
#include "remote_module.h"
#include "unity.h"

#include <string.h>

static uint8_t type;
static uint8_t ns; /* of our next I-frame */

static void init(void)
{
    rm_init(type, 5, 0);
}

static void start(uint8_t as)
{
    type = as;
    ns = 0;
    board_fake_begin();
    peer_begin(init, rm_poll);
}

void setUp(void)
{
}

void tearDown(void)
{
    peer_end();
}

static void sample(void)
{
    for (unsigned i = 0; i < RM_SAMPLE_MS; i++)
        peer_interrupt(rm_tick_isr);
}

/* Information in the next I-frame; the answer's information field. Control octets by ISO 13239: the primary's
 * N(R) = its N(S), as each command has had an I-frame for an answer. */
static uint8_t command[PEER_OCTETS], answer[PEER_OCTETS];

static bool ask_command(unsigned n)
{
    command[0] = 0x05;
    command[1] = (uint8_t)(ns << 5 | 0x10 | ns << 1);
    answer[0] = 0x05;
    answer[1] = (uint8_t)(((ns + 1) & 7) << 5 | 0x10 | ns << 1);
    ns = (ns + 1) & 7;
    return peer_ask(command, 2 + n);
}

static void ask_i(const char *q, const char *a, UNITY_LINE_TYPE line)
{
    const unsigned n = peer_hex(a, answer + 2);
    UNITY_TEST_ASSERT(ask_command(peer_hex(q, command + 2)), line, "no answer, or more than one");
    UNITY_TEST_ASSERT_EQUAL_UINT(2 + n, peer.answer_n, line, "length of the answer");
    UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(answer, peer.answer, 2 + n, line, "answer");
}

#define I_ANSWERS(q, a) ask_i(q, a, __LINE__)
#define CONNECT()       ANSWERS("05 93", "05 73")

/* ---- the document's mode ------------------------------------------------------------------------------- */

static void test_document_digital_input(void)
{
    start(RM_DI);
    board.digital_in = 0x8008; /* channels 3 and 0F */
    sample();
    ANSWERS("05 08 01 03", "05 09 01 03 31");
    ANSWERS("05 08 01 04", "05 09 01 04 30");
    ANSWERS("05 08 01 0F", "05 09 01 0F 31");
    ANSWERS("05 08 01 00", "05 09 01 00 30");
}

static void test_document_digital_output(void)
{
    start(RM_DO);
    ANSWERS("05 08 02 0F 31", "05 09 02 0F 31");
    TEST_ASSERT_EQUAL_HEX16(0x8000, board.digital_out);
    ANSWERS("05 08 02 00 31", "05 09 02 00 31");
    TEST_ASSERT_EQUAL_HEX16(0x8001, board.digital_out);
    ANSWERS("05 08 02 0F 30", "05 09 02 0F 30");
    TEST_ASSERT_EQUAL_HEX16(0x0001, board.digital_out);
}

static void test_document_analog_input(void)
{
    start(RM_AI);
    board.analog_in[0] = 0x0123;
    board.analog_in[5] = 0x0FFF;
    sample();
    ANSWERS("05 08 01 01", "05 09 01 01 01 23");
    ANSWERS("05 08 01 06", "05 09 01 06 0F FF");
}

static void test_document_analog_output(void)
{
    start(RM_AO);
    ANSWERS("05 08 02 01 0F FF", "05 09 02 01 0F FF");
    ANSWERS("05 08 02 06 08 00", "05 09 02 06 08 00");
    TEST_ASSERT_EQUAL_HEX16(0x0FFF, board.analog_out[0]);
    TEST_ASSERT_EQUAL_HEX16(0x0800, board.analog_out[5]);
}

static void test_document_what_is_wrong_is_met_with_silence(void)
{
    start(RM_DO);
    ANSWERS("05 08 02 05 31", "05 09 02 05 31");
    board.driven = 0;
    SILENT("05 08"); /* no function */
    SILENT("05 08 01 05"); /* not of this module */
    SILENT("05 08 03 00"); /* not in this mode */
    SILENT("05 08 02"); /* no channel */
    SILENT("05 08 02 10 31"); /* channel 16 */
    SILENT("05 08 02 FF 31");
    SILENT("05 08 02 05"); /* too short */
    SILENT("05 08 02 05 30 00"); /* too long */
    SILENT("05 08 02 05 32"); /* value */
    SILENT("05 08 02 05 2F");
    SILENT("05 08 02 05 01");
    SILENT("05 09 02 05 30"); /* an answer, not a command */
    TEST_ASSERT_EQUAL(11, rm_counters.refused);
    TEST_ASSERT_EQUAL(0, board.driven);
    TEST_ASSERT_EQUAL_HEX16(0x0020, board.digital_out);
}

/* ---- I-frames ------------------------------------------------------------------------------------------- */

static void test_nrm_carries_the_same_fields(void)
{
    start(RM_DI);
    board.digital_in = 0x0008;
    sample();
    CONNECT();
    ANSWERS("05 10 01 03", "05 30 01 03 31"); /* facts 2.6 */
    start(RM_AO);
    CONNECT();
    I_ANSWERS("02 01 0F FF", "02 01 0F FF");
    I_ANSWERS("02 02 00 01", "02 02 00 01");
    TEST_ASSERT_EQUAL_HEX16(0x0FFF, board.analog_out[0]);
    TEST_ASSERT_EQUAL_HEX16(0x0001, board.analog_out[1]);
}

static void test_nrm_negative_answers(void)
{
    start(RM_AO);
    CONNECT();
    board.driven = 0;
    I_ANSWERS("01 01", "81 01 01"); /* function of another module */
    I_ANSWERS("7F 01", "FF 01 01"); /* of none */
    I_ANSWERS("02 00 01 00", "82 00 02"); /* analog channels are 01..06 */
    I_ANSWERS("02 07 01 00", "82 07 02");
    I_ANSWERS("02 01 01", "82 01 03"); /* length */
    I_ANSWERS("02", "82 00 03");
    I_ANSWERS("02 01 01 00 00", "82 01 03");
    I_ANSWERS("02 01 10 00", "82 01 04"); /* 12 bits */
    I_ANSWERS("03 02", "83 02 02"); /* no such page */
    I_ANSWERS("04 01 00", "84 01 01"); /* outputs are not sampled */
    TEST_ASSERT_EQUAL(0, board.driven);
    TEST_ASSERT_EQUAL(10, rm_counters.refused);
    start(RM_DO);
    CONNECT();
    board.driven = 0;
    I_ANSWERS("02 10 31", "82 10 02");
    I_ANSWERS("02 00 32", "82 00 04");
    ANSWERS("05 54", "05 74 80 00 01"); /* I 2/2 without information */
    TEST_ASSERT_EQUAL(0, board.driven);
}

static void test_outputs_are_safe_after_power_up_disc_and_inactivity(void)
{
    start(RM_DO);
    TEST_ASSERT_EQUAL(1, board.driven);
    CONNECT();
    I_ANSWERS("02 00 31", "02 00 31");
    TEST_ASSERT_EQUAL_HEX16(1, board.digital_out);
    ANSWERS("05 53", "05 73");
    TEST_ASSERT_EQUAL_HEX16(0, board.digital_out);
    ns = 0;
    CONNECT();
    I_ANSWERS("02 00 31", "02 00 31");
    peer_run(72200); /* 10 s and a bit without a poll */
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL_HEX16(0, board.digital_out);
    TEST_ASSERT_EQUAL(2, rm_counters.safe);
    ANSWERS("05 08 02 00 31", "05 09 02 00 31");
    peer_run(80000); /* nobody is in charge in the document's mode: outputs stay */
    TEST_ASSERT_EQUAL_HEX16(1, board.digital_out);
}

/* ---- sample log ------------------------------------------------------------------------------------------- */

static void test_samples_analog_in_order_and_once(void)
{
    start(RM_AI); /* rm_init has taken number 0 */
    for (uint16_t k = 1; k < 4; k++) {
        for (uint16_t c = 0; c < 6; c++)
            board.analog_in[c] = (uint16_t)(c * 256u + k);
        sample();
    }
    CONNECT();
    I_ANSWERS("04 02 02", "04 02 00 00 00 00 02 00 00 01 01");
    I_ANSWERS("04 02 00", "04 02 00 00 00 02 02 01 02 01 03");
    I_ANSWERS("04 02 00", "04 02 00 00 00 04 00");
    I_ANSWERS("04 06 01", "04 06 00 00 00 00 01 00 00"); /* each channel by itself */
    I_ANSWERS("04 06 01", "04 06 00 00 00 01 01 05 01");
}

static void test_samples_digital(void)
{
    start(RM_DI);
    for (unsigned k = 0; k < 5; k++) {
        board.digital_in = k & 1u ? 0x0004 : 0x8000;
        sample();
    }
    CONNECT();
    I_ANSWERS("04 02 00", "04 02 00 00 00 00 06 30 30 31 30 31 30");
    I_ANSWERS("04 0F 00", "04 0F 00 00 00 00 06 30 31 30 31 30 31");
    I_ANSWERS("04 10 00", "84 10 02");
}

static unsigned fetch_all(uint8_t channel, uint16_t *lost, uint16_t *first, uint16_t *values)
{
    unsigned n = 0;
    *lost = 0;
    for (;;) {
        const uint8_t *a = peer.answer + 2;
        command[2] = 0x04;
        command[3] = channel;
        command[4] = 0x00;
        TEST_ASSERT_TRUE(ask_command(3));
        *lost = (uint16_t)(*lost + (a[2] << 8 | a[3]));
        if (n == 0)
            *first = (uint16_t)(a[4] << 8 | a[5]);
        TEST_ASSERT_EQUAL_UINT16(*first + n, a[4] << 8 | a[5]);
        if (a[6] == 0)
            return n;
        TEST_ASSERT_EQUAL(2u + 7u + 2u * a[6], peer.answer_n);
        for (unsigned i = 0; i < a[6]; i++)
            values[n++] = (uint16_t)(a[7 + 2 * i] << 8 | a[8 + 2 * i]);
    }
}

static void test_samples_overrun_is_counted_and_the_newest_kept(void)
{
    static uint16_t values[1000];
    uint16_t lost, first;
    start(RM_AI); /* 384 words: 64 samples, four spare */
    for (uint16_t k = 1; k <= 200; k++) {
        board.analog_in[3] = k;
        sample();
        if (k % 50 == 0)
            peer_run(20);
    }
    CONNECT();
    TEST_ASSERT_EQUAL(60, fetch_all(4, &lost, &first, values));
    TEST_ASSERT_EQUAL(141, lost); /* numbers 0..140 of 201 */
    TEST_ASSERT_EQUAL(141, first);
    for (unsigned i = 0; i < 60; i++)
        TEST_ASSERT_EQUAL(141 + i, values[i]);
    TEST_ASSERT_EQUAL(0, fetch_all(4, &lost, &first, values));
    TEST_ASSERT_EQUAL(0, lost);
}

/* ---- diagnosis --------------------------------------------------------------------------------------------- */

static void expect_faults(uint8_t now, uint8_t seen, uint16_t stuck, UNITY_LINE_TYPE line)
{
    peer_run(400); /* more than a pass of everything */
    command[2] = 0x03;
    command[3] = 0x00;
    UNITY_TEST_ASSERT(ask_command(2), line, "no answer");
    UNITY_TEST_ASSERT_EQUAL_HEX8(now, peer.answer[2 + 4], line, "faults");
    UNITY_TEST_ASSERT_EQUAL_HEX8(seen, peer.answer[2 + 5], line, "faults seen");
    UNITY_TEST_ASSERT_EQUAL_HEX16(stuck, peer.answer[2 + 6] << 8 | peer.answer[2 + 7], line, "stuck");
}
#define FAULTS(now, seen, stuck) expect_faults(now, seen, stuck, __LINE__)

static void test_diagnosis_ram(void)
{
    start(RM_DO);
    CONNECT();
    FAULTS(0, 0, 0);
    board.ram[3] = 0x5C;
    board.ram_stuck_bits = 0x10;
    FAULTS(0x01, 0x01, 0);
    TEST_ASSERT_EQUAL_HEX8(0x5C, board.ram[3]); /* the check leaves what was there */
    board.ram_stuck_bits = 0;
    FAULTS(0, 0x01, 0);
}

static void test_diagnosis_program(void)
{
    start(RM_DI);
    CONNECT();
    FAULTS(0, 0, 0);
    TEST_ASSERT_TRUE(rm_passes() > 5);
    board.program[123] ^= 0x40;
    FAULTS(0x02, 0x02, 0);
    board.program[123] ^= 0x40;
    FAULTS(0, 0x02, 0);
    start(RM_DI); /* the build knows the checksum, and it is another one: CRC of Modbus over the 200 octets is not 1 */
    board.program_crc = 0x0001;
    CONNECT();
    FAULTS(0x02, 0x02, 0);
}

static void test_diagnosis_converter(void)
{
    start(RM_AI);
    sample();
    CONNECT();
    I_ANSWERS("01 01", "01 01 00 00");
    board.analog_in[6] = 0x0800 + 33;
    FAULTS(0x04, 0x04, 0);
    I_ANSWERS("01 01", "81 01 05"); /* the value cannot be trusted */
    board.analog_in[6] = 0x0800 - 32;
    FAULTS(0, 0x04, 0);
    I_ANSWERS("01 01", "01 01 00 00");
}

static void test_diagnosis_stuck_outputs(void)
{
    start(RM_DO);
    CONNECT();
    board.stuck_bits = 0x0104; /* channels 2 and 8 are on whatever we say */
    board.stuck_at = 0x0104;
    FAULTS(0x08, 0x08, 0x0104);
    board.stuck_bits = 0;
    FAULTS(0, 0x08, 0);
    start(RM_AO);
    CONNECT();
    board.analog_stuck = 0x20;
    FAULTS(0x08, 0x08, 0x0020);
}

static void test_an_output_that_settles_is_not_stuck(void)
{
    start(RM_DO);
    board.stuck_bits = board.stuck_at = 0x0104;
    for (unsigned k = 0; k < 2 * 16; k++) /* every output was looked at twice */
        rm_poll();
    TEST_ASSERT_EQUAL_HEX8(0, rm_faults());
    for (unsigned k = 0; k < 16; k++)
        rm_poll();
    TEST_ASSERT_EQUAL_HEX8(RM_FAULT_OUTPUT, rm_faults());
}

static void test_xid_says_what_it_is(void)
{
    start(RM_AO);
    CONNECT();
    ANSWERS("05 BF", "05 BF 08 06");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_document_digital_input);
    RUN_TEST(test_document_digital_output);
    RUN_TEST(test_document_analog_input);
    RUN_TEST(test_document_analog_output);
    RUN_TEST(test_document_what_is_wrong_is_met_with_silence);
    RUN_TEST(test_nrm_carries_the_same_fields);
    RUN_TEST(test_nrm_negative_answers);
    RUN_TEST(test_outputs_are_safe_after_power_up_disc_and_inactivity);
    RUN_TEST(test_samples_analog_in_order_and_once);
    RUN_TEST(test_samples_digital);
    RUN_TEST(test_samples_overrun_is_counted_and_the_newest_kept);
    RUN_TEST(test_diagnosis_ram);
    RUN_TEST(test_diagnosis_program);
    RUN_TEST(test_diagnosis_converter);
    RUN_TEST(test_diagnosis_stuck_outputs);
    RUN_TEST(test_an_output_that_settles_is_not_stuck);
    RUN_TEST(test_xid_says_what_it_is);
    return UNITY_END();
}
