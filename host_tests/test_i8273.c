/* The chip model itself, register by register, against the facts (1.2 to 1.8): a wrong model would prove a wrong
 * driver. No firmware here. */
#include "sim/hdlc_bits.h"
#include "sim/i8273.h"
#include "unity.h"

#include <string.h>

static struct i8273 chip;

void setUp(void)
{
    i8273_power_on(&chip);
}

void tearDown(void)
{
}

static uint8_t status(void)
{
    return i8273_read(&chip, I8273_COMMAND);
}

static void give(uint8_t command, const uint8_t *parameters, unsigned n)
{
    i8273_write(&chip, I8273_COMMAND, command);
    for (unsigned i = 0; i < n; i++)
        i8273_write(&chip, I8273_PARAMETER, parameters[i]);
}
#define COMMAND(command, ...)                                                                                  \
    give(command, ((const uint8_t[]){0, ##__VA_ARGS__}) + 1, sizeof((const uint8_t[]){0, ##__VA_ARGS__}) - 1)

static void hear(const struct hb_line *line)
{
    for (unsigned i = 0; i < line->n; i++) {
        i8273_shift_out(&chip);
        i8273_shift_in(&chip, line->bit[i]);
    }
}

/* Interrupt transfer: data as they come, then the result octets. */
static uint8_t data[64], result[8];
static unsigned data_n, result_n;

static void hear_and_take(const struct hb_line *line)
{
    data_n = result_n = 0;
    for (unsigned i = 0; i < line->n; i++) {
        i8273_shift_out(&chip);
        i8273_shift_in(&chip, line->bit[i]);
        while (status() & I8273_RXINT) {
            if (status() & I8273_RXIRA)
                result[result_n++] = i8273_read(&chip, I8273_RX_RESULT);
            else
                data[data_n++] = i8273_read(&chip, I8273_RX_DATA);
        }
    }
}

static void test_command_phase_shows_in_the_status(void)
{
    TEST_ASSERT_EQUAL_HEX8(0, status());
    i8273_write(&chip, I8273_COMMAND, 0x97);
    TEST_ASSERT_EQUAL_HEX8(I8273_CBSY, status());
    i8273_write(&chip, I8273_PARAMETER, 0x01);
    TEST_ASSERT_EQUAL_HEX8(0, status());
    TEST_ASSERT_EQUAL_HEX8(0x01, chip.transfer);
    i8273_write(&chip, I8273_COMMAND, 0x23);
    TEST_ASSERT_EQUAL_HEX8(I8273_CRBF, status());
    TEST_ASSERT_EQUAL_HEX8(0x3F, i8273_read(&chip, I8273_PARAMETER));
    TEST_ASSERT_EQUAL_HEX8(0, status());
}

static void test_a_command_in_the_middle_of_another_is_lost(void)
{
    i8273_write(&chip, I8273_COMMAND, 0xC1);
    i8273_write(&chip, I8273_COMMAND, 0x97);
    i8273_write(&chip, I8273_RX_RESULT, 0);
    TEST_ASSERT_EQUAL(1, chip.lost_commands);
    i8273_write(&chip, I8273_RESET, 1);
    i8273_write(&chip, I8273_RESET, 0);
    TEST_ASSERT_EQUAL_HEX8(0, status());
    i8273_write(&chip, I8273_COMMAND, 0x00); /* no such command */
    TEST_ASSERT_EQUAL(2, chip.lost_commands);
}

/* RBIL's table of D7..D5: bits of the last octet 1..7 are 00 80 40 C0 20 A0 60, whole octets E0; RTL: n-1. */
static void test_partial_octets(void)
{
    static const uint8_t rbil[8] = {0xE0, 0x00, 0x80, 0x40, 0xC0, 0x20, 0xA0, 0x60};
    static const uint8_t rtl[8] = {0xE0, 0x00, 0x20, 0x40, 0x60, 0x80, 0xA0, 0xC0};
    for (unsigned n = 0; n < 16; n++) {
        struct hb_line line = {0};
        uint16_t crc = 0xFFFF;
        setUp();
        chip.option.plain_partial = n >= 8;
        COMMAND(0x97, 0x01);
        COMMAND(0xC0, 0xFF, 0x00);
        hb_flag(&line);
        hb_stuffed(&line, (uint8_t[]){0x05, 0x10, 0x02}, 3);
        for (unsigned i = 0; i < 24; i++)
            crc = hb_crc_bit(crc, (0x021005u >> i) & 1u);
        for (unsigned i = 0; i < n % 8; i++)
            crc = hb_crc_bit(crc, (0x55u >> i) & 1u);
        hb_raw(&line, 0x55, n % 8);
        crc = (uint16_t)~crc;
        hb_stuffed(&line, (uint8_t[]){(uint8_t)crc, (uint8_t)(crc >> 8)}, 2);
        hb_flag(&line);
        hear_and_take(&line);
        TEST_ASSERT_EQUAL(3, result_n);
        TEST_ASSERT_EQUAL_HEX8(n < 8 ? rbil[n] : rtl[n - 8], result[0]);
        TEST_ASSERT_EQUAL(n % 8 ? 4 : 3, result[1]);
        TEST_ASSERT_EQUAL(result[1], data_n);
        if (n % 8)
            TEST_ASSERT_EQUAL_HEX8(0x55u & ((1u << n % 8) - 1u), data[3]);
    }
}

static void test_selective_receive_takes_two_addresses_and_no_other(void)
{
    static const uint8_t addresses[] = {0x05, 0xFF, 0x06, 0x04};
    static const uint8_t codes[] = {0xE0, 0xE1};
    COMMAND(0x97, 0x01);
    COMMAND(0xC1, 0xFF, 0x00, 0x05, 0xFF);
    for (unsigned i = 0; i < 4; i++) {
        struct hb_line line = {0};
        hb_frame(&line, (uint8_t[]){addresses[i], 0x93}, 2);
        hear_and_take(&line);
        TEST_ASSERT_EQUAL(i < 2 ? 3 : 0, result_n);
        TEST_ASSERT_EQUAL(i < 2 ? 2 : 0, data_n);
        if (i < 2)
            TEST_ASSERT_EQUAL_HEX8(codes[i], result[0]);
    }
}

static void test_buffered_frames_give_address_and_control_as_results(void)
{
    struct hb_line line = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0x91, 0x24);
    COMMAND(0xC0, 0xFF, 0x00);
    hb_frame(&line, (uint8_t[]){0x05, 0x10, 0x01, 0x03}, 4);
    hear_and_take(&line);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0xE0, 2, 0, 0x05, 0x10}), result, 5);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(((uint8_t[]){0x01, 0x03}), data, 2);
}

