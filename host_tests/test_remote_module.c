/* The four remote modules (spec C2, C3) on the line of bits. Octets of the document's mode are the document's own
 * (address 05 for A); in I-frames the same information fields ride in 10/30, 32/52, ... */
#include "remote_board_fake.h"
#include "remote_module.h"
#include "hal/hal.h"
#include "hal/posix/hal_virtual_vm.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "sim/hdlc_bus.h"
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
    hbus_begin();
    board_fake_begin();
    hbus_station(init, rm_poll);
    hbus_run(20);
}

void setUp(void)
{
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, hbus.collisions + hbus.stuck);
}

static void sample(void)
{
    hv_vm.in_isr = true;
    for (unsigned i = 0; i < RM_SAMPLE_MS; i++)
        rm_tick_isr();
    hv_vm.in_isr = false;
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

/* Information in the next I-frame; the answer's information field. Control octets by ISO 13239: the primary's
 * N(R) = its N(S), as each command has had an I-frame for an answer. */
static void ask_i(const uint8_t *q, unsigned qn, const uint8_t *a, unsigned an, int line)
{
    uint8_t command[HB_OCTETS] = {0x05, (uint8_t)(ns << 5 | 0x10 | ns << 1)};
    uint8_t answer[HB_OCTETS] = {0x05, (uint8_t)(((ns + 1) & 7) << 5 | 0x10 | ns << 1)};
    memcpy(command + 2, q, qn);
    memcpy(answer + 2, a, an);
    ns = (ns + 1) & 7;
    ask(command, qn + 2, answer, an + 2, line);
}

#define ANSWERS(q, a)   (hbus_clear(), ask(OCTETS q, OCTETS a, __LINE__))
#define SILENT(q)       (hbus_clear(), tell(OCTETS q, __LINE__))
#define I_ANSWERS(q, a) (hbus_clear(), ask_i(OCTETS q, OCTETS a, __LINE__))
#define CONNECT()       ANSWERS((0x05, 0x93), (0x05, 0x73))

/* ---- the document's mode ------------------------------------------------------------------------------- */

static void test_document_digital_input(void)
{
    start(RM_DI);
    board.digital_in = 0x8008; /* channels 3 and 0F */
    sample();
    ANSWERS((0x05, 0x08, 0x01, 0x03), (0x05, 0x09, 0x01, 0x03, 0x31));
    ANSWERS((0x05, 0x08, 0x01, 0x04), (0x05, 0x09, 0x01, 0x04, 0x30));
    ANSWERS((0x05, 0x08, 0x01, 0x0F), (0x05, 0x09, 0x01, 0x0F, 0x31));
    ANSWERS((0x05, 0x08, 0x01, 0x00), (0x05, 0x09, 0x01, 0x00, 0x30));
}

static void test_document_digital_output(void)
{
    start(RM_DO);
    ANSWERS((0x05, 0x08, 0x02, 0x0F, 0x31), (0x05, 0x09, 0x02, 0x0F, 0x31));
    TEST_ASSERT_EQUAL_HEX16(0x8000, board.digital_out);
    ANSWERS((0x05, 0x08, 0x02, 0x00, 0x31), (0x05, 0x09, 0x02, 0x00, 0x31));
    TEST_ASSERT_EQUAL_HEX16(0x8001, board.digital_out);
    ANSWERS((0x05, 0x08, 0x02, 0x0F, 0x30), (0x05, 0x09, 0x02, 0x0F, 0x30));
    TEST_ASSERT_EQUAL_HEX16(0x0001, board.digital_out);
}

static void test_document_analog_input(void)
{
    start(RM_AI);
    board.analog_in[0] = 0x0123;
    board.analog_in[5] = 0x0FFF;
    sample();
    ANSWERS((0x05, 0x08, 0x01, 0x01), (0x05, 0x09, 0x01, 0x01, 0x01, 0x23));
    ANSWERS((0x05, 0x08, 0x01, 0x06), (0x05, 0x09, 0x01, 0x06, 0x0F, 0xFF));
}

static void test_document_analog_output(void)
{
    start(RM_AO);
    ANSWERS((0x05, 0x08, 0x02, 0x01, 0x0F, 0xFF), (0x05, 0x09, 0x02, 0x01, 0x0F, 0xFF));
    ANSWERS((0x05, 0x08, 0x02, 0x06, 0x08, 0x00), (0x05, 0x09, 0x02, 0x06, 0x08, 0x00));
    TEST_ASSERT_EQUAL_HEX16(0x0FFF, board.analog_out[0]);
    TEST_ASSERT_EQUAL_HEX16(0x0800, board.analog_out[5]);
}

static void test_document_what_is_wrong_is_met_with_silence(void)
{
    start(RM_DO);
    ANSWERS((0x05, 0x08, 0x02, 0x05, 0x31), (0x05, 0x09, 0x02, 0x05, 0x31));
    board.driven = 0;
    SILENT((0x05, 0x08));                               /* no function */
    SILENT((0x05, 0x08, 0x01, 0x05));                   /* not of this module */
    SILENT((0x05, 0x08, 0x03, 0x00));                   /* not in this mode */
    SILENT((0x05, 0x08, 0x02));                         /* no channel */
    SILENT((0x05, 0x08, 0x02, 0x10, 0x31));             /* channel 16 */
    SILENT((0x05, 0x08, 0x02, 0xFF, 0x31));
    SILENT((0x05, 0x08, 0x02, 0x05));                   /* too short */
    SILENT((0x05, 0x08, 0x02, 0x05, 0x30, 0x00));       /* too long */
    SILENT((0x05, 0x08, 0x02, 0x05, 0x32));             /* value */
    SILENT((0x05, 0x08, 0x02, 0x05, 0x2F));
    SILENT((0x05, 0x08, 0x02, 0x05, 0x01));
    SILENT((0x05, 0x09, 0x02, 0x05, 0x30));             /* an answer, not a command */
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
    ANSWERS((0x05, 0x10, 0x01, 0x03), (0x05, 0x30, 0x01, 0x03, 0x31)); /* facts 2.6 */
    start(RM_AO);
    CONNECT();
    I_ANSWERS((0x02, 0x01, 0x0F, 0xFF), (0x02, 0x01, 0x0F, 0xFF));
    I_ANSWERS((0x02, 0x02, 0x00, 0x01), (0x02, 0x02, 0x00, 0x01));
    TEST_ASSERT_EQUAL_HEX16(0x0FFF, board.analog_out[0]);
    TEST_ASSERT_EQUAL_HEX16(0x0001, board.analog_out[1]);
}

static void test_nrm_negative_answers(void)
{
    start(RM_AO);
    CONNECT();
    board.driven = 0;
    I_ANSWERS((0x01, 0x01), (0x81, 0x01, 0x01));             /* function of another module */
    I_ANSWERS((0x7F, 0x01), (0xFF, 0x01, 0x01));             /* of none */
    I_ANSWERS((0x02, 0x00, 0x01, 0x00), (0x82, 0x00, 0x02)); /* analog channels are 01..06 */
    I_ANSWERS((0x02, 0x07, 0x01, 0x00), (0x82, 0x07, 0x02));
    I_ANSWERS((0x02, 0x01, 0x01), (0x82, 0x01, 0x03));       /* length */
    I_ANSWERS((0x02), (0x82, 0x00, 0x03));
    I_ANSWERS((0x02, 0x01, 0x01, 0x00, 0x00), (0x82, 0x01, 0x03));
    I_ANSWERS((0x02, 0x01, 0x10, 0x00), (0x82, 0x01, 0x04)); /* 12 bits */
    I_ANSWERS((0x03, 0x02), (0x83, 0x02, 0x02));             /* no such page */
    I_ANSWERS((0x04, 0x01, 0x00), (0x84, 0x01, 0x01));       /* outputs are not sampled */
    TEST_ASSERT_EQUAL(0, board.driven);
    TEST_ASSERT_EQUAL(10, rm_counters.refused);
    start(RM_DO);
    CONNECT();
    board.driven = 0;
    I_ANSWERS((0x02, 0x10, 0x31), (0x82, 0x10, 0x02));
    I_ANSWERS((0x02, 0x00, 0x32), (0x82, 0x00, 0x04));
    hbus_clear();
    TEST_ASSERT_TRUE(hbus_ask(OCTETS(0x05, 0x54))); /* I 2/2 without information */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x05, 0x74, 0x80, 0x00, 0x01}), hbus.answer, 5);
    TEST_ASSERT_EQUAL(0, board.driven);
}

