/* The two lines, RTU and ASCII: frames and silences, bad frames, other stations' traffic, counters, event
 * log, listen-only mode. [A] application protocol V1.1b3, [S] serial line V1.02. */
#include "modbus_fixture.h"
#include "unity.h"

#include <string.h>

#define GOOD   "11 03 00 6B 00 01"
#define ANSWER "11 03 02 02 2B"

static const uint8_t request[] = {0x11, 0x06, 0x00, 0x01, 0x12, 0x34};

void setUp(void)
{
    fixture_begin(0x11, fixture_mode);
}

void tearDown(void)
{
    mbc_end();
}

static void silence_then_good(void)
{
    client.time_out = 60;
    TEST_ASSERT_EQUAL(0, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_MESSAGE(0, client.heard_n, "the station must be silent");
    TEST_ASSERT_EQUAL(0, fx.writes);
    memset(&client.wrong, 0, sizeof client.wrong);
    mbc_idle(40);
    ask(GOOD, ANSWER);
}

/* ---- RTU: silences ------------------------------------------------------------------------------------- */

static void gap(unsigned at, uint32_t tbit)
{
    client.wrong.gap_at = at;
    client.wrong.gap = tbit;
}

static void test_rtu_a_gap_of_one_character_is_allowed_at_every_place(void)
{
    for (unsigned at = 1; at < 8; at++) {
        gap(at, 11);
        ask(GOOD, ANSWER);
        gap(at, 16); /* 1.5 characters are 16.5 bits */
        ask(GOOD, ANSWER);
    }
}

static void test_rtu_a_gap_above_one_and_a_half_characters_spoils_the_frame(void)
{
    for (unsigned at = 1; at < 8; at++) {
        gap(at, 18);
        mbc_send(&client, request, sizeof request);
        silence_then_good();
        gap(at, 27);
        mbc_send(&client, request, sizeof request);
        silence_then_good();
    }
    TEST_ASSERT_EQUAL(14, mb_diag.counter[MB_BUS_ERROR]);
}

static void test_rtu_a_gap_above_19200_is_750_us(void)
{
    mb_port.bit_per_s = 115200;
    mb_open();
    mbc_idle(300);
    gap(4, 80); /* 86.4 bits */
    ask(GOOD, ANSWER);
    gap(4, 89);
    mbc_send(&client, request, sizeof request);
    mbc_idle(300);
    TEST_ASSERT_EQUAL(0, client.heard_n);
    TEST_ASSERT_EQUAL(0, fx.writes);
}

static void test_rtu_the_gap_can_be_configured_and_then_there_is_no_t15(void)
{
    mb_port.gap_tbit = 192; /* 10 ms, as for a USB adapter */
    mb_open();
    mbc_idle(250);
    for (unsigned at = 1; at < 8; at++) {
        gap(at, 150);
        ask(GOOD, ANSWER);
        TEST_ASSERT_GREATER_OR_EQUAL(192, client.answer_delay);
        mbc_idle(200);
    }
}

static void test_rtu_what_is_heard_before_the_first_t35_is_not_taken(void)
{
    static const uint8_t frame[] = {0x11, 0x03, 0x00, 0x6B, 0x00, 0x01, 0xF7, 0x46};
    mb_open();
    mbc_idle(20);
    mbc_put(&client, frame, sizeof frame);
    mbc_idle(400);
    TEST_ASSERT_EQUAL(0, client.heard_n);
    TEST_ASSERT_EQUAL(0, mb_diag.counter[MB_BUS_MESSAGE]);
    ask(GOOD, ANSWER);
}

/* ---- bad frames ---------------------------------------------------------------------------------------- */

static void test_bad_frames_are_dropped_and_counted(void)
{
    for (uint8_t mode = MB_RTU; mode <= MB_ASCII; mode++) {
        unsigned bad = 0;
        fixture_begin(0x11, mode);
        for (unsigned bit = 0; bit < (mode == MB_ASCII ? 8 : 16); bit++, bad++) {
            client.wrong.check_xor = (uint16_t)(1u << bit);
            mbc_send(&client, request, sizeof request);
            silence_then_good();
        }
        for (unsigned at = 0; at < (mode == MB_ASCII ? 17 : 8); at++) {
            static const uint8_t errs[] = {HAL_ERR_PARITY, HAL_ERR_FRAMING, HAL_ERR_OVERRUN};
            for (unsigned e = 0; e < 3; e++) {
                client.wrong.err_at = at;
                client.wrong.err = errs[e];
                mbc_send(&client, request, sizeof request);
                silence_then_good();
                bad += mode == MB_RTU || at > 0; /* in ASCII a ':' that is none starts nothing */
            }
        }
        TEST_ASSERT_EQUAL(bad, mb_diag.counter[MB_BUS_ERROR]);
        TEST_ASSERT_EQUAL(mode == MB_ASCII ? 16 : 8, mb_diag.counter[MB_OVERRUN]);
    }
}

static void test_short_and_long_frames_are_dropped(void)
{
    for (unsigned cut = 1; cut < 8; cut++) {
        client.wrong.cut = cut;
        mbc_send(&client, request, sizeof request);
        silence_then_good();
    }
    for (unsigned extra = 1; extra < 4; extra++) {
        client.wrong.extra = extra;
        mbc_send(&client, request, sizeof request);
        silence_then_good();
    }
}

/* Shorter than any frame, [S] appendix A, though the CRC is right: an address alone, and nothing at all. */
static void test_rtu_what_is_too_short_is_no_frame(void)
{
    ask_raw("11 7F 4C", NULL);
    ask_raw("FF FF", NULL);
    TEST_ASSERT_EQUAL(2, mb_diag.counter[MB_BUS_ERROR]);
    TEST_ASSERT_EQUAL(0, mb_diag.counter[MB_BUS_MESSAGE]);
}

/* Return query data, [A] 6.8: 11 08 00 00 04 05 06 ... */
static void body_of_256(void)
{
    for (unsigned i = hex_octets("11 08 00 00", body); i < 256; i++)
        body[i] = (uint8_t)i;
}

static void test_rtu_256_octets_are_a_frame_257_are_not(void)
{
    body_of_256();
    mbc_send(&client, body, 254);
    TEST_ASSERT_EQUAL(254, mbc_wait(&client, got)); /* echoed, [A] 6.8, sub-function 0 */
    TEST_ASSERT_EQUAL_HEX8_ARRAY(body, got, 254);
    mbc_idle(40);
    for (unsigned n = 255; n <= 256; n++) {
        mbc_send(&client, body, n);
        silence_then_good();
    }
    for (unsigned i = 0; i < 2; i++) { /* 512 octets that are two good frames of 256, but without a silence */
        mbc_frame(&client.coding, body, 254, 0, got);
        mbc_frame(&client.coding, body, 254, 0, got + 256);
        mbc_put(&client, got, 512);
        silence_then_good();
    }
}

/* ---- several stations on one line ---------------------------------------------------------------------- */

static void test_nothing_of_ours_is_lost_among_others(void)
{
    static const uint8_t noise[] = {0xFF}, truncated[] = {0x11, 0x06, 0x00, 0x01, 0x12},
                         foreign[] = {0x12, 0x03, 0x00, 0x6B, 0x00, 0x01, 0xF7, 0x75};
    static const struct {
        const uint8_t *octets;
        unsigned n;
    } before[] = {{noise, 1}, {truncated, sizeof truncated}, {foreign, sizeof foreign}};
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < 20; k++) {
            client.wrong.noise = before[i].octets;
            client.wrong.noise_n = before[i].n;
            client.wrong.noise_gap = 40;
            ask(GOOD, ANSWER);
        }
    }
    memset(&client.wrong, 0, sizeof client.wrong);
    for (unsigned k = 0; k < 20; k++) {
        ask("12 03 00 6B 00 01", NULL); /* an absent station: the client waits in vain */
        ask(GOOD, ANSWER);
        ask("13 06 00 01 00 05", NULL); /* another station answers with the same octets */
        ask("13 06 00 01 00 05", NULL);
        ask(GOOD, ANSWER);
        ask("12 83 02", NULL); /* another station's exception */
        ask(GOOD, ANSWER);
    }
    TEST_ASSERT_EQUAL(0, fx.writes);
    TEST_ASSERT_EQUAL(60 + 60, mb_diag.counter[MB_SLAVE_MESSAGE]);
    TEST_ASSERT_EQUAL(40, mb_diag.counter[MB_BUS_ERROR]);
}