static void test_abort_idle_and_end_of_poll(void)
{
    struct hb_line line = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0x91, 0x20);
    COMMAND(0xC0, 0xFF, 0x00);
    hb_raw(&line, 0xFFFFF, 20); /* ones before any frame: nothing */
    hear_and_take(&line);
    TEST_ASSERT_EQUAL(0, result_n);
    line = (struct hb_line){0};
    hb_flag(&line), hb_stuffed(&line, (uint8_t[]){0x05, 0x10}, 2), hb_raw(&line, 0x7F, 7);
    hear_and_take(&line);
    TEST_ASSERT_EQUAL_HEX8(0x04, result[0]);
    TEST_ASSERT_TRUE(chip.rx.enabled);
    line = (struct hb_line){0};
    hb_raw(&line, 0xFF, 8); /* fifteen ones by now */
    hear_and_take(&line);
    TEST_ASSERT_EQUAL_HEX8(0x05, result[0]);
    TEST_ASSERT_FALSE(chip.rx.enabled);
    COMMAND(0x91, 0x10);
    COMMAND(0xC0, 0xFF, 0x00);
    line = (struct hb_line){0};
    hb_flag(&line), hb_raw(&line, 0xFE, 8);
    hear_and_take(&line);
    TEST_ASSERT_EQUAL_HEX8(0x06, result[0]);
}

/* What the chip sends, asked for octet by octet; -> bits while it drives. */
static unsigned send(const uint8_t *octets, unsigned n, struct hb_line *line)
{
    unsigned at = 0;
    line->n = 0;
    for (unsigned i = 0; i < 2000; i++) {
        while (status() & I8273_TXINT && !(status() & I8273_TXIRA) && at < n)
            i8273_write(&chip, I8273_TX_DATA, octets[at++]);
        i8273_shift_out(&chip);
        if (chip.rts)
            hb_raw(line, chip.txd, 1);
        else if (line->n)
            break;
        i8273_shift_in(&chip, true);
    }
    return line->n;
}

static void test_a_frame_goes_out_bit_for_bit(void)
{
    const uint8_t snrm[] = {0x05, 0x93};
    struct hb_line line = {0}, expected = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0xC8, 2, 0);
    TEST_ASSERT_EQUAL(49, send(snrm, 2, &line)); /* facts 2.6 */
    hb_frame(&expected, snrm, 2);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected.bit, line.bit, 49);
    TEST_ASSERT_EQUAL_HEX8(I8273_TXINT | I8273_TXIRA, status());
    TEST_ASSERT_EQUAL_HEX8(0x0D, i8273_read(&chip, I8273_RESET));
    TEST_ASSERT_EQUAL_HEX8(0, status());
}

