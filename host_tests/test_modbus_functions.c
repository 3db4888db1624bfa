/* Every function of the server, octet by octet, in RTU and in ASCII. Where a clause is named, the octets are
 * its example or follow from it; [A] is the application protocol V1.1b3, [S] serial line V1.02. Bodies are
 * address and PDU; the client adds CRC or LRC by its own encoder, and the examples of the source document
 * stand here in full. */
#include "modbus_fixture.h"
#include "unity.h"

#include <string.h>

void setUp(void)
{
    fixture_begin(0x11, fixture_mode);
}

void tearDown(void)
{
    mbc_end();
    TEST_ASSERT_EQUAL_MESSAGE(fx.locks, fx.unlocks, "lock and unlock in pairs");
}

/* ---- the source document's examples, spec B6, as whole frames ------------------------------------------ */

static void test_examples_of_the_document_in_rtu(void)
{
    ask_raw("11 01 00 13 00 25 0E 84", "11 01 05 CD 6B B2 0E 1B 45 E6");
    ask_raw("11 02 00 C4 00 16 BA A9", "11 02 03 AC DB 35 20 18");
    ask_raw("11 03 00 6B 00 03 76 87", "11 03 06 02 2B 00 00 00 64 C8 BA");
    ask_raw("11 04 00 08 00 01 B2 98", "11 04 02 00 0A F8 F4");
    fixture_begin(0x06, MB_RTU);
    holding_6b[2] = 0x63;
    ask_raw("06 03 00 6B 00 03 75 A0", "06 03 06 02 2B 00 00 00 63 62 88"); /* 11 octets */
    fixture_begin(0x0A, MB_RTU);
    ask_raw("0A 01 04 A1 00 01 AC 63", "0A 81 02 B0 53");
}

static void test_examples_of_the_document_in_ascii(void)
{
    fixture_begin(0x11, MB_ASCII);
    ask_text(":110100130025B6\r\n", ":110105CD6BB20E1BD6\r\n");
    ask_text(":110200C4001613\r\n", ":110203ACDB352E\r\n");
    ask_text(":1103006B00037E\r\n", ":110306022B0000006455\r\n");
    ask_text(":110400080001E2\r\n", ":110402000ADF\r\n");
    fixture_begin(0x06, MB_ASCII);
    holding_6b[2] = 0x63;
    ask_text(":0603006B000389\r\n", ":060306022B0000006361\r\n"); /* 23 characters with CR LF */
    fixture_begin(0x0A, MB_ASCII);
    ask_text(":0A0104A100014F\r\n", ":0A810273\r\n"); /* LRCs 4F and 73 are the document's */
}

/* ---- 01, 02: [A] 6.1, 6.2 ------------------------------------------------------------------------------ */

static void test_reading_bits(void)
{
    ask("11 01 00 13 00 13", "11 01 03 CD 6B 02"); /* 19 coils: the last octet is padded with 0 */
    ask("11 02 00 C4 00 16", "11 02 03 AC DB 35"); /* [A] 6.2 */
    ask("11 01 00 15 00 08", "11 01 01 F3");       /* from the middle of an octet: CD 6B >> 2 */
    ask("11 01 00 37 00 01", "11 01 01 01");       /* the last coil of the block */
    ask("11 01 00 38 00 01", "11 81 02");
    ask("11 01 00 37 00 02", "11 81 02");
    ask("11 01 00 12 00 02", "11 81 02");
}