/* On a line that comes in lumps: another station's answer and the next request without a silence between. */
static void test_lumps_are_told_apart_by_the_other_stations_crc(void)
{
    static const uint8_t foreign[] = {0x12, 0x03, 0x02, 0x00, 0x05, 0xFD, 0x84};
    mb_port.gap_tbit = 100;
    mb_open();
    mbc_idle(200);
    client.wrong.noise = foreign;
    client.wrong.noise_n = sizeof foreign;
    client.wrong.noise_gap = 0;
    for (unsigned i = 0; i < 5; i++) {
        ask(GOOD, ANSWER);
        mbc_idle(100);
    }
    TEST_ASSERT_EQUAL(10, mb_diag.counter[MB_BUS_MESSAGE]);
    TEST_ASSERT_EQUAL(0, mb_diag.counter[MB_BUS_ERROR]);
    mb_port.gap_tbit = 0; /* where silence shows it counts */
    mb_open();
    mbc_idle(200);
    mbc_send(&client, request, sizeof request);
    silence_then_good();
}

/* A write to us whose first octets are a good frame, too: only the whole of it counts. */
static void test_lumps_do_not_cut_a_frame_to_us(void)
{
    static const uint8_t frame[] = {0x11, 0x10, 0x00, 0x01, 0x00, 0x03, 0x06, 0x11, 0x06};
    uint16_t crc;
    mb_port.gap_tbit = 100;
    mb_open();
    mbc_idle(200);
    memcpy(body, frame, sizeof frame);
    crc = mbc_crc(body, 9);
    body[9] = (uint8_t)crc;
    body[10] = (uint8_t)(crc >> 8);
    body[11] = body[12] = 0x22;
    ask_body(13, "11 10 00 01 00 03");
    TEST_ASSERT_EQUAL_HEX16(0x2222, holding_0[3]);
}