static void test_nrzi_and_preframe(void)
{
    struct hb_line line = {0}, expected = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0x91, 0x02);
    COMMAND(0xA0, 0x01);
    COMMAND(0xC8, 2, 0);
    TEST_ASSERT_EQUAL(16 + 49, send((uint8_t[]){0x05, 0x93}, 2, &line));
    hb_raw(&expected, 0x0000, 16); /* an edge each bit */
    hb_frame(&expected, (uint8_t[]){0x05, 0x93}, 2);
    for (unsigned i = 0; i < line.n; i++) /* 0 toggles, 1 holds; the line was at 1 */
        TEST_ASSERT_EQUAL(expected.bit[i], line.bit[i] == (i ? line.bit[i - 1] : 1));
}

static void test_transparent_octets_go_out_as_they_are(void)
{
    struct hb_line line = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0xC9, 2, 0);
    TEST_ASSERT_EQUAL(16, send((uint8_t[]){0xFF, 0x7E}, 2, &line));
    for (unsigned i = 0; i < 16; i++)
        TEST_ASSERT_EQUAL((0x7EFFu >> i) & 1u, line.bit[i]);
    TEST_ASSERT_EQUAL_HEX8(0x0D, i8273_read(&chip, I8273_RESET));
}

static void test_an_underrun_sends_eight_ones(void)
{
    struct hb_line line = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0xC8, 3, 0);
    TEST_ASSERT_EQUAL(8 + 8 + 8, send((uint8_t[]){0x05}, 1, &line));
    for (unsigned i = 16; i < 24; i++)
        TEST_ASSERT_EQUAL(1, line.bit[i]);
    TEST_ASSERT_EQUAL_HEX8(0x0E, i8273_read(&chip, I8273_RESET));
}

static void test_a_loop_station_waits_for_the_go_ahead_and_delays_by_a_bit(void)
{
    struct hb_line line = {0};
    COMMAND(0x97, 0x01);
    COMMAND(0xA4, 0x80);
    for (unsigned i = 0; i < 32; i++) {
        const bool before = chip.rx.delayed;
        i8273_shift_out(&chip);
        TEST_ASSERT_EQUAL(before, chip.txd);
        i8273_shift_in(&chip, (0xB5u >> (i % 8)) & 1u);
    }
    COMMAND(0x64, 0x7F);
    COMMAND(0xCA, 2, 0);
    hb_raw(&line, 0x55, 8);
    hear(&line);
    TEST_ASSERT_EQUAL(TX_EOP, chip.tx.state);
    line = (struct hb_line){0};
    hb_raw(&line, 0xFE, 8); /* go-ahead: 0 and seven ones */
    hear(&line);
    TEST_ASSERT_EQUAL(49, send((uint8_t[]){0x05, 0x93}, 2, &line));
}

static void test_dma_requests(void)
{
    struct hb_line line = {0};
    COMMAND(0xC0, 0xFF, 0x00);
    hb_frame(&line, (uint8_t[]){0x05, 0x93, 0x11}, 3);
    line.n -= 16 + 8 - 7; /* the first octet is certain when two more and what may be a flag have come */
    hear(&line);
    TEST_ASSERT_TRUE(i8273_drq_rx(&chip));
    TEST_ASSERT_FALSE(i8273_int_rx(&chip));
    TEST_ASSERT_EQUAL_HEX8(0x05, i8273_read(&chip, I8273_RX_DATA));
    TEST_ASSERT_FALSE(i8273_drq_rx(&chip));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_command_phase_shows_in_the_status);
    RUN_TEST(test_a_command_in_the_middle_of_another_is_lost);
    RUN_TEST(test_partial_octets);
    RUN_TEST(test_selective_receive_takes_two_addresses_and_no_other);
    RUN_TEST(test_buffered_frames_give_address_and_control_as_results);
    RUN_TEST(test_abort_idle_and_end_of_poll);
    RUN_TEST(test_a_frame_goes_out_bit_for_bit);
    RUN_TEST(test_nrzi_and_preframe);
    RUN_TEST(test_transparent_octets_go_out_as_they_are);
    RUN_TEST(test_an_underrun_sends_eight_ones);
    RUN_TEST(test_a_loop_station_waits_for_the_go_ahead_and_delays_by_a_bit);
    RUN_TEST(test_dma_requests);
    return UNITY_END();
}
