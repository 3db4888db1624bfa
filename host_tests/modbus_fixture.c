#include "modbus_fixture.h"
#include "modbus/mb_diag.h"
#include "modbus/mb_line.h"
#include "unity.h"

#include <string.h>

struct mbc client;
struct fixture fx;

uint8_t coils_13[5], coils_ac[4], coils_big[250], inputs_c4[3], inputs_big[250];
uint16_t holding_0[32], holding_6b[3], holding_big[125], inputs_8[1], input_regs_big[125];
uint16_t fifo_4de[32], fifo_bad[32], fifo_short[4], file_3[16], file_4[16], file_9[128], file_10[10002];

static const struct mb_block CODE blocks[] = {
    {MB_COILS, 0x0013, 37, coils_13},
    {MB_COILS, 0x00AC, 30, coils_ac},
    {MB_COILS, 0x0300, 8, NULL},
    {MB_COILS, 0x1000, 2000, coils_big},
    {MB_INPUTS, 0x00C4, 22, inputs_c4},
    {MB_INPUTS, 0x1000, 2000, inputs_big},
    {MB_HOLDING, 0x0000, 32, holding_0},
    {MB_HOLDING, 0x006B, 3, holding_6b},
    {MB_HOLDING, 0x0200, 4, NULL},
    {MB_HOLDING, 0xFF83, 125, holding_big},
    {MB_INPUT_REGS, 0x0008, 1, inputs_8},
    {MB_INPUT_REGS, 0x1000, 125, input_regs_big},
    {MB_FIFO, 0x04DE, 32, fifo_4de},
    {MB_FIFO, 0x0500, 32, fifo_bad},
    {MB_FIFO, 0x0600, 4, fifo_short},
    {MB_FILE, 3, 16, file_3},
    {MB_FILE, 4, 16, file_4},
    {MB_FILE, 9, 128, file_9},
    {MB_FILE, 10, 10002, file_10},
    {MB_FILE, 11, 4, NULL},
    {MB_FIFO, 0x0700, 3, NULL},
    MB_MAP_END,
};
const struct mb_block CODE *mb_map = blocks;

/* ---- the application ----------------------------------------------------------------------------------- */

uint8_t mb_check_ind(void)
{
    fx.checks++;
    if (mb_span.write && mb_span.table == MB_HOLDING)
        for (uint16_t i = 0; i < mb_span.qty; i++)
            if (mb_span_get(i) == 0xDEAD)
                return MB_ILLEGAL_VALUE;
    if (mb_span.write && fx.slow)
        fx.slow();
    return mb_span.write ? fx.veto : fx.read_veto;
}

static void write_bit(unsigned bit, unsigned value)
{
    fx.callback_bits = (uint8_t)((fx.callback_bits & ~(1u << bit)) | value << bit);
}

uint8_t mb_block_ind(void)
{
    for (uint16_t i = 0; i < mb_span.qty; i++) {
        if (mb_span.table >= MB_FIFO && mb_span.write)
            fx.callback[mb_span.addr + i] = mb_span_get(i);
        else if (mb_span.table >= MB_FIFO)
            mb_span_put(i, mb_span.table == MB_FILE ? fx.callback[mb_span.addr + i] : i ? 0x1110u + i : 2u);
        else if (mb_span.table == MB_HOLDING && mb_span.write)
            fx.callback[mb_span.addr - 0x200 + i] = mb_span_get(i);
        else if (mb_span.table == MB_HOLDING)
            mb_span_put(i, fx.callback[mb_span.addr - 0x200 + i]);
        else if (mb_span.write)
            write_bit(mb_span.addr - 0x300u + i, mb_span_get(i));
        else
            mb_span_put(i, fx.callback_bits >> (mb_span.addr - 0x300u + i) & 1u);
    }
    return MB_OK;
}

void mb_written_ind(void)
{
    fx.writes++;
    fx.last = mb_span;
}

uint8_t fixture_lock(void)
{
    fx.locks++;
    return hal_irq_save();
}

void fixture_unlock(uint8_t state)
{
    fx.unlocks++;
    hal_irq_restore(state);
}

uint8_t mb_exception_status_ind(void)
{
    return fx.status;
}

bool mb_busy_ind(void)
{
    return fx.busy;
}

void mb_restart_ind(void)
{
    fx.restarts++;
}

uint8_t user_sum(void)
{
    uint8_t sum = 0;
    for (uint8_t i = 0; i < mb_pdu[1]; i++)
        sum = (uint8_t)(sum + mb_pdu[2 + i]);
    mb_pdu[1] = sum;
    mb_pdu_len = 2;
    fx.writes++;
    return MB_OK;
}

uint8_t user_busy(void)
{
    return MB_BUSY;
}

/* ---- the test's side ----------------------------------------------------------------------------------- */