static void test_outputs_are_safe_after_power_up_disc_and_inactivity(void)
{
    start(RM_DO);
    TEST_ASSERT_EQUAL(1, board.driven);
    CONNECT();
    I_ANSWERS((0x02, 0x00, 0x31), (0x02, 0x00, 0x31));
    TEST_ASSERT_EQUAL_HEX16(1, board.digital_out);
    ANSWERS((0x05, 0x53), (0x05, 0x73));
    TEST_ASSERT_EQUAL_HEX16(0, board.digital_out);
    ns = 0;
    CONNECT();
    I_ANSWERS((0x02, 0x00, 0x31), (0x02, 0x00, 0x31));
    hbus_run(72200); /* 10 s and a bit without a poll */
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    TEST_ASSERT_EQUAL_HEX16(0, board.digital_out);
    TEST_ASSERT_EQUAL(2, rm_counters.safe);
    ANSWERS((0x05, 0x08, 0x02, 0x00, 0x31), (0x05, 0x09, 0x02, 0x00, 0x31));
    hbus_run(80000); /* nobody is in charge in the document's mode: outputs stay */
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
    I_ANSWERS((0x04, 0x02, 0x02), (0x04, 0x02, 0, 0, 0, 0, 2, 0x00, 0x00, 0x01, 0x01));
    I_ANSWERS((0x04, 0x02, 0x00), (0x04, 0x02, 0, 0, 0, 2, 2, 0x01, 0x02, 0x01, 0x03));
    I_ANSWERS((0x04, 0x02, 0x00), (0x04, 0x02, 0, 0, 0, 4, 0));
    I_ANSWERS((0x04, 0x06, 0x01), (0x04, 0x06, 0, 0, 0, 0, 1, 0x00, 0x00)); /* each channel by itself */
    I_ANSWERS((0x04, 0x06, 0x01), (0x04, 0x06, 0, 0, 0, 1, 1, 0x05, 0x01));
}