static void test_an_octet_glued_to_a_request_spoils_only_that_request(void)
{
    static const uint8_t noise[] = {0x55};
    client.wrong.noise = noise;
    client.wrong.noise_n = 1;
    mbc_send(&client, request, sizeof request);
    silence_then_good();
}

/* ---- ASCII --------------------------------------------------------------------------------------------- */

static void test_ascii_a_colon_starts_anew_at_any_time(void)
{
    fixture_begin(0x11, MB_ASCII);
    ask_text(":1103006B0001:1103006B000180\r\n", ":110302022BBD\r\n");
    ask_text("::1103006B000180\r\n", ":110302022BBD\r\n");
    ask_text("noise 03\r\n\r\n:1103006B000180\r\n", ":110302022BBD\r\n");
    ask_text(":1103006B000180\r:1103006B000180\r\n", ":110302022BBD\r\n");
    TEST_ASSERT_EQUAL(3, mb_diag.counter[MB_BUS_ERROR]);
}

static void test_ascii_what_is_not_spelt_right_is_dropped(void)
{
    static const char *const wrong[] = {
        ":1103006B000180\n",
        ":1103006B000180\r\r\n",
        ":1103006B00018\r\n",
        ":1103006b000180\r\n",
        ":1103006B0001 80\r\n",
        ":1103006B000G80\r\n",
        ":1103006B0001 0\r\n",
        ":1103006B000181\r\n",
        ":11EF\r\n",
        ":\r\n",
        ":00\r\n",
        ":1103006B000180\r\xFF",
    };
    fixture_begin(0x11, MB_ASCII);
    for (unsigned i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        ask_text(wrong[i], NULL);
        ask_text(":1103006B000180\r\n", ":110302022BBD\r\n");
    }
    TEST_ASSERT_EQUAL(sizeof wrong / sizeof wrong[0], mb_diag.counter[MB_BUS_ERROR]);
}

