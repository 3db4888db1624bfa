/* The F2808's port and the document's echo-back program on the model of its registers (sim/f2808_sci.h; spec B8). */
#include "boards/f2808/echo_back.h"
#include "contract_machine.h"
#include "cpu.h"
#include "hal/f2808/f2808.h"
#include "hal_board.h"
#include "unity.h"

#include <string.h>

static char heard[512];
static unsigned heard_n;
static const char *typed = "";
static uint8_t octets, last_octet, errs;
static bool sent;

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    octets++;
    last_octet = octet;
    errs = err;
}

void line_silence_isr(void) IN_ISR
{
}

void line_sent_isr(void) IN_ISR
{
    sent = true;
}

void contract_restart(uint8_t why)
{
    TEST_FAIL_MESSAGE(why ? "assert" : "reset");
}

static void hear(uint8_t octet, uint64_t end)
{
    (void)end;
    if (heard_n < sizeof heard - 1)
        heard[heard_n++] = (char)octet;
}

/* Types the next character once the program has asked for it. */
static void type(void)
{
    if (*typed && heard_n >= 19 && memcmp(heard + heard_n - 19, "Enter a character: ", 19) == 0)
        f2808_hear((uint8_t)*typed++, 0);
}

void setUp(void)
{
    static const struct f2808_wire wire = {hear, type};

    f2808_power_on();
    f2808_set_wire(&wire);
    memset(heard, 0, sizeof heard);
    heard_n = 0;
    typed = "";
    octets = errs = 0;
    sent = false;
    hal_init();
}

void tearDown(void)
{
}

/* Spec B8, in the document's order. */
static void registers_and_bits_are_the_documents(void)
{
    static const uint16_t table[][2] = {
        {SCICCR, 0x7050},         {SCICTL1, 0x7051},      {SCIHBAUD, 0x7052},     {SCILBAUD, 0x7053},
        {SCICTL2, 0x7054},        {SCIRXST, 0x7055},      {SCIRXBUF, 0x7057},     {SCITXBUF, 0x7059},
        {SCIFFTX, 0x705A},        {SCIFFRX, 0x705B},      {SCIFFCT, 0x705C},      {CCR_TWO_STOP, 1u << 7},
        {CCR_EVEN, 1u << 6},      {CCR_PARITY, 1u << 5},  {CCR_LOOP, 1u << 4},    {CCR_8_BITS, 8 - 1},
        {CCR_7_BITS, 7 - 1},      {CTL1_RUN, 1u << 5},    {CTL1_TXENA, 1u << 1},  {CTL1_RXENA, 1u << 0},
        {CTL1_RX_ERR_ENA, 1u << 6}, {CTL2_TX_EMPTY, 1u << 6}, {RXST_ERROR, 1u << 7}, {RXST_BREAK, 1u << 5},
        {RXST_FE, 1u << 4},       {RXST_OE, 1u << 3},     {RXST_PE, 1u << 2},     {RXBUF_FE, 1u << 15},
        {RXBUF_PE, 1u << 14},     {FFTX_ON, 3u << 14},    {FFTX_FIFO_ON, 1u << 13}, {FFTX_INT_CLEAR, 1u << 6},
        {FFTX_INT_ENA, 1u << 5},  {FFRX_OVERFLOW, 1u << 15}, {FFRX_OVF_CLEAR, 1u << 14}, {FFRX_FIFO_ON, 1u << 13},
        {FFRX_INT_CLEAR, 1u << 6}, {FFRX_INT_ENA, 1u << 5}, {FIFO_COUNT(0x1F00), 0x1F}, {FIFO_COUNT(0xE0FF), 0},
    };
    for (unsigned i = 0; i < sizeof table / sizeof table[0]; i++)
        TEST_ASSERT_EQUAL_HEX16(table[i][1], table[i][0]);
}

static void echo_back_sets_the_documents_registers_and_says_its_texts(void)
{
    f2808_write(GPASET, BOARD_DRIVER_PIN);
    typed = "xY";
    echo_back_begin();
    TEST_ASSERT_EQUAL_HEX16(0x0007, f2808_read(0x7050));
    TEST_ASSERT_EQUAL_HEX16(0x0023, f2808_read(0x7051));
    TEST_ASSERT_EQUAL_HEX16(0x0001, f2808_read(0x7052));
    TEST_ASSERT_EQUAL_HEX16(0x0044, f2808_read(0x7053));
    TEST_ASSERT_EQUAL_HEX16(0x0003, f2808_read(0x7054) & 3);
    TEST_ASSERT_EQUAL_HEX16(0xE000, f2808_read(0x705A) & 0xE000);
    TEST_ASSERT_EQUAL_HEX16(0x200F, f2808_read(0x705B) & 0x203F);
    TEST_ASSERT_EQUAL_HEX16(0, f2808_read(0x705C));
    TEST_ASSERT_EQUAL_UINT64(325u * 8u * 4u * 10u, f2808_char_clocks()); /* 10 bits */
    echo_back_one();
    echo_back_one();
    f2808_run(10 * f2808_char_clocks());
    TEST_ASSERT_EQUAL_STRING("\r\nHello World!\r\nYou will enter a character, and the DSP will echo it back!\r\n"
                             "\r\nEnter a character:  You sent: x\r\nEnter a character:  You sent: Y",
                             heard);
}