static void read_2000(uint8_t code, uint8_t flip)
{
    const uint8_t request[] = {0x11, code, 0x10, 0x00, 0x07, 0xD0};
    mbc_send(&client, request, sizeof request);
    TEST_ASSERT_EQUAL(253, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(250, got[2]);
    for (unsigned i = 0; i < 250; i++)
        TEST_ASSERT_EQUAL_HEX8((uint8_t)(i ^ flip), got[3 + i]);
    mbc_idle(40);
}

static void test_reading_2000_bits_is_allowed_2001_is_not(void)
{
    read_2000(0x01, 0x00);
    read_2000(0x02, 0xFF);
    ask("11 01 10 00 07 D1", "11 81 03");
    ask("11 02 10 00 07 D1", "11 82 03");
    ask("11 01 10 00 00 00", "11 81 03");
    ask("11 01 10 00 FF FF", "11 81 03");
    ask("11 02 00 00 00 00", "11 82 03"); /* quantity is looked at before the address: figures 11, 12 */
}

/* ---- 03, 04: [A] 6.3, 6.4 ------------------------------------------------------------------------------ */

static void test_reading_registers(void)
{
    ask("11 03 00 6B 00 03", "11 03 06 02 2B 00 00 00 64");
    ask("11 03 00 6D 00 01", "11 03 02 00 64");
    ask("11 04 00 08 00 01", "11 04 02 00 0A");
    ask("11 03 00 6A 00 01", "11 83 02");
    ask("11 03 00 6D 00 02", "11 83 02");
    ask("11 04 00 08 00 02", "11 84 02");
    ask("11 03 00 6B 00 00", "11 83 03");
    ask("11 03 00 6B 00 7E", "11 83 03");
    ask("11 04 00 00 00 7E", "11 84 03"); /* quantity before address: figure 14 */
    ask("11 03 00 6B 80 01", "11 83 03");
}

static void test_reading_125_registers(void)
{
    static const uint8_t request[] = {0x11, 0x04, 0x10, 0x00, 0x00, 0x7D};
    mbc_send(&client, request, sizeof request);
    TEST_ASSERT_EQUAL(253, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(250, got[2]);
    for (unsigned i = 0; i < 125; i++)
        TEST_ASSERT_EQUAL_HEX16(0x2000 + i, got[3 + 2 * i] << 8 | got[4 + 2 * i]);
}

static void test_the_last_address_is_65535_and_nothing_wraps(void)
{
    ask("11 03 FF FF 00 01", "11 03 02 10 7C");
    ask("11 03 FF FE 00 02", "11 03 04 10 7B 10 7C");
    ask("11 03 FF FF 00 02", "11 83 02"); /* not on to address 0, which exists */
    ask("11 10 FF FF 00 02 04 12 34 56 78", "11 90 02");
    TEST_ASSERT_EQUAL_HEX16(0x107C, holding_big[124]);
    TEST_ASSERT_EQUAL_HEX16(0, holding_0[0]);
}

/* ---- 05, 06: [A] 6.5, 6.6 ------------------------------------------------------------------------------ */

static void test_writing_a_coil(void)
{
    ask("11 05 00 AC FF 00", "11 05 00 AC FF 00"); /* [A] 6.5 */
    TEST_ASSERT_EQUAL_HEX8(0x01, coils_ac[0]);
    ask("11 05 00 B5 FF 00", "11 05 00 B5 FF 00");
    TEST_ASSERT_EQUAL_HEX8(0x02, coils_ac[1]);
    ask("11 05 00 AC 00 00", "11 05 00 AC 00 00");
    TEST_ASSERT_EQUAL_HEX8(0x00, coils_ac[0]);
    TEST_ASSERT_EQUAL(3, fx.writes);
    ask("11 05 00 AC 00 01", "11 85 03"); /* neither 0000 nor FF00: the output is untouched */
    ask("11 05 00 AC FF FF", "11 85 03");
    ask("11 05 00 AC 01 00", "11 85 03");
    ask("11 05 00 AC FE 00", "11 85 03");
    ask("11 05 77 77 12 34", "11 85 03"); /* value before address: figure 15 */
    ask("11 05 77 77 FF 00", "11 85 02");
    TEST_ASSERT_EQUAL(3, fx.writes);
    TEST_ASSERT_EQUAL_HEX8(0x00, coils_ac[0]);
}

static void test_writing_a_register(void)
{
    ask("11 06 00 01 00 03", "11 06 00 01 00 03"); /* [A] 6.6 */
    TEST_ASSERT_EQUAL_HEX16(3, holding_0[1]);
    ask("11 06 00 20 00 03", "11 86 02");
    ask("11 06 00 01 DE AD", "11 86 03"); /* the application does not want it */
    TEST_ASSERT_EQUAL_HEX16(3, holding_0[1]);
}

/* ---- 07: [A] 6.7 --------------------------------------------------------------------------------------- */

static void test_exception_status(void)
{
    fx.status = 0x6D;
    ask("11 07", "11 07 6D");
    ask("11 07 00", "11 87 03"); /* wrong length: 03, [S] appendix A */
}

/* ---- 15, 16: [A] 6.11, 6.12 ---------------------------------------------------------------------------- */

static void test_writing_coils(void)
{
    ask("11 0F 00 13 00 0A 02 32 00", "11 0F 00 13 00 0A");
    TEST_ASSERT_EQUAL_HEX8(0x32, coils_13[0]);
    TEST_ASSERT_EQUAL_HEX8(0x68, coils_13[1]); /* bits 0, 1 written, the others as they were */
    ask("11 0F 00 AE 00 04 01 0F", "11 0F 00 AE 00 04");
    TEST_ASSERT_EQUAL_HEX8(0x3C, coils_ac[0]);
    ask("11 0F 00 B1 00 08 01 FF", "11 0F 00 B1 00 08"); /* over an octet's end */
    TEST_ASSERT_EQUAL_HEX8(0xFC, coils_ac[0]);
    TEST_ASSERT_EQUAL_HEX8(0x1F, coils_ac[1]);
    TEST_ASSERT_EQUAL(3, fx.writes);
    ask("11 0F 00 13 00 00 00", "11 8F 03");
    ask("11 0F 00 13 00 0A 01 CD", "11 8F 03"); /* ten bits are two octets */
    ask("11 0F 00 13 00 08 02 CD 01", "11 8F 03");
    ask("11 0F 00 13 00 0A 02 CD", "11 8F 03"); /* one octet is missing */
    ask("11 0F 00 13 00 0A 02 CD 01 00", "11 8F 03");
    ask("11 0F 00 00 00 0A 01 CD", "11 8F 03"); /* count before address: figure 21 */
    ask("11 0F 00 00 00 08 01 CD", "11 8F 02");
    ask("11 0F 00 33 00 08 01 CD", "11 8F 02"); /* the last three do not exist: none is written */
    TEST_ASSERT_EQUAL(3, fx.writes);
    TEST_ASSERT_EQUAL_HEX8(0x1B, coils_13[4]);
}

static void write_bits(uint16_t qty, uint8_t octets, const char *answer)
{
    hex_octets("11 0F 10 00", body);
    body[4] = (uint8_t)(qty >> 8);
    body[5] = (uint8_t)qty;
    body[6] = octets;
    memset(body + 7, 0xA5, octets);
    ask_body(7u + octets, answer);
}

static void test_writing_1968_bits_is_allowed_1969_is_not(void)
{
    write_bits(1968, 246, "11 0F 10 00 07 B0");
    for (unsigned i = 0; i < 246; i++)
        TEST_ASSERT_EQUAL_HEX8(0xA5, coils_big[i]);
    TEST_ASSERT_EQUAL_HEX8(246, coils_big[246]);
    write_bits(1969, 247, "11 8F 03");
}

static void test_writing_registers(void)
{
    ask("11 10 00 01 00 02 04 00 0A 01 02", "11 10 00 01 00 02"); /* [A] 6.12 */
    TEST_ASSERT_EQUAL_HEX16(0x000A, holding_0[1]);
    TEST_ASSERT_EQUAL_HEX16(0x0102, holding_0[2]);
    ask("11 10 00 01 00 00 00", "11 90 03");
    ask("11 10 00 01 00 00 06 00 01 00 02 00 03", "11 90 03"); /* libmodbus' own test sends this one */
    ask("11 10 00 01 00 02 02 00 0A", "11 90 03");
    ask("11 10 00 01 00 01 04 00 0A 01 02", "11 90 03");
    ask("11 10 00 01 00 02 04 00 0A 01", "11 90 03"); /* short: nothing of the CRC is written */
    ask("11 10 00 01 80 01 02 00 0A", "11 90 03");
    ask("11 10 77 77 00 02 02 00 0A", "11 90 03"); /* count before address: figure 22 */
    ask("11 10 77 77 00 01 02 00 0A", "11 90 02");
    TEST_ASSERT_EQUAL(1, fx.writes);
}

static void write_registers(uint8_t qty, const char *answer)
{
    hex_octets("11 10 FF 83 00", body);
    body[5] = qty;
    body[6] = (uint8_t)(2 * qty);
    for (unsigned i = 0; i < 2u * qty; i++)
        body[7 + i] = (uint8_t)i;
    ask_body(7u + 2u * qty, answer);
}

/* 200 registers are 400 octets, which an octet would call 144. */
static void test_a_count_that_would_overflow_its_octet(void)
{
    memset(body + hex_octets("11 10 FF 83 00 C8 90", body), 0, 144);
    ask_body(7 + 144, "11 90 03");
}

static void test_writing_123_registers(void)
{
    write_registers(123, "11 10 FF 83 00 7B");
    TEST_ASSERT_EQUAL_HEX16(0x0001, holding_big[0]);
    TEST_ASSERT_EQUAL_HEX16(0xF4F5, holding_big[122]);
    TEST_ASSERT_EQUAL_HEX16(0x107B, holding_big[123]);
}

/* ---- all or nothing ------------------------------------------------------------------------------------ */

static void test_a_write_changes_all_or_nothing(void)
{
    ask("11 10 00 1E 00 03 06 11 11 22 22 33 33", "11 90 02"); /* 001EH, 001FH exist, 0020H does not */
    TEST_ASSERT_EQUAL_HEX16(0, holding_0[0x1E]);
    ask("11 10 00 01 00 03 06 11 11 22 22 DE AD", "11 90 03"); /* the application refuses the last value */
    TEST_ASSERT_EQUAL_HEX16(0, holding_0[1]);
    TEST_ASSERT_EQUAL(0, fx.writes);
}

static void test_the_application_can_refuse_with_any_exception(void)
{
    static const struct {
        uint8_t veto;
        const char *answer;
    } of[] = {{3, "11 90 03"}, {4, "11 90 04"}, {5, "11 90 05"},
              {6, "11 90 06"}, {7, "11 90 07"}, {8, "11 90 08"}};
    for (unsigned i = 0; i < sizeof of / sizeof of[0]; i++) {
        fx.veto = of[i].veto;
        ask("11 10 00 01 00 01 02 12 34", of[i].answer);
    }
    fx.read_veto = MB_BUSY;
    ask("11 03 00 6B 00 01", "11 83 06");
    TEST_ASSERT_EQUAL_HEX16(0, holding_0[1]);
}

static void test_blocks_without_memory_go_to_the_application(void)
{
    ask("11 10 02 01 00 02 04 12 34 56 78", "11 10 02 01 00 02");
    TEST_ASSERT_EQUAL_HEX16(0x1234, fx.callback[1]);
    TEST_ASSERT_EQUAL_HEX16(0x5678, fx.callback[2]);
    ask("11 03 02 00 00 04", "11 03 08 00 00 12 34 56 78 00 00");
    ask("11 0F 03 02 00 03 01 05", "11 0F 03 02 00 03");
    TEST_ASSERT_EQUAL_HEX8(0x14, fx.callback_bits);
    ask("11 01 03 00 00 08", "11 01 01 14");
    ask("11 01 03 02 00 03", "11 01 01 05");
    ask("11 05 03 07 FF 00", "11 05 03 07 FF 00");
    TEST_ASSERT_EQUAL_HEX8(0x94, fx.callback_bits);
}

static void test_files_and_queues_without_memory_go_to_the_application(void)
{
    ask("11 15 0B 06 00 0B 00 01 00 02 12 34 56 78", "11 15 0B 06 00 0B 00 01 00 02 12 34 56 78");
    TEST_ASSERT_EQUAL_HEX16(0x1234, fx.callback[1]);
    ask("11 14 07 06 00 0B 00 01 00 02", "11 14 06 05 06 12 34 56 78");
    ask("11 14 07 06 00 0B 00 03 00 02", "11 94 02");
    ask("11 18 07 00", "11 18 00 06 00 02 11 11 11 12");
}

/* ---- 17: [A] 6.13 -------------------------------------------------------------------------------------- */

static void test_server_id(void)
{
    ask("11 11", "11 11 02 00 FF"); /* the default: id 0, running */
}

/* ---- 20, 21: [A] 6.14, 6.15 ---------------------------------------------------------------------------- */

static void test_reading_files(void)
{
    ask("11 14 0E 06 00 04 00 01 00 02 06 00 03 00 09 00 02", "11 14 0C 05 06 0D FE 00 20 05 06 33 CD 00 40");
    ask("11 14 07 06 00 04 00 02 00 01", "11 14 04 03 06 00 20");
    ask("11 14 00", "11 94 03");
    ask("11 14 06 06 00 04 00 02 00", "11 94 03");
    ask("11 14 08 06 00 04 00 02 00 01 06", "11 94 03"); /* a group is not complete */
    ask("11 14 07 06 00 04 00 02 00 00", "11 94 03");    /* our choice: length 0 */
    ask("11 14 07 05 00 04 00 02 00 01", "11 94 02");    /* reference type: figure 24 */
    ask("11 14 07 06 00 00 00 02 00 01", "11 94 02");    /* file 0 */
    ask("11 14 07 06 00 05 00 02 00 01", "11 94 02");    /* no such file */
    ask("11 14 07 06 00 04 00 10 00 01", "11 94 02");    /* behind its end */
    ask("11 14 07 06 00 04 00 0F 00 02", "11 94 02");    /* over its end */
    ask("11 14 07 06 00 04 27 10 00 01", "11 94 02");    /* records end at 270FH */
    ask("11 14 0E 06 00 04 00 01 00 02 06 00 05 00 09 00 02", "11 94 02");
}

static void test_reading_as_much_of_files_as_an_answer_holds(void)
{
    mbc_send(&client, body, hex_octets("11 14 07 06 00 09 00 00 00 7C", body)); /* 2 + 2 + 248 = 252 octets of 253 */
    TEST_ASSERT_EQUAL(253, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(250, got[2]);
    TEST_ASSERT_EQUAL_HEX8(249, got[3]);
    TEST_ASSERT_EQUAL_HEX8(123, got[252]);
    mbc_idle(40);
    ask("11 14 07 06 00 09 00 00 00 7D", "11 94 03");
    ask("11 14 07 06 00 09 00 00 FF FF", "11 94 03");
    ask("11 14 0E 06 00 09 00 00 00 64 06 00 09 00 00 00 18", "11 94 03");
}

/* Many short groups behind a long one: the answer overtakes its request, which must not be overwritten. */
static void test_reading_many_groups(void)
{
    uint8_t *group = body + hex_octets("11 14 F5", body); /* 35 of 7 octets */
    for (unsigned i = 0; i < 35; i++, group += 7) {
        hex_octets("06 00 09 00 00 00 01", group);
        group[4] = (uint8_t)(i + 1);
    }
    body[3 + 6] = 50;
    mbc_send(&client, body, 3 + 35 * 7);
    TEST_ASSERT_EQUAL(3 + 102 + 34 * 4, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(101, got[3]);
    for (unsigned i = 1; i < 35; i++) {
        const uint8_t record[] = {3, 6, 0, (uint8_t)(i + 1)};
        TEST_ASSERT_EQUAL_HEX8_ARRAY(record, got + 105 + 4 * (i - 1), 4);
    }
}

static void test_records_end_at_270f(void)
{
    file_10[0x270F] = 0x5AA5;
    ask("11 14 07 06 00 0A 27 0F 00 01", "11 14 04 03 06 5A A5");
    ask("11 14 07 06 00 0A 27 10 00 01", "11 94 02"); /* there, but records have no such number */
    ask("11 14 07 06 00 0A 27 0F 00 02", "11 94 02");
    ask("11 15 09 06 00 0A 27 10 00 01 06 AF", "11 95 02");
    TEST_ASSERT_EQUAL_HEX16(0, file_10[0x2710]);
}

static void test_writing_files(void)
{
    ask("11 15 0D 06 00 04 00 07 00 03 06 AF 04 BE 10 0D", "11 15 0D 06 00 04 00 07 00 03 06 AF 04 BE 10 0D");
    TEST_ASSERT_EQUAL_HEX16(0x06AF, file_4[7]);
    TEST_ASSERT_EQUAL_HEX16(0x100D, file_4[9]);
    ask("11 15 12 06 00 03 00 00 00 01 11 11 06 00 04 00 00 00 01 22 22",
        "11 15 12 06 00 03 00 00 00 01 11 11 06 00 04 00 00 00 01 22 22");
    TEST_ASSERT_EQUAL_HEX16(0x1111, file_3[0]);
    TEST_ASSERT_EQUAL_HEX16(0x2222, file_4[0]);
    ask("11 15 12 06 00 03 00 00 00 01 33 33 06 00 07 00 00 00 01 44 44",
        "11 95 02"); /* no file 7: no write at all */
    TEST_ASSERT_EQUAL_HEX16(0x1111, file_3[0]);
    ask("11 15 08 06 00 04 00 07 00 01 06", "11 95 03");
    ask("11 15 09 06 00 04 00 07 00 02 06 AF", "11 95 03");
    ask("11 15 09 06 00 04 00 07 00 00 06 AF", "11 95 03");
    ask("11 15 09 07 00 04 00 07 00 01 06 AF", "11 95 02");
    ask("11 15 09 06 00 00 00 07 00 01 06 AF", "11 95 02");
    ask("11 15 09 06 00 04 00 10 00 01 06 AF", "11 95 02");
    ask("11 15 09 06 00 04 27 10 00 01 06 AF", "11 95 02");
}

static void test_writing_a_file_with_the_longest_request(void)
{
    hex_octets("11 15 FB 06 00 09 00 04 00 7A", body);
    for (unsigned i = 0; i < 244; i++)
        body[10 + i] = (uint8_t)(255 - i);
    mbc_send(&client, body, 3 + 0xFB); /* text and table allow FBH, the figure F5H */
    TEST_ASSERT_EQUAL(3 + 0xFB, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(body, got, 3 + 0xFB);
    TEST_ASSERT_EQUAL_HEX16(0xFFFE, file_9[4]);
    TEST_ASSERT_EQUAL_HEX16(0x0D0C, file_9[125]);
}

/* ---- 22, 23, 24: [A] 6.16, 6.17, 6.18 ------------------------------------------------------------------ */

static void test_mask_write(void)
{
    holding_0[4] = 0x0012;
    ask("11 16 00 04 00 F2 00 25", "11 16 00 04 00 F2 00 25"); /* (0012 and F2) or (25 and not F2) = 0017 */
    TEST_ASSERT_EQUAL_HEX16(0x0017, holding_0[4]);
    ask("11 16 00 20 00 F2 00 25", "11 96 02");
    ask("11 16 00 04 00 F2 00", "11 96 03");
    fx.veto = MB_BUSY;
    ask("11 16 00 04 00 00 00 25", "11 96 06");
    TEST_ASSERT_EQUAL_HEX16(0x0017, holding_0[4]);
}

static void test_read_write_registers(void)
{
    ask("11 17 00 03 00 06 00 0E 00 03 06 00 FF 00 FE 00 FD", "11 17 0C 00 FE 0A CD 00 01 00 03 00 0D 00 FF");
    TEST_ASSERT_EQUAL_HEX16(0x00FF, holding_0[14]);
    TEST_ASSERT_EQUAL_HEX16(0x00FD, holding_0[16]);
    ask("11 17 00 0E 00 01 00 0E 00 01 02 12 34", "11 17 02 12 34"); /* the write comes first */
    ask("11 17 00 03 00 00 00 0E 00 01 02 12 34", "11 97 03");
    ask("11 17 00 03 00 7E 00 0E 00 01 02 12 34", "11 97 03");
    ask("11 17 00 03 00 01 00 0E 00 00 00", "11 97 03");
    ask("11 17 00 03 00 01 00 0E 00 02 02 12 34", "11 97 03");
    ask("11 17 77 77 00 7E 00 0E 00 01 02 12 34", "11 97 03"); /* quantities before addresses: figure 27 */
    ask("11 17 77 77 00 01 00 0E 00 01 02 55 55", "11 97 02"); /* what cannot be read: not written either */
    ask("11 17 00 03 00 01 77 77 00 01 02 55 55", "11 97 02");
    TEST_ASSERT_EQUAL_HEX16(0x1234, holding_0[14]);
}

static void test_read_write_at_its_limits(void)
{
    hex_octets("11 17 FF 83 00 7D FF 83 00 79 F2", body);
    for (unsigned i = 0; i < 242; i++)
        body[11 + i] = (uint8_t)(i + 1);
    mbc_send(&client, body, 11 + 242);
    TEST_ASSERT_EQUAL(253, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(250, got[2]);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(body + 11, got + 3, 242);
    TEST_ASSERT_EQUAL_HEX16(0x1079, got[245] << 8 | got[246]);
}

static void test_fifo(void)
{
    ask("11 18 04 DE", "11 18 00 06 00 02 01 B8 12 84"); /* [A] 6.18 */
    ask("11 18 04 DE", "11 18 00 06 00 02 01 B8 12 84"); /* reading takes nothing away */
    fifo_4de[0] = 0;
    ask("11 18 04 DE", "11 18 00 02 00 00");
    ask("11 18 04 DF", "11 98 02"); /* inside the queue: not its pointer address */
    ask("11 18 00 00", "11 98 02");
    ask("11 18 05 00", "11 98 03"); /* 32 values: too many */
    ask("11 18 06 00", "11 98 04"); /* our choice: a count its memory cannot hold */
    ask("11 18 04", "11 98 03");
}

static void test_fifo_of_31(void)
{
    static const uint8_t request[] = {0x11, 0x18, 0x04, 0xDE};
    for (uint16_t i = 0; i < 32; i++)
        fifo_4de[i] = i ? i : 31;
    mbc_send(&client, request, sizeof request);
    TEST_ASSERT_EQUAL(2 + 2 + 2 + 62, mbc_wait(&client, got));
    TEST_ASSERT_EQUAL_HEX8(0x40, got[3]);
    TEST_ASSERT_EQUAL_HEX8(31, got[67]);
}

/* ---- 43: [A] 6.19 to 6.21; more of it in test_modbus_identification.c ---------------------------------- */

static void test_encapsulated_interface(void)
{
    ask("11 2B 0E 01 00", "11 2B 0E 01 81 00 00 03 00 09 46 69 65 6C 64 6C 69 6E 67 01 01 30 02 01 30");
    ask("11 2B 0E 04 01", "11 2B 0E 04 81 00 00 01 01 01 30");
    ask("11 2B 0E 02 00", "11 2B 0E 02 81 00 00 03 00 09 46 69 65 6C 64 6C 69 6E 67 01 01 30 02 01 30");
    ask("11 2B 0E 03 02", "11 2B 0E 03 81 00 00 01 02 01 30"); /* asked from object 2 on */
    ask("11 2B 0E 01 07", "11 2B 0E 01 81 00 00 03 00 09 46 69 65 6C 64 6C 69 6E 67 01 01 30 02 01 30");
    ask("11 2B 0E 04 07", "11 AB 02");
    ask("11 2B 0E 00 00", "11 AB 03");
    ask("11 2B 0E 05 00", "11 AB 03");
    ask("11 2B 0E 05 77", "11 AB 03");
    ask("11 2B 0E 01", "11 AB 03");
    ask("11 2B 0D 00 00", "11 AB 01"); /* CANopen: nothing installed */
    ask("11 2B 0C 01 00", "11 AB 01");
    ask("11 2B", "11 AB 03");
}

/* ---- what is no function ------------------------------------------------------------------------------- */

static void test_unknown_functions(void)
{
    ask("11 00", "11 80 01");
    ask("11 09 00 00", "11 89 01");
    ask("11 0D", "11 8D 01");
    ask("11 13", "11 93 01");
    ask("11 42 01 02", "11 C2 01");
    ask("11 7F", "11 FF 01");
    ask("11 80", "11 80 01");
    ask("11 FF", "11 FF 01");
}

static void test_wrong_length_is_exception_3(void)
{
    ask("11 01 00 13 00", "11 81 03");
    ask("11 03 00 6B 00 01 00", "11 83 03");
    ask("11 05 00 AC FF", "11 85 03");
    ask("11 06 00 01 00 03 00", "11 86 03");
    ask("11 0B 00", "11 8B 03");
    ask("11 0C 00", "11 8C 03");
    ask("11 0F 00 13 00", "11 8F 03");
    ask("11 10", "11 90 03");
    ask("11 11 00", "11 91 03");
    ask("11 14", "11 94 03");
    ask("11 17 00 03 00 01 00 0E 00 01", "11 97 03");
    ask("11 2B", "11 AB 03");
}

static void test_user_functions_are_rows(void)
{
    ask("11 41 03 01 02 03", "11 41 06");
    ask("11 41 03 01 02", "11 C1 03");
    ask("11 6E 55", "11 EE 06");
}

/* ---- broadcast: [S] 2.1 -------------------------------------------------------------------------------- */

static void test_broadcast_writes_are_executed_and_never_answered(void)
{
    ask("00 05 00 AC FF 00", NULL);
    TEST_ASSERT_EQUAL_HEX8(0x01, coils_ac[0]);
    ask("00 06 00 01 12 34", NULL);
    TEST_ASSERT_EQUAL_HEX16(0x1234, holding_0[1]);
    ask("00 0F 00 13 00 08 01 55", NULL);
    TEST_ASSERT_EQUAL_HEX8(0x55, coils_13[0]);
    ask("00 10 00 02 00 01 02 56 78", NULL);
    TEST_ASSERT_EQUAL_HEX16(0x5678, holding_0[2]);
    ask("00 15 09 06 00 04 00 07 00 01 06 AF", NULL);
    TEST_ASSERT_EQUAL_HEX16(0x06AF, file_4[7]);
    holding_0[4] = 0x0012;
    ask("00 16 00 04 00 F2 00 25", NULL); /* our choice: 22 is a write */
    TEST_ASSERT_EQUAL_HEX16(0x0017, holding_0[4]);
    ask("00 41 01 01", NULL);
    TEST_ASSERT_EQUAL(7, fx.writes);
    TEST_ASSERT_EQUAL(0, mb_diag.counter[MB_EXCEPTION]);
}

static void test_broadcast_of_anything_else_is_neither_executed_nor_answered(void)
{
    static const char *const requests[] = {"00 01 00 13 00 25",
                                           "00 02 00 C4 00 16",
                                           "00 03 00 6B 00 03",
                                           "00 04 00 08 00 01",
                                           "00 07",
                                           "00 08 00 00 A5 37",
                                           "00 08 00 01 00 00",
                                           "00 08 00 04 00 00",
                                           "00 08 00 0A 00 00",
                                           "00 0B",
                                           "00 0C",
                                           "00 11",
                                           "00 14 07 06 00 04 00 02 00 01",
                                           "00 17 00 03 00 01 00 0E 00 01 02 12 34",
                                           "00 18 04 DE",
                                           "00 2B 0E 01 00",
                                           "00 6E",
                                           "00 63"};
    const unsigned n = sizeof requests / sizeof requests[0];
    mb_diag.diagnostic = 0x1234;
    for (unsigned i = 0; i < n; i++)
        ask(requests[i], NULL);
    TEST_ASSERT_EQUAL(0, fx.checks);
    TEST_ASSERT_EQUAL(0, fx.writes);
    TEST_ASSERT_EQUAL_HEX16(0x1234, mb_diag.diagnostic);
    TEST_ASSERT_FALSE(mb_diag.listen_only);
    TEST_ASSERT_EQUAL(0, fx.restarts);
    TEST_ASSERT_EQUAL(n, mb_diag.counter[MB_NO_RESPONSE]);
    TEST_ASSERT_EQUAL(n, mb_diag.counter[MB_EXCEPTION]); /* [S] appendix A: counter 3 */
    ask("11 03 00 6B 00 01", "11 03 02 02 2B");
}

static void test_a_refused_broadcast_is_counted_and_silent(void)
{
    ask("00 06 77 77 00 01", NULL);
    ask("00 10 00 01 00 02 02 00 0A", NULL);
    TEST_ASSERT_EQUAL(2, mb_diag.counter[MB_EXCEPTION]);
    TEST_ASSERT_EQUAL(0, fx.writes);
}

/* ---- 32-bit values ------------------------------------------------------------------------------------- */

static void count_up(void)
{
    holding_0[20] = ++holding_0[21]; /* an interrupt of the application: both halves alike */
}

static void test_memory_is_copied_between_lock_and_unlock(void)
{
    static const uint8_t request[] = {0x11, 0x03, 0x00, 0x14, 0x00, 0x02};
    mbc_interrupt(count_up);
    for (unsigned i = 0; i < 100; i++) {
        const unsigned before = fx.locks;
        mbc_send(&client, request, sizeof request);
        TEST_ASSERT_EQUAL(7, mbc_wait(&client, got));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(got + 3, got + 5, 2);
        TEST_ASSERT_EQUAL(before + 1, fx.locks);
        TEST_ASSERT_EQUAL(before + 1, fx.unlocks);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_examples_of_the_document_in_rtu);
    RUN_TEST(test_examples_of_the_document_in_ascii);
    BOTH(test_reading_bits);
    BOTH(test_reading_2000_bits_is_allowed_2001_is_not);
    BOTH(test_reading_registers);
    BOTH(test_reading_125_registers);
    BOTH(test_the_last_address_is_65535_and_nothing_wraps);
    BOTH(test_writing_a_coil);
    BOTH(test_writing_a_register);
    BOTH(test_exception_status);
    BOTH(test_writing_coils);
    BOTH(test_writing_1968_bits_is_allowed_1969_is_not);
    BOTH(test_writing_registers);
    BOTH(test_writing_123_registers);
    BOTH(test_a_count_that_would_overflow_its_octet);
    BOTH(test_a_write_changes_all_or_nothing);
    BOTH(test_the_application_can_refuse_with_any_exception);
    BOTH(test_blocks_without_memory_go_to_the_application);
    BOTH(test_files_and_queues_without_memory_go_to_the_application);
    BOTH(test_server_id);
    BOTH(test_reading_files);
    BOTH(test_reading_as_much_of_files_as_an_answer_holds);
    BOTH(test_reading_many_groups);
    BOTH(test_records_end_at_270f);
    BOTH(test_writing_files);
    BOTH(test_writing_a_file_with_the_longest_request);
    BOTH(test_mask_write);
    BOTH(test_read_write_registers);
    BOTH(test_read_write_at_its_limits);
    BOTH(test_fifo);
    BOTH(test_fifo_of_31);
    BOTH(test_encapsulated_interface);
    BOTH(test_unknown_functions);
    BOTH(test_wrong_length_is_exception_3);
    BOTH(test_user_functions_are_rows);
    BOTH(test_broadcast_writes_are_executed_and_never_answered);
    BOTH(test_broadcast_of_anything_else_is_neither_executed_nor_answered);
    BOTH(test_a_refused_broadcast_is_counted_and_silent);
    BOTH(test_memory_is_copied_between_lock_and_unlock);
    return UNITY_END();
}
