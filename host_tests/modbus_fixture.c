#include "modbus_fixture.h"
#include "modbus/mb_diag.h"
#include "modbus/mb_line.h"
#include "unity.h"

#include <stdio.h>
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
    if (mb_span.write && fx.spend)
        hv_spend(fx.spend);
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
    hv_begin();
    mbc_begin(&client);
    client.coding.mode = mode == MB_ASCII ? MBC_ASCII : MBC_RTU;
    hal_init();
    memset(&mb_port, 0, sizeof mb_port);
    memset(&mb_diag, 0, sizeof mb_diag);
    mb_log_clear();
    mb_port.bit_per_s = 19200;
    mb_port.format = mode == MB_ASCII ? HAL_7E1 : HAL_8E1;
    mb_port.mode = mode;
    mb_port.address = address;
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
    hv_set_loop(mb_poll, NULL);
    hal_irq_restore(HAL_IRQ_ON);
    mbc_idle(50);
}

unsigned hex_octets(const char *hex, uint8_t *octets)
{
    unsigned n = 0, value;
    int used;
    while (sscanf(hex, " %2x%n", &value, &used) == 1) {
        octets[n++] = (uint8_t)value;
        hex += used;
    }
    return n;
}

static const char *as_hex(const uint8_t *octets, unsigned n)
{
    static char text[2][3 * MBC_FRAME_MAX + 1];
    static unsigned turn;
    char *to = text[turn ^= 1];
    *to = 0;
    for (unsigned i = 0; i < n; i++)
        sprintf(to + 3 * i, "%02X ", octets[i]);
    return to;
}

static void expect_frame(const char *request, const uint8_t *want, unsigned want_n, const uint8_t *got,
                         unsigned n)
{
    char text[4 * MBC_FRAME_MAX];
    if (want_n == n && (n == 0 || memcmp(want, got, n) == 0))
        return;
    snprintf(text, sizeof text, "%s: %.600s, expected %.600s", request, n ? as_hex(got, n) : "silence",
             want_n ? as_hex(want, want_n) : "silence");
    TEST_FAIL_MESSAGE(text);
}

void ask(const char *request, const char *answer)
{
    uint8_t body[MBC_FRAME_MAX], want[MBC_FRAME_MAX], got[MBC_FRAME_MAX];
    const unsigned n = hex_octets(request, body), want_n = answer ? hex_octets(answer, want) : 0;
    client.time_out = answer ? HV_S : 60 * HV_MS;
    mbc_send(&client, body, n);
    const unsigned got_n = mbc_wait(&client, got);
    if (client.heard_n && !got_n)
        expect_frame(request, want, want_n, client.heard, client.heard_n);
    expect_frame(request, want, want_n, got, got_n);
    mbc_idle(40);
}

static void ask_frame(const char *shown, const uint8_t *frame, unsigned n, const uint8_t *want,
                      unsigned want_n)
{
    uint8_t body[MBC_FRAME_MAX];
    client.time_out = want_n ? HV_S : 60 * HV_MS;
    mbc_put(&client, frame, n);
    mbc_wait(&client, body);
    expect_frame(shown, want, want_n, client.heard, client.heard_n);
    mbc_idle(40);
}

void ask_raw(const char *request_hex, const char *answer_hex)
{
    uint8_t frame[MBC_FRAME_MAX], want[MBC_FRAME_MAX];
    const unsigned n = hex_octets(request_hex, frame);
    ask_frame(request_hex, frame, n, want, answer_hex ? hex_octets(answer_hex, want) : 0);
}

void ask_text(const char *request, const char *answer)
{
    ask_frame(request, (const uint8_t *)request, (unsigned)strlen(request), (const uint8_t *)answer,
              answer ? (unsigned)strlen(answer) : 0);
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