/* LSPCLK / ((BRR + 1) * 8), LSPCLK / 16 for BRR 0; off by 0.3 % at most. */
static void each_rate_has_the_divisor_of_the_formula_or_is_refused(void)
{
    static const struct {
        uint32_t rate;
        uint16_t brr;
    } good[] = {{9600, 325}, {19200, 162}, {1562500, 0}, {781250, 3}};

    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(HAL_LINE_TIMED, hal_line_open(good[i].rate, HAL_8E1));
        TEST_ASSERT_EQUAL_HEX16(good[i].brr, f2808_read(SCIHBAUD) << 8 | f2808_read(SCILBAUD));
    }
    TEST_ASSERT_EQUAL_UINT64(11u * 8u * 4u * 4u, f2808_char_clocks());
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(93750, HAL_8E1)); /* 33.33: off by 1 % */
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(187500, HAL_8E1)); /* 16.67: off by 2 % */
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(500000, HAL_8E1));
    TEST_ASSERT_EQUAL(HAL_LINE_NO, hal_line_open(3000000, HAL_8E1));
}

static void each_format_is_programmed_as_the_register_table_says(void)
{
    static const uint16_t ccr[HAL_FORMATS] = {0x67, 0x27, 0x87, 0x07, 0x66, 0x26, 0x86};

    for (uint8_t format = 0; format < HAL_FORMATS; format++) {
        TEST_ASSERT_EQUAL(HAL_LINE_TIMED, hal_line_open(19200, format));
        TEST_ASSERT_EQUAL_HEX16(ccr[format], f2808_read(SCICCR));
    }
}

static void errors_come_with_their_octet(void)
{
    hal_line_open(19200, HAL_8E1);
    hal_irq_restore(HAL_IRQ_ON);
    f2808_hear(0x11, 0x04);
    f2808_run(100);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_PARITY, errs);
    f2808_hear(0x22, 0x10);
    f2808_run(100);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_FRAMING, errs);
    f2808_hear(0x33, 0);
    f2808_run(100);
    TEST_ASSERT_EQUAL_HEX8(0, errs);
    TEST_ASSERT_EQUAL_HEX8(0x33, last_octet);
}

static void after_a_break_the_receiver_hears_again(void)
{
    hal_line_open(19200, HAL_8E1);
    hal_irq_restore(HAL_IRQ_ON);
    f2808_hear_break();
    f2808_run(100);
    TEST_ASSERT_EQUAL_HEX8(HAL_ERR_FRAMING | HAL_ERR_BREAK, errs);
    f2808_hear(0x44, 0);
    f2808_run(100);
    TEST_ASSERT_EQUAL_UINT8(2, octets);
    TEST_ASSERT_EQUAL_HEX8(0x44, last_octet);
}

static void a_full_fifo_is_an_overrun_and_then_hears_on(void)
{
    hal_line_open(19200, HAL_8E1);
    for (uint8_t i = 0; i < 17; i++)
        f2808_hear(i, 0);
    hal_irq_restore(HAL_IRQ_ON);
    f2808_run(100);
    TEST_ASSERT_EQUAL_UINT8(16, octets);
    f2808_hear(0x55, 0);
    f2808_run(100);
    TEST_ASSERT_EQUAL_UINT8(17, octets);
    TEST_ASSERT_EQUAL_HEX8(0, errs);
}

static void the_driver_drops_after_the_last_stop_bit_and_within_two_bit_times(void)
{
    static const uint8_t text[40] = {1, 2, 3};
    uint64_t end;

    hal_line_open(19200, HAL_8E1);
    hal_send(text, sizeof text);
    TEST_ASSERT_TRUE(f2808_driver());
    end = f2808_now() + 40u * f2808_char_clocks();
    hal_irq_restore(HAL_IRQ_ON);
    while (f2808_driver() && f2808_now() < 2 * end)
        f2808_run(100);
    TEST_ASSERT_TRUE(sent);
    TEST_ASSERT_EQUAL_UINT32(0, f2808_cut());
    TEST_ASSERT_EQUAL_UINT(40, heard_n);
    TEST_ASSERT_UINT64_WITHIN(2u * f2808_char_clocks() / 11u, end, f2808_now());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(registers_and_bits_are_the_documents);
    RUN_TEST(echo_back_sets_the_documents_registers_and_says_its_texts);
    RUN_TEST(each_rate_has_the_divisor_of_the_formula_or_is_refused);
    RUN_TEST(each_format_is_programmed_as_the_register_table_says);
    RUN_TEST(errors_come_with_their_octet);
    RUN_TEST(after_a_break_the_receiver_hears_again);
    RUN_TEST(a_full_fifo_is_an_overrun_and_then_hears_on);
    RUN_TEST(the_driver_drops_after_the_last_stop_bit_and_within_two_bit_times);
    return UNITY_END();
}