static void test_samples_digital(void)
{
    start(RM_DI);
    for (unsigned k = 0; k < 5; k++) {
        board.digital_in = k & 1u ? 0x0004 : 0x8000;
        sample();
    }
    CONNECT();
    I_ANSWERS((0x04, 0x02, 0x00), (0x04, 0x02, 0, 0, 0, 0, 6, 0x30, 0x30, 0x31, 0x30, 0x31, 0x30));
    I_ANSWERS((0x04, 0x0F, 0x00), (0x04, 0x0F, 0, 0, 0, 0, 6, 0x30, 0x31, 0x30, 0x31, 0x30, 0x31));
    I_ANSWERS((0x04, 0x10, 0x00), (0x84, 0x10, 0x02));
}

static unsigned fetch_all(uint8_t channel, uint16_t *lost, uint16_t *first, uint16_t *values)
{
    unsigned n = 0;
    *lost = 0;
    for (;;) {
        uint8_t command[] = {0x05, (uint8_t)(ns << 5 | 0x10 | ns << 1), 0x04, channel, 0x00};
        ns = (ns + 1) & 7;
        hbus_clear();
        TEST_ASSERT_TRUE(hbus_ask(command, sizeof command));
        const uint8_t *a = hbus.answer + 2;
        *lost = (uint16_t)(*lost + (a[2] << 8 | a[3]));
        if (n == 0)
            *first = (uint16_t)(a[4] << 8 | a[5]);
        TEST_ASSERT_EQUAL((uint16_t)(*first + n), a[4] << 8 | a[5]);
        if (a[6] == 0)
            return n;
        TEST_ASSERT_EQUAL(2u + 7u + 2u * a[6], hbus.answer_n);
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
            hbus_run(20);
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

static void test_samples_numbers_and_losses_survive_the_wrap_of_16_bits(void)
{
    static uint16_t values[1000];
    uint16_t lost, first;
    start(RM_AI);
    for (uint32_t k = 1; k <= 70000; k++) {
        board.analog_in[0] = (uint16_t)k;
        sample();
        if (k % 1000 == 0)
            hbus_run(20); /* the main loop looks at every channel */
    }
    CONNECT();
    TEST_ASSERT_EQUAL(60, fetch_all(1, &lost, &first, values));
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, lost); /* 69941, saturated */
    TEST_ASSERT_EQUAL((uint16_t)69941, first);
    TEST_ASSERT_EQUAL((uint16_t)70000, values[59]);
}

/* ---- diagnosis --------------------------------------------------------------------------------------------- */

static void expect_faults(uint8_t now, uint8_t seen, uint16_t stuck, int line)
{
    uint8_t command[] = {0x05, (uint8_t)(ns << 5 | 0x10 | ns << 1), 0x03, 0x00};
    ns = (ns + 1) & 7;
    hbus_run(400); /* more than a pass of everything */
    hbus_clear();
    UNITY_TEST_ASSERT(hbus_ask(command, sizeof command), line, "no answer");
    UNITY_TEST_ASSERT_EQUAL_HEX8(now, hbus.answer[2 + 4], line, "faults");
    UNITY_TEST_ASSERT_EQUAL_HEX8(seen, hbus.answer[2 + 5], line, "faults seen");
    UNITY_TEST_ASSERT_EQUAL_HEX16(stuck, hbus.answer[2 + 6] << 8 | hbus.answer[2 + 7], line, "stuck");
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
    I_ANSWERS((0x01, 0x01), (0x01, 0x01, 0x00, 0x00));
    board.analog_in[6] = 0x0800 + 33;
    FAULTS(0x04, 0x04, 0);
    I_ANSWERS((0x01, 0x01), (0x81, 0x01, 0x05)); /* the value cannot be trusted */
    board.analog_in[6] = 0x0800 - 32;
    FAULTS(0, 0x04, 0);
    I_ANSWERS((0x01, 0x01), (0x01, 0x01, 0x00, 0x00));
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

static void test_diagnosis_line_counters(void)
{
    struct hb_line bad = {0};
    start(RM_DI);
    hb_flag(&bad), hb_stuffed(&bad, (uint8_t[]){0x05, 0x93, 0, 0}, 4), hb_flag(&bad);
    hbus_say_bits(&bad);
    hbus_run(40);
    CONNECT();
    ns = 1;
    hbus_clear();
    TEST_ASSERT_TRUE(hbus_ask(OCTETS(0x05, 0x10, 0x03, 0x01)));
    TEST_ASSERT_EQUAL(2 + 36, hbus.answer_n);
    TEST_ASSERT_EQUAL_HEX8(0x03, hbus.answer[2]);
    TEST_ASSERT_EQUAL(2, hbus.answer[2 + 3]);  /* good: SNRM and this one */
    TEST_ASSERT_EQUAL(1, hbus.answer[2 + 5]);  /* CRC */
    TEST_ASSERT_EQUAL(1, hbus.answer[2 + 15]); /* sent: UA */
    TEST_ASSERT_EQUAL(1, hbus.answer[2 + 21]); /* delivered */
}

static void test_xid_says_what_it_is(void)
{
    start(RM_AO);
    CONNECT();
    ANSWERS((0x05, 0xBF), (0x05, 0xBF, 0x08, 0x06));
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
    RUN_TEST(test_samples_numbers_and_losses_survive_the_wrap_of_16_bits);
    RUN_TEST(test_diagnosis_ram);
    RUN_TEST(test_diagnosis_program);
    RUN_TEST(test_diagnosis_converter);
    RUN_TEST(test_diagnosis_stuck_outputs);
    RUN_TEST(test_an_output_that_settles_is_not_stuck);
    RUN_TEST(test_diagnosis_line_counters);
    RUN_TEST(test_xid_says_what_it_is);
    return UNITY_END();
}