static void test_ascii_characters_may_come_with_a_second_between_them(void)
{
    fixture_begin(0x11, MB_ASCII);
    for (unsigned at = 1; at < 17; at += 5) {
        client.wrong.gap_at = at;
        client.wrong.gap = mbc_tbit_of_ms(990);
        ask(GOOD, ANSWER);
    }
    TEST_ASSERT_EQUAL(0, mb_diag.counter[MB_BUS_ERROR]);
    for (unsigned at = 1; at < 17; at += 5) {
        client.wrong.gap_at = at;
        client.wrong.gap = mbc_tbit_of_ms(1010);
        mbc_send(&client, request, sizeof request);
        silence_then_good();
    }
    TEST_ASSERT_EQUAL(4, mb_diag.counter[MB_BUS_ERROR]);
}

static void test_ascii_the_time_between_characters_can_be_configured(void)
{
    fixture_begin(0x11, MB_ASCII);
    mb_port.octet_ms = 5000; /* [S] 2.5.2.1: 4 to 5 s where the network is wide */
    client.wrong.gap_at = 5;
    client.wrong.gap = mbc_tbit_of_ms(4900);
    ask(GOOD, ANSWER);
    client.wrong.gap = mbc_tbit_of_ms(5100);
    mbc_send(&client, request, sizeof request);
    silence_then_good();
}

