/* The driver on every kind of 8273: both sides of every point on which the sources disagree, in every mode; every
 * result code; a chip that is stuck, slow or dead. The station behind it is the NRM secondary, address 5, which
 * answers TEST with the same information. */
#include "hal/hal.h"
#include "hal/hal_8273.h"
#include "hal/posix/hal_virtual_vm.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "sim/hdlc_bus.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint8_t mode;
static unsigned delivered;

uint8_t hdlc_info_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer)
{
    delivered++;
    memcpy(answer, info, n);
    return n;
}

static void init(void)
{
    TEST_ASSERT_TRUE(hdlc_nrm_init(5, 5, mode));
}

static void start_with(uint8_t as, const struct i8273_options *option)
{
    mode = as;
    delivered = 0;
    hbus_begin();
    hbus.nrzi = (as & HDLC_8273_NRZI) != 0;
    hbus.preframe = as & HDLC_8273_PREFRAME ? 2 : 0;
    if (option)
        hal_8273_chip.option = *option;
    hbus_station(init, hdlc_nrm_poll);
    hbus_run(20);
}

static void start(uint8_t as)
{
    start_with(as, NULL);
}

void setUp(void)
{
}

static char where[200];

void tearDown(void)
{
    where[0] = 0;
    TEST_ASSERT_EQUAL_MESSAGE(0, hbus.stuck, "an interrupt was left pending");
}

#define OCTETS(...) ((const uint8_t[]){__VA_ARGS__}), sizeof((const uint8_t[]){__VA_ARGS__})

static void ask(const uint8_t *q, unsigned qn, const uint8_t *a, unsigned an, int line)
{
    hbus_clear();
    UNITY_TEST_ASSERT(hbus_ask(q, qn), line, where);
    UNITY_TEST_ASSERT_EQUAL_UINT(an, hbus.answer_n, line, where);
    UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(a, hbus.answer, an, line, where);
}
#define ANSWERS(q, a) ask(OCTETS q, OCTETS a, __LINE__)

static void say_bits_and_wait(const struct hb_line *line)
{
    hbus_clear();
    hbus_say_bits(line);
    hbus_run(60);
    TEST_ASSERT_EQUAL_MESSAGE(0, hbus.driven, where);
}

static void echo_of(unsigned n)
{
    uint8_t octets[HB_OCTETS] = {0x05, 0xF3};
    for (unsigned i = 0; i < n; i++)
        octets[2 + i] = (uint8_t)(i * 37u + 3u);
    ask(octets, n + 2, octets, n + 2, __LINE__);
}

static const uint8_t snrm[] = {0x05, 0x93, 0xED, 0xD7}; /* with FCS, facts 2.6 */

/* 33 bits with a good FCS: the FCS over A, C and one bit more, computed bit by bit. */
static void unaligned(struct hb_line *line)
{
    const uint8_t octets[] = {0x05, 0x93};
    uint16_t crc = 0xFFFF;
    hb_flag(line);
    hb_stuffed(line, octets, 2);
    for (unsigned i = 0; i < 16; i++)
        crc = hb_crc_bit(crc, (octets[i / 8] >> (i % 8)) & 1u);
    hb_raw(line, 0, 1);
    crc = (uint16_t)~hb_crc_bit(crc, 0);
    hb_stuffed(line, (uint8_t[]){(uint8_t)crc, (uint8_t)(crc >> 8)}, 2);
    hb_flag(line);
}

