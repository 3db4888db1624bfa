/* The line's 16550: rate, format, interrupts. */
#include "hal/con_in.h"
#include "hal/line_uart.h"
#include "uart.h"

#define IIR_NONE         0x01u
#define IIR_ID           0x0Eu
#define IIR_THRE         0x02u
#define FCR_ON_AND_CLEAR 0x07u
#define LCR_DLAB         0x80u
#define LCR_8N1          0x03u

uint8_t uart_mcr;

/* Length, stop bits (04H), parity on (08H), even (10H). */
static const uint8_t lcr_of[HAL_FORMATS] = {
    [HAL_8E1] = 0x1B, [HAL_8O1] = 0x0B, [HAL_8N2] = 0x07, [HAL_8N1] = LCR_8N1,
    [HAL_7E1] = 0x1A, [HAL_7O1] = 0x0A, [HAL_7N2] = 0x06,
};

uint8_t uart_err_of(uint8_t lsr)
{
    uint8_t err = 0;

    if (lsr & 0x02u)
        err |= HAL_ERR_OVERRUN;
    if (lsr & 0x04u)
        err |= HAL_ERR_PARITY;
    if (lsr & 0x08u)
        err |= HAL_ERR_FRAMING;
    if (lsr & 0x10u)
        err |= HAL_ERR_BREAK;
    return err;
}

/* Receiver empty, its FIFO on. The interrupts stay off. */
static void program(uint32_t uart, uint32_t divisor, uint8_t lcr, uint8_t mcr)
{
    REG8(uart + UART_IER) = 0;
    REG8(uart + UART_LCR) = LCR_DLAB;
    REG8(uart + UART_DATA) = (uint8_t)divisor;
    REG8(uart + UART_IER) = (uint8_t)(divisor >> 8);
    REG8(uart + UART_LCR) = lcr;
    REG8(uart + UART_FCR) = FCR_ON_AND_CLEAR;
    REG8(uart + UART_MCR) = mcr;
    (void)REG8(uart + UART_LSR);
    (void)REG8(uart + UART_DATA);
}

bool uart_open(uint32_t bit_per_s, uint8_t format)
{
    uint32_t divisor = line_uart_divisor(BOARD_LINE_HZ / 16u, bit_per_s, 0xFFFFu);

    if (divisor == 0)
        return false;
    uart_mcr = (uint8_t)(MCR_DTR | MCR_OUT2 | ((format & HAL_LOOP) ? MCR_LOOP : 0u));
    program(BOARD_LINE_UART, divisor, lcr_of[format & (uint8_t)~HAL_LOOP], uart_mcr);
    uart_tx_irq(false);
    return true;
}

static void line_isr(void)
{
    uint8_t iir;

    while (!((iir = REG8(BOARD_LINE_UART + UART_IIR)) & IIR_NONE)) {
        if ((iir & IIR_ID) == IIR_THRE) {
            line_uart_tx_isr();
        } else {
            line_uart_rx_isr();
            (void)REG8(BOARD_LINE_UART + UART_MSR);
        }
    }
}

void part_irq_isr(uint32_t irq)
{
    if (irq == BOARD_LINE_IRQ)
        line_isr();
    else if (irq == BOARD_CONSOLE_IRQ)
        while (REG8(BOARD_CONSOLE_UART + UART_LSR) & LSR_READY)
            con_in_isr(REG8(BOARD_CONSOLE_UART + UART_DATA));
}

void part_init(void)
{
    board_init();
    program(BOARD_CONSOLE_UART, BOARD_CONSOLE_DIVISOR, LCR_8N1, MCR_DTR | MCR_OUT2);
    REG8(BOARD_CONSOLE_UART + UART_IER) = IER_RX_LINE;
    REG8(BOARD_LINE_UART + UART_MCR) = MCR_DTR | MCR_OUT2; /* driver off */
    core_irq_enable(BOARD_CONSOLE_IRQ);
    core_irq_enable(BOARD_LINE_IRQ);
}

void hal_con_put(uint8_t octet)
{
    uint16_t patience = 0xFFFFu;

    while (!(REG8(BOARD_CONSOLE_UART + UART_LSR) & LSR_THRE) && --patience) {
    }
    REG8(BOARD_CONSOLE_UART + UART_DATA) = octet;
}