static void test_ascii_513_characters_are_a_frame_515_are_not(void)
{
    fixture_begin(0x11, MB_ASCII);
    body_of_256();
    mbc_send(&client, body, 254);
    TEST_ASSERT_EQUAL(254, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL(513, client.heard_n);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(body, got, 254);
    mbc_idle(40);
    mbc_send(&client, body, 255);
    silence_then_good();
}

/* Our choice: the answer to the change still ends with the old delimiter. */
static void test_ascii_the_delimiter_can_be_changed(void)
{
    fixture_begin(0x11, MB_ASCII);
    ask_text(":110800032300C1\r\n", ":110800032300C1\r\n"); /* '#' is 23H */
    ask_text(":1103006B000180\r#", ":110302022BBD\r#");
    ask_text(":1103006B000180\r\n", NULL);
    client.coding.delimiter = '#';
    ask("11 08 00 03 00 0A", "11 88 03"); /* the character stands in the high octet; pymodbus does this */
    ask("11 08 00 03 00 00", "11 88 03");
    ask("11 08 00 03 3A 00", "11 88 03"); /* our choice: not ':', CR, a digit, or above 7FH */
    ask("11 08 00 03 0D 00", "11 88 03");
    ask("11 08 00 03 41 00", "11 88 03");
    ask("11 08 00 03 8A 00", "11 88 03");
    ask("11 08 00 01 00 00", "11 08 00 01 00 00");
    client.coding.delimiter = '\n';
    ask(GOOD, ANSWER); /* a restart brings LF back */
}

/* ---- opening ------------------------------------------------------------------------------------------- */

static void test_what_cannot_be_opened_changes_nothing(void)
{
    static const uint8_t bad[] = {0, 248, 255};
    for (unsigned i = 0; i < 3; i++) {
        mb_port.address = bad[i];
        TEST_ASSERT_EQUAL(HAL_LINE_NO, mb_open());
    }
    mb_port.address = 0x11;
    mb_port.mode = 2;
    TEST_ASSERT_EQUAL(HAL_LINE_NO, mb_open());
    mb_port.mode = MB_RTU;
    mb_port.bit_per_s = 12000001; /* this board has no such rate */
    TEST_ASSERT_EQUAL(HAL_LINE_NO, mb_open());
    ask(GOOD, ANSWER);
}

static void test_mode_rate_and_parity_are_chosen_at_run_time(void)
{
    static const uint32_t rates[] = {1200, 9600, 19200, 38400, 57600, 115200};
    static const uint8_t formats[2][3] = {{HAL_8E1, HAL_8O1, HAL_8N2}, {HAL_7E1, HAL_7O1, HAL_7N2}};
    for (unsigned r = 0; r < 6; r++)
        for (uint8_t mode = MB_RTU; mode <= MB_ASCII; mode++)
            for (unsigned f = 0; f < 3; f++) {
                mb_port.bit_per_s = rates[r];
                mb_port.mode = mode;
                mb_port.format = formats[mode][f];
                TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
                TEST_ASSERT_EQUAL(formats[mode][f], mbc_format());
                client.coding.mode = mode == MB_ASCII ? MBC_ASCII : MBC_RTU;
                mbc_idle(300);
                ask(GOOD, ANSWER);
                mbc_idle(300);
            }
}

/* ---- function 08, counters: [A] 6.8, [S] appendix A ---------------------------------------------------- */

static void test_return_query_data(void)
{
    ask("11 08 00 00 A5 37", "11 08 00 00 A5 37"); /* [A] 6.8 */
    ask("11 08 00 00 01 02 03 04 05", "11 08 00 00 01 02 03 04 05");
    ask("11 08 00", "11 88 03");
}

static void test_diagnostic_register(void)
{
    mb_diag.diagnostic = 0xBEEF;
    ask("11 08 00 02 00 00", "11 08 00 02 BE EF");
    ask("11 08 00 02 00 01", "11 88 03");
    ask("11 08 00 02 00", "11 88 03");
    ask("11 08 00 0A 00 00", "11 08 00 0A 00 00");
    ask("11 08 00 02 00 00", "11 08 00 02 00 00");
}

static void test_reserved_sub_functions(void)
{
    ask("11 08 00 05 00 00", "11 88 01");
    ask("11 08 00 09 00 00", "11 88 01");
    ask("11 08 00 13 00 00", "11 88 01");
    ask("11 08 00 15 00 00", "11 88 01");
    ask("11 08 01 00 00 00", "11 88 01");
    ask("11 08 FF FF 00 00", "11 88 01");
    ask("11 08 00 15", "11 88 01"); /* before the length is looked at */
}

/* One of each; the requests for the counters count, too. */
static void test_counters(void)
{
    ask(GOOD, ANSWER);
    ask("12 03 00 6B 00 01", NULL); /* another station's: bus message only */
    ask("11 03 77 77 00 01", "11 83 02");
    ask("00 06 00 01 12 34", NULL); /* broadcast: no response */
    fx.veto = MB_BUSY;
    ask("11 06 00 01 12 34", "11 86 06");
    fx.veto = MB_NEGATIVE_ACKNOWLEDGE;
    ask("11 06 00 01 12 34", "11 86 07");
    client.wrong.err_at = 1;
    client.wrong.err = HAL_ERR_OVERRUN;
    ask(GOOD, NULL);
    client.wrong.err = HAL_ERR_PARITY;
    ask(GOOD, NULL);
    memset(&client.wrong, 0, sizeof client.wrong);
    client.wrong.check_xor = 1;
    ask(GOOD, NULL);
    client.wrong.check_xor = 0;
    ask("11 08 00 0B 00 00", "11 08 00 0B 00 07"); /* 1: 6 good frames and this one */
    ask("11 08 00 0C 00 00", "11 08 00 0C 00 03"); /* 2: overrun, parity, CRC       */
    ask("11 08 00 0D 00 00", "11 08 00 0D 00 03"); /* 3: 02, 06, 07                 */
    ask("11 08 00 0E 00 00", "11 08 00 0E 00 09"); /* 4: 5 and these 4              */
    ask("11 08 00 0F 00 00", "11 08 00 0F 00 01"); /* 5                             */
    ask("11 08 00 10 00 00", "11 08 00 10 00 01"); /* 6: NAK                        */
    ask("11 08 00 11 00 00", "11 08 00 11 00 01"); /* 7: busy                       */
    ask("11 08 00 12 00 00", "11 08 00 12 00 01"); /* 8: overrun                    */
    ask("11 08 00 12 00 01", "11 88 03");
    ask("11 08 00 14 00 01", "11 88 03");
    ask("11 08 00 14 00 00", "11 08 00 14 00 00");
    ask("11 08 00 12 00 00", "11 08 00 12 00 00");
    ask("11 08 00 0A 00 00", "11 08 00 0A 00 00");
    ask("11 08 00 0C 00 00", "11 08 00 0C 00 00");
    ask("11 08 00 0D 00 00", "11 08 00 0D 00 00");
}

/* ---- functions 11 and 12: [A] 6.9, 6.10 ---------------------------------------------------------------- */

static void test_event_counter(void)
{
    ask("11 0B", "11 0B 00 00 00 00");
    ask(GOOD, ANSWER);
    ask(GOOD, ANSWER);
    ask("11 03 77 77 00 01", "11 83 02"); /* exceptions do not count */
    ask("11 0B", "11 0B 00 00 00 02");
    ask("11 0B", "11 0B 00 00 00 02"); /* nor does function 11 */
    ask("00 06 00 01 12 34", NULL);    /* a broadcast that was executed does */
    fx.busy = true;
    ask("11 0B", "11 0B FF FF 00 03");
    ask("11 08 00 0A 00 00", "11 08 00 0A 00 00");
    fx.busy = false;
    ask("11 0B", "11 0B 00 00 00 01"); /* our choice: 8/0AH counts itself, it succeeded after the clearing */
}

/* Our choice: the receive event of function 12 itself is in its answer, newest first. */
static void test_event_log(void)
{
    ask("11 0C", "11 0C 07 00 00 00 00 00 01 80");
    ask("11 03 77 77 00 01", "11 83 02");
    ask("11 0C", "11 0C 0B 00 00 00 01 00 03 80 41 80 40 80");
    ask("00 06 00 01 12 34", NULL);
    client.wrong.err_at = 1;
    client.wrong.err = HAL_ERR_OVERRUN;
    ask(GOOD, NULL);
    client.wrong.err = 0;
    client.wrong.check_xor = 1;
    ask(GOOD, NULL);
    client.wrong.check_xor = 0;
    ask("11 0C", "11 0C 11 00 00 00 03 00 05 80 82 92 40 C0 40 80 41 80 40 80");
}

static void test_send_events_by_exception(void)
{
    static const struct {
        uint8_t veto;
        const char *answer, *log;
    } of[] = {
        {4, "11 86 04", "11 0C 09 00 00 00 00 00 02 80 42 80"},
        {5, "11 86 05", "11 0C 09 00 00 00 00 00 02 80 44 80"},
        {6, "11 86 06", "11 0C 09 00 00 00 00 00 02 80 44 80"},
        {7, "11 86 07", "11 0C 09 00 00 00 00 00 02 80 48 80"},
        {8, "11 86 08", "11 0C 09 00 00 00 00 00 02 80 40 80"},
    };
    for (unsigned i = 0; i < sizeof of / sizeof of[0]; i++) {
        fixture_begin(0x11, fixture_mode);
        fx.veto = of[i].veto;
        ask("11 06 00 01 12 34", of[i].answer);
        ask("11 0C", of[i].log);
    }
}

static void test_the_log_holds_the_newest_64(void)
{
    static const uint8_t get_log[] = {0x11, 0x0C};
    for (unsigned i = 0; i < 40; i++)
        ask(GOOD, ANSWER);
    ask("11 03 77 77 00 01", "11 83 02");
    mbc_send(&client, get_log, sizeof get_log);
    TEST_ASSERT_EQUAL(2 + 1 + 6 + 64, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(70, got[2]);
    TEST_ASSERT_EQUAL_HEX8(0x80, got[9]);
    TEST_ASSERT_EQUAL_HEX8(0x41, got[10]);
    TEST_ASSERT_EQUAL_HEX8(0x40, got[72]);
}

/* ---- restart and listen-only: [A] 6.8.1 ---------------------------------------------------------------- */

static void test_restart_answers_first_then_clears_the_counters(void)
{
    for (uint8_t mode = MB_RTU; mode <= MB_ASCII; mode++) {
        fixture_begin(0x11, mode);
        ask(GOOD, ANSWER);
        ask("11 08 00 01 00 00", "11 08 00 01 00 00"); /* keeps the log and adds 00H */
        TEST_ASSERT_EQUAL(1, fx.restarts);
        ask("11 0B", "11 0B 00 00 00 00");
        ask("11 0C", "11 0C 0E 00 00 00 00 00 02 80 40 80 00 40 80 40 80");
        ask("11 08 00 01 FF 00", "11 08 00 01 FF 00"); /* clears the log, 00H is its only event */
        ask("11 0C", "11 0C 08 00 00 00 00 00 01 80 00");
        ask("11 08 00 01 00 01", "11 88 03");
        ask("11 08 00 01 01 00", "11 88 03");
        TEST_ASSERT_EQUAL(2, fx.restarts);
    }
}

static void test_listen_only_mode(void)
{
    for (uint8_t mode = MB_RTU; mode <= MB_ASCII; mode++) {
        fixture_begin(0x11, mode);
        ask("11 08 00 04 00 01", "11 88 03");
        ask("11 08 00 04 00 00", NULL);
        ask(GOOD, NULL);
        ask("11 06 00 01 12 34", NULL);
        ask("00 06 00 01 12 34", NULL);
        ask("11 63", NULL);
        ask("11 08 00 00 A5 37", NULL);
        ask("00 08 00 01 00 00", NULL); /* not by broadcast */
        ask("11 08 00 01 00 01", NULL); /* refused, and silent */
        TEST_ASSERT_EQUAL(0, fx.writes);
        TEST_ASSERT_EQUAL(0, fx.checks);
        TEST_ASSERT_TRUE(mb_diag.listen_only);
        TEST_ASSERT_EQUAL(9, mb_diag.counter[MB_SLAVE_MESSAGE]); /* messages are still monitored */
        TEST_ASSERT_EQUAL(8, mb_diag.counter[MB_NO_RESPONSE]);
        ask("11 08 00 01 00 00", NULL); /* the only way out, and it is not answered */
        TEST_ASSERT_FALSE(mb_diag.listen_only);
        ask(GOOD, ANSWER);
        ask("11 0C", "11 0C 1F 00 00 00 01 00 02 80 40 80 00 60 A0 61 A0 60 E0 60 A0 60 A0 60 E0 60 A0 60 A0 "
                     "60 04 80 41"
                     " 80");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rtu_a_gap_of_one_character_is_allowed_at_every_place);
    RUN_TEST(test_rtu_a_gap_above_one_and_a_half_characters_spoils_the_frame);
    RUN_TEST(test_rtu_a_gap_above_19200_is_750_us);
    RUN_TEST(test_rtu_the_gap_can_be_configured_and_then_there_is_no_t15);
    RUN_TEST(test_rtu_what_is_heard_before_the_first_t35_is_not_taken);
    RUN_TEST(test_bad_frames_are_dropped_and_counted);
    RUN_TEST(test_short_and_long_frames_are_dropped);
    RUN_TEST(test_rtu_what_is_too_short_is_no_frame);
    RUN_TEST(test_rtu_256_octets_are_a_frame_257_are_not);
    RUN_TEST(test_nothing_of_ours_is_lost_among_others);
    RUN_TEST(test_lumps_are_told_apart_by_the_other_stations_crc);
    RUN_TEST(test_lumps_do_not_cut_a_frame_to_us);
    RUN_TEST(test_an_octet_glued_to_a_request_spoils_only_that_request);
    RUN_TEST(test_ascii_a_colon_starts_anew_at_any_time);
    RUN_TEST(test_ascii_what_is_not_spelt_right_is_dropped);
    RUN_TEST(test_ascii_characters_may_come_with_a_second_between_them);
    RUN_TEST(test_ascii_the_time_between_characters_can_be_configured);
    RUN_TEST(test_ascii_513_characters_are_a_frame_515_are_not);
    RUN_TEST(test_ascii_the_delimiter_can_be_changed);
    RUN_TEST(test_what_cannot_be_opened_changes_nothing);
    RUN_TEST(test_mode_rate_and_parity_are_chosen_at_run_time);
    BOTH(test_return_query_data);
    BOTH(test_diagnostic_register);
    BOTH(test_reserved_sub_functions);
    BOTH(test_counters);
    BOTH(test_event_counter);
    BOTH(test_event_log);
    BOTH(test_send_events_by_exception);
    BOTH(test_the_log_holds_the_newest_64);
    RUN_TEST(test_restart_answers_first_then_clears_the_counters);
    RUN_TEST(test_listen_only_mode);
    return UNITY_END();
}