/* Good frames, every kind of bad one, and good ones behind each. */
static void session(void)
{
    struct hb_line line;

    ANSWERS((0x05, 0x93), (0x05, 0x73));
    ANSWERS((0x05, 0x10, 0x01, 0x03), (0x05, 0x30, 0x01, 0x03));
    line = (struct hb_line){0}; /* FCS */
    hb_flag(&line), hb_stuffed(&line, snrm, 3), hb_stuffed(&line, (uint8_t[]){0x00}, 1), hb_flag(&line);
    say_bits_and_wait(&line);
    ANSWERS((0x05, 0x31), (0x05, 0x31));
    line = (struct hb_line){0}; /* abort, nothing after it */
    hb_flag(&line), hb_stuffed(&line, snrm, 4), hb_raw(&line, 0xFF, 8);
    say_bits_and_wait(&line);
    line = (struct hb_line){0}; /* abort and a frame behind it at once */
    hb_flag(&line), hb_stuffed(&line, snrm, 3), hb_raw(&line, 0x7F, 8);
    hb_frame(&line, (uint8_t[]){0x05, 0x31}, 2);
    hbus_clear();
    hbus_say_bits(&line);
    hbus_run(120);
    TEST_ASSERT_EQUAL_MESSAGE(1, hbus.answers, where);
    line = (struct hb_line){0}; /* 24 bits */
    hb_flag(&line), hb_stuffed(&line, snrm, 3), hb_flag(&line);
    say_bits_and_wait(&line);
    line = (struct hb_line){0};
    unaligned(&line);
    say_bits_and_wait(&line);
    echo_of(0);
    echo_of(HDLC_INFO_MAX);
    hbus_run(500); /* idle for long */
    ANSWERS((0x05, 0x32, 0x55), (0x05, 0x52, 0x55));
    ANSWERS((0x05, 0x1D), (0x05, 0x97, 0x1D, 0x44, 0x01)); /* V(R) 2, V(S) 2 */
}


static void test_both_sides_of_every_disagreement_in_every_mode(void)
{
    static const uint8_t modes[] = {0, HDLC_8273_BUFFERED, HDLC_8273_DMA, HDLC_8273_BUFFERED | HDLC_8273_DMA};
    static const uint8_t extras[] = {0, HDLC_8273_NRZI | HDLC_8273_PREFRAME, HDLC_8273_EARLY, HDLC_8273_NRZI,
                                     HDLC_8273_PREFRAME | HDLC_8273_EARLY};
    const unsigned step = getenv("TEST_FULL") ? 1 : 7; /* prime to the number of combinations */
    unsigned combinations = 0;

    for (unsigned k = 0; k < sizeof modes * sizeof extras * 256u; k += step) {
        const unsigned bits = k % 256u;
        const uint8_t as = modes[k / 256u % 4u] | extras[k / 1024u];
        const struct i8273_options option = {
            .reset_at_1 = bits & 1u,
            .one_error_result = bits & 2u,
            .abort_disables = bits & 4u,
            .plain_partial = bits & 8u,
            .ports_inverted = bits & 16u,
            .short_when_buffered = bits & 32u,
            .hold_reads = bits & 64u ? 9 : 0,
            .result_reads = bits & 128u ? 5 : 0,
        };
        snprintf(where, sizeof where, "mode %02X, options %02X", as, bits);
        start_with(as, &option);
        session();
        TEST_ASSERT_EQUAL_MESSAGE(0, hal_8273_chip.lost_commands + hal_8273_chip.lost_parameters, where);
        TEST_ASSERT_EQUAL_MESSAGE(0, hal_8273_chip.data_without_request, where);
        TEST_ASSERT_EQUAL_MESSAGE(0, hdlc_8273_counters.tx[HDLC_TX_RESTARTS] + hbus.stuck, where);
        TEST_ASSERT_EQUAL_MESSAGE(2, delivered, where);
        combinations++;
    }
    TEST_ASSERT_TRUE(combinations >= 700);
}

/* ---- result codes ------------------------------------------------------------------------------------------- */

static uint16_t rx(unsigned code)
{
    return hdlc_8273_counters.rx[code];
}

static void test_idle_disables_the_receiver_and_is_met_by_arming_it_again(void)
{
    start(0);
    for (unsigned k = 1; k <= 5; k++) {
        hbus_say(OCTETS(0x06, 0x93)); /* for another station: no result but the idle line behind it */
        hbus_run(30);
        TEST_ASSERT_EQUAL(k, rx(HDLC_RX_IDLE));
        TEST_ASSERT_TRUE(hal_8273_chip.rx.enabled);
    }
}