static void fill(void)
{
    static const uint8_t coils[] = {0xCD, 0x6B, 0xB2, 0x0E, 0x1B}, inputs[] = {0xAC, 0xDB, 0x35};
    static const uint16_t regs_6b[] = {0x022B, 0x0000, 0x0064};
    static const uint16_t regs_3[] = {0x00FE, 0x0ACD, 0x0001, 0x0003, 0x000D, 0x00FF};
    memcpy(coils_13, coils, sizeof coils);
    memcpy(inputs_c4, inputs, sizeof inputs);
    memset(coils_ac, 0, sizeof coils_ac);
    memset(holding_0, 0, sizeof holding_0);
    memcpy(holding_0 + 3, regs_3, sizeof regs_3); /* [A] 6.17, example */
    memcpy(holding_6b, regs_6b, sizeof regs_6b);
    inputs_8[0] = 0x000A;
    for (unsigned i = 0; i < 250; i++) {
        coils_big[i] = (uint8_t)i;
        inputs_big[i] = (uint8_t)~i;
    }
    for (uint16_t i = 0; i < 125; i++) {
        holding_big[i] = (uint16_t)(0x1000 + i);
        input_regs_big[i] = (uint16_t)(0x2000 + i);
    }
    memset(fifo_4de, 0, sizeof fifo_4de);
    fifo_4de[0] = 2; /* [A] 6.18, example */
    fifo_4de[1] = 0x01B8;
    fifo_4de[2] = 0x1284;
    fifo_bad[0] = 32;
    fifo_short[0] = 4; /* more than it can hold */
    memset(file_3, 0, sizeof file_3);
    memset(file_4, 0, sizeof file_4);
    file_4[1] = 0x0DFE; /* [A] 6.14, example */
    file_4[2] = 0x0020;
    file_3[9] = 0x33CD;
    file_3[10] = 0x0040;
    for (uint16_t i = 0; i < 128; i++)
        file_9[i] = i;
}

void fixture_begin(uint8_t address, uint8_t mode)
{
    memset(&fx, 0, sizeof fx);
    fill();
    mbc_begin(&client);
    client.coding.mode = mode == MB_ASCII ? MBC_ASCII : MBC_RTU;
    memset(&mb_port, 0, sizeof mb_port);
    memset(&mb_diag, 0, sizeof mb_diag);
    mb_log_clear();
    mb_port.bit_per_s = 19200;
    mb_port.format = mode == MB_ASCII ? HAL_7E1 : HAL_8E1;
    mb_port.mode = mode;
    mb_port.address = address;
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
    mbc_power_on(mb_poll);
    mbc_idle(50);
}

static uint8_t digit(char c)
{
    return (uint8_t)(c <= '9' ? c - '0' : c - 'A' + 10);
}

unsigned hex_octets(const char *hex, uint8_t *octets)
{
    unsigned n = 0;
    while (*hex) {
        octets[n++] = (uint8_t)(digit(hex[0]) << 4 | digit(hex[1]));
        hex += hex[2] ? 3 : 2;
    }
    return n;
}

/* ---- asking: request, the answer that is wanted, and what the test fails with --------------------------- */

uint8_t body[MBC_FRAME_MAX], got[MBC_FRAME_MAX];
static uint8_t frame[MBC_FRAME_MAX], want[MBC_FRAME_MAX];
static char text[4 * 64];

static char *add(char *to, const char *words)
{
    while (*words && to < text + sizeof text - 1)
        *to++ = *words++;
    *to = 0;
    return to;
}

static char *add_octets(char *to, const uint8_t *octets, unsigned n)
{
    static const char digits[] = "0123456789ABCDEF";
    char hex[4] = "00 ";
    if (n == 0)
        return add(to, "silence");
    for (unsigned i = 0; i < n && i < 24; i++) {
        hex[0] = digits[octets[i] >> 4];
        hex[1] = digits[octets[i] & 15];
        to = add(to, hex);
    }
    return n > 24 ? add(to, "...") : to;
}

static void expect_frame(const char *request, unsigned want_n, const uint8_t *heard, unsigned n)
{
    char *to;
    if (want_n == n && (n == 0 || memcmp(want, heard, n) == 0))
        return;
    to = add(add(text, request), ": ");
    to = add(add_octets(to, heard, n), ", expected ");
    add_octets(to, want, want_n);
    TEST_FAIL_MESSAGE(text);
}

static void wait_for_body(const char *shown, unsigned want_n)
{
    unsigned n;
    client.time_out = want_n ? 1000 : 60;
    n = mbc_wait(&client, got);
    if (client.heard_n && n == 0)
        expect_frame(shown, want_n, client.heard, client.heard_n);
    expect_frame(shown, want_n, got, n);
    mbc_idle(40);
}

void ask(const char *request, const char *answer)
{
    const unsigned n = hex_octets(request, body);
    mbc_send(&client, body, n);
    wait_for_body(request, answer ? hex_octets(answer, want) : 0);
}

void ask_body(unsigned n, const char *answer)
{
    mbc_send(&client, body, n);
    wait_for_body("body", answer ? hex_octets(answer, want) : 0);
}

static void ask_frame(const char *shown, const uint8_t *octets, unsigned n, unsigned want_n)
{
    client.time_out = want_n ? 1000 : 60;
    mbc_put(&client, octets, n);
    mbc_wait(&client, got);
    expect_frame(shown, want_n, client.heard, client.heard_n);
    mbc_idle(40);
}

void ask_raw(const char *request_hex, const char *answer_hex)
{
    const unsigned n = hex_octets(request_hex, frame);
    ask_frame(request_hex, frame, n, answer_hex ? hex_octets(answer_hex, want) : 0);
}

void ask_text(const char *request, const char *answer)
{
    const unsigned n = answer ? (unsigned)strlen(answer) : 0;
    if (n)
        memcpy(want, answer, n);
    ask_frame(request, (const uint8_t *)request, (unsigned)strlen(request), n);
}

uint8_t fixture_mode;

void fixture_both(void (*test)(void), const char *rtu, const char *ascii, int line)
{
    fixture_mode = MB_RTU;
    UnityDefaultTestRun(test, rtu, line);
    fixture_mode = MB_ASCII;
    UnityDefaultTestRun(test, ascii, line);
    fixture_mode = MB_RTU;
}