static void test_interrupts_masked_too_long_lose_a_frame_and_nothing_else(void)
{
    start(0);
    hv_vm.masked = true;
    hbus_say(OCTETS(0x05, 0x93)); /* the second octet finds the first one still there */
    hbus_run(30);
    hv_vm.masked = false;
    hbus_run(10);
    TEST_ASSERT_EQUAL(1, rx(HDLC_RX_OVERRUN));
    ANSWERS((0x05, 0x93), (0x05, 0x73));
}

static void mask_from_bit(unsigned bits)
{
    hbus_say(OCTETS(0x05, 0xF3, 0x55));
    hbus_run(bits);
    hv_vm.masked = true;
    hbus_run(40);
    hv_vm.masked = false;
    hbus_run(40);
}

static void test_underrun_sends_an_abort_and_no_half_frame(void)
{
    start(0);
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    hbus_clear();
    mask_from_bit(5);
    TEST_ASSERT_EQUAL(1, hdlc_8273_counters.tx[HDLC_TX_UNDERRUN]);
    TEST_ASSERT_EQUAL(0, hbus.answers);
    TEST_ASSERT_EQUAL(1, hbus.events[HB_ABORT]);
    ANSWERS((0x05, 0xF3, 0x55), (0x05, 0xF3, 0x55));
}

static void test_clear_to_send_lost_in_a_frame(void)
{
    start(0);
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    hbus_clear();
    hbus_say(OCTETS(0x05, 0xF3, 0x55));
    hbus_run(20);
    hal_8273_chip.cts = false;
    hbus_run(40);
    hal_8273_chip.cts = true;
    TEST_ASSERT_EQUAL(1, hdlc_8273_counters.tx[HDLC_TX_CTS]);
    TEST_ASSERT_EQUAL(0, hbus.answers);
    ANSWERS((0x05, 0xF3, 0x55), (0x05, 0xF3, 0x55));
}

static void test_clear_to_send_that_never_comes_ends_in_a_restart(void)
{
    for (unsigned reset_at_1 = 0; reset_at_1 < 2; reset_at_1++) {
        start_with(0, &(struct i8273_options){.reset_at_1 = reset_at_1 != 0});
        hal_8273_chip.cts = false;
        hbus_say(OCTETS(0x05, 0x93));
        hbus_run(5200); /* 722 ms */
        TEST_ASSERT_EQUAL(1, hdlc_8273_counters.tx[HDLC_TX_RESTARTS]);
        TEST_ASSERT_FALSE(hdlc_8273_sending());
        hal_8273_chip.cts = true;
        hbus_clear();
        hbus_run(60);
        TEST_ASSERT_EQUAL(0, hbus.driven); /* the frame that was given up does not come after all */
        ANSWERS((0x05, 0x11), (0x05, 0x11)); /* it was connected all the same */
    }
}

static void test_carrier_lost_in_a_frame(void)
{
    struct hb_line line = {0};
    start(0);
    hb_flag(&line), hb_stuffed(&line, snrm, 3);
    hbus_say_bits(&line);
    hal_8273_chip.cd = false;
    hbus_run(3);
    hal_8273_chip.cd = true;
    TEST_ASSERT_EQUAL(1, rx(HDLC_RX_CARRIER));
    ANSWERS((0x05, 0x93), (0x05, 0x73));
}

static void test_a_result_not_read_in_time(void)
{
    struct hb_line line = {0};
    start(0);
    for (unsigned k = 0; k < 2; k++) /* short frames: results without data */
        hb_flag(&line), hb_stuffed(&line, snrm, 3), hb_flag(&line);
    hv_vm.masked = true;
    hbus_say_bits(&line);
    hv_vm.masked = false;
    hbus_run(30);
    TEST_ASSERT_EQUAL(1, rx(HDLC_RX_OVERRUN) + rx(HDLC_RX_RESULTS));
    ANSWERS((0x05, 0x93), (0x05, 0x73));
}

static void test_dma_buffer_overflow(void)
{
    static uint8_t octets[HB_OCTETS] = {0x05, 0xF3};
    start(HDLC_8273_DMA);
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    hbus_clear();
    hbus_say(octets, HDLC_FRAME_MAX + 2u);
    hbus_run(60);
    TEST_ASSERT_EQUAL(1, rx(HDLC_RX_OVERFLOW));
    TEST_ASSERT_EQUAL(0, hbus.answers);
    ANSWERS((0x05, 0x11), (0x05, 0x11));
}

/* A good FCS, but the chip says that it gave us more or less than it did. */
static void test_a_count_that_does_not_fit(void)
{
    static const uint16_t wrong[] = {1, 3, 5, 100, 0x0102, 0x2002};
    for (unsigned k = 0; k < 2 * sizeof wrong / sizeof wrong[0]; k++) {
        start(k & 1u ? HDLC_8273_DMA : 0);
        hbus.out.n = 0;
        struct hb_line line = {0};
        hb_frame(&line, snrm, 2);
        line.n -= 1;
        hbus_say_bits(&line);
        hal_8273_chip.rx.count = wrong[k / 2];
        line = (struct hb_line){.n = 1, .bit = {0}};
        hbus_say_bits(&line);
        hbus_run(60);
        if (!(k & 1u) || wrong[k / 2] > HDLC_FRAME_MAX + 1u) /* DMA: the count is all there is */
            TEST_ASSERT_EQUAL(1, rx(HDLC_RX_COUNT) + rx(HDLC_RX_GOOD) * 100);
        ANSWERS((0x05, 0x93), (0x05, 0x73));
    }
}

static void test_a_late_interrupt_finds_the_last_octet_behind_the_result(void)
{
    struct hb_line line = {0}, end = {0};
    start(0);
    hb_frame(&line, snrm, 2);
    end.n = 10; /* the last octet is handed over, then the flag ends the frame */
    line.n -= end.n;
    memcpy(end.bit, line.bit + line.n, end.n);
    hbus_clear();
    hbus_say_bits(&line);
    hv_vm.masked = true;
    hbus_say_bits(&end);
    TEST_ASSERT_TRUE(hal_8273_chip.rx.full && hal_8273_chip.rx.results.n);
    hv_vm.masked = false;
    hbus_run(80);
    TEST_ASSERT_EQUAL(1, hbus.answers);
}

static void test_a_frame_waits_for_main_and_what_comes_meanwhile_is_lost(void)
{
    start(0);
    hv_set_loop(NULL, NULL);
    for (uint8_t k = 0; k < 3; k++) {
        hbus_say(OCTETS(0x05, 0x11, k));
        hbus_run(30);
    }
    TEST_ASSERT_EQUAL(1, rx(HDLC_RX_GOOD));
    TEST_ASSERT_EQUAL(2, rx(HDLC_RX_FULL));
    TEST_ASSERT_EQUAL(3, hdlc_8273_frame()->n);
    TEST_ASSERT_EQUAL(0, hdlc_8273_frame()->octets[2]);
    hdlc_8273_release();
    TEST_ASSERT_NULL(hdlc_8273_frame());
    hbus_say(OCTETS(0x05, 0x11, 7));
    hbus_run(30);
    TEST_ASSERT_EQUAL(7, hdlc_8273_frame()->octets[2]);
}

/* ---- commands --------------------------------------------------------------------------------------------- */

static void test_abort_stops_a_frame(void)
{
    start(0);
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    hbus_clear();
    hbus_say(OCTETS(0x05, 0xF3, 0x55, 0x55, 0x55, 0x55));
    hbus_run(30);
    hdlc_8273_abort();
    hbus_run(60);
    TEST_ASSERT_EQUAL(1, hdlc_8273_counters.tx[HDLC_TX_ABORTED]);
    TEST_ASSERT_EQUAL(0, hbus.answers);
    TEST_ASSERT_EQUAL(1, hbus.events[HB_ABORT]);
    TEST_ASSERT_FALSE(hdlc_8273_sending());
    ANSWERS((0x05, 0x11), (0x05, 0x11));
}

static void test_set_and_reset_of_every_mode_register(void)
{
    start(0);
    TEST_ASSERT_EQUAL_HEX8(0x20, hal_8273_chip.operating);
    TEST_ASSERT_EQUAL_HEX8(0x01, hal_8273_chip.transfer);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_SET_OPERATING, 0x03));
    TEST_ASSERT_EQUAL_HEX8(0x23, hal_8273_chip.operating);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_RESET_OPERATING, (uint8_t)~0x03));
    TEST_ASSERT_EQUAL_HEX8(0x20, hal_8273_chip.operating);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_SET_SERIAL, 0x01));
    TEST_ASSERT_EQUAL_HEX8(0x01, hal_8273_chip.serial_io);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_RESET_SERIAL, 0x00));
    TEST_ASSERT_EQUAL_HEX8(0x00, hal_8273_chip.serial_io);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_SET_DELAY, 0x80));
    TEST_ASSERT_EQUAL_HEX8(0x80, hal_8273_chip.delay);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_RESET_DELAY, 0x7F));
    TEST_ASSERT_EQUAL_HEX8(0x00, hal_8273_chip.delay);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_RESET_TRANSFER, 0xFE));
    TEST_ASSERT_EQUAL_HEX8(0x00, hal_8273_chip.transfer);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_SET_TRANSFER, 0x01));
    TEST_ASSERT_EQUAL_HEX8(0x01, hal_8273_chip.transfer);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_RESET_PORT_B, (uint8_t)~0x04));
    TEST_ASSERT_EQUAL_HEX8(0x3B, hal_8273_chip.port_b);
    TEST_ASSERT_TRUE(hdlc_8273_mask(HDLC_8273_SET_PORT_B, 0x04));
    TEST_ASSERT_EQUAL_HEX8(0x3F, hal_8273_chip.port_b);
}

static void test_ports_are_read(void)
{
    start(0);
    hal_8273_chip.pa = 0x14;
    TEST_ASSERT_EQUAL_HEX8(0x14, hdlc_8273_port(HDLC_8273_PORT_A)); /* CTS, CD active = low */
    hal_8273_chip.cts = false;
    TEST_ASSERT_EQUAL_HEX8(0x15, hdlc_8273_port(HDLC_8273_PORT_A));
    hal_8273_chip.option.ports_inverted = true;
    TEST_ASSERT_EQUAL_HEX8(0x16, hdlc_8273_port(HDLC_8273_PORT_A));
    hal_8273_chip.cts = true;
    TEST_ASSERT_EQUAL_HEX8(0x3E, hdlc_8273_port(HDLC_8273_PORT_B) & 0x3E);
}

static void test_our_own_frame_on_a_receiver_that_stays_on_is_not_heard(void)
{
    start(0);
    hbus.echo = true;
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    ANSWERS((0x05, 0x10, 0x01), (0x05, 0x30, 0x01));
    TEST_ASSERT_EQUAL(2, hdlc_nrm_counters.commands);
}

static void test_flags_between_frames_on_a_line_of_our_own(void)
{
    start(HDLC_8273_FLAGS);
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    hbus_run(40);
    TEST_ASSERT_TRUE(hal_8273_chip.rts); /* flags go on */
}

/* In loop-back a frame of ours comes back: a self-test of chip and interrupts without a line. */
static void test_loop_back(void)
{
    start(HDLC_8273_LOOP | HDLC_8273_ALL);
    hv_set_loop(NULL, NULL);
    hdlc_8273_out.octets[0] = 0x05;
    hdlc_8273_out.octets[1] = 0x93;
    hdlc_8273_send(2);
    hbus_run(80);
    TEST_ASSERT_EQUAL(1, hdlc_8273_counters.tx[HDLC_TX_GOOD]);
    TEST_ASSERT_EQUAL(2, hdlc_8273_frame()->n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x05, 0x93}), hdlc_8273_frame()->octets, 2);
}

/* ---- broken chips ------------------------------------------------------------------------------------------- */

static void test_a_chip_left_in_the_middle_of_a_command_is_set_up(void)
{
    for (unsigned reset_at_1 = 0; reset_at_1 < 2; reset_at_1++) {
        for (uint8_t given = 0; given < 4; given++) {
            hbus_begin();
            hal_8273_chip.option.reset_at_1 = reset_at_1 != 0;
            hal_8273_write(HAL_8273_COMMAND, 0xC1); /* four parameters */
            for (uint8_t i = 0; i < given; i++)
                hal_8273_write(HAL_8273_PARAMETER, 0xFF);
            hal_8273_chip.port_b = 0;
            mode = 0;
            hbus_station(init, hdlc_nrm_poll);
            hbus_run(20);
            ANSWERS((0x05, 0x93), (0x05, 0x73));
            if (!reset_at_1)
                TEST_ASSERT_EQUAL_HEX8(0x3F, hal_8273_chip.port_b); /* it was a reset, not only commands */
        }
    }
}

static void open_dead(void)
{
    TEST_ASSERT_FALSE(hdlc_nrm_init(5, 5, 0));
}

static void test_a_dead_chip_is_noticed_and_taken_into_service_when_it_comes_alive(void)
{
    hbus_begin();
    hal_8273_break(true, 0xFF); /* bus floats: CBSY for ever */
    hbus_station(open_dead, hdlc_nrm_poll);
    hbus_run(50);
    TEST_ASSERT_TRUE(hdlc_8273_counters.tx[HDLC_TX_RESTARTS] > 10);
    hal_8273_break(false, 0);
    hbus_run(5);
    ANSWERS((0x05, 0x93), (0x05, 0x73));
    i8273_power_on(&hal_8273_chip); /* it loses power and comes back, its registers empty: DMA, no receiver */
    hdlc_8273_open(0, 5, 5);
    hbus_run(5);
    ANSWERS((0x05, 0x11), (0x05, 0x11));
}

static void test_what_an_absent_chip_reads_as_does_not_stop_the_station(void)
{
    for (unsigned value = 0; value < 256; value++) {
        mode = (uint8_t)(value & (HDLC_8273_BUFFERED | HDLC_8273_DMA));
        hbus_begin();
        hal_8273_break(true, (uint8_t)value);
        hal_init();
        hdlc_nrm_init(5, 5, mode);
        hal_irq_restore(HAL_IRQ_ON);
        for (unsigned k = 0; k < 50; k++) {
            hv_vm.in_isr = true;
            chip_rx_isr();
            chip_tx_isr();
            hv_vm.in_isr = false;
            hdlc_nrm_poll();
        }
        hal_8273_break(false, 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_both_sides_of_every_disagreement_in_every_mode);
    RUN_TEST(test_idle_disables_the_receiver_and_is_met_by_arming_it_again);
    RUN_TEST(test_interrupts_masked_too_long_lose_a_frame_and_nothing_else);
    RUN_TEST(test_underrun_sends_an_abort_and_no_half_frame);
    RUN_TEST(test_clear_to_send_lost_in_a_frame);
    RUN_TEST(test_clear_to_send_that_never_comes_ends_in_a_restart);
    RUN_TEST(test_carrier_lost_in_a_frame);
    RUN_TEST(test_a_result_not_read_in_time);
    RUN_TEST(test_dma_buffer_overflow);
    RUN_TEST(test_a_count_that_does_not_fit);
    RUN_TEST(test_a_late_interrupt_finds_the_last_octet_behind_the_result);
    RUN_TEST(test_a_frame_waits_for_main_and_what_comes_meanwhile_is_lost);
    RUN_TEST(test_abort_stops_a_frame);
    RUN_TEST(test_set_and_reset_of_every_mode_register);
    RUN_TEST(test_ports_are_read);
    RUN_TEST(test_our_own_frame_on_a_receiver_that_stays_on_is_not_heard);
    RUN_TEST(test_flags_between_frames_on_a_line_of_our_own);
    RUN_TEST(test_loop_back);
    RUN_TEST(test_a_chip_left_in_the_middle_of_a_command_is_set_up);
    RUN_TEST(test_a_dead_chip_is_noticed_and_taken_into_service_when_it_comes_alive);
    RUN_TEST(test_what_an_absent_chip_reads_as_does_not_stop_the_station);
    return UNITY_END();
}
