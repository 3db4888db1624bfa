/* The line's 16550: rate, format, interrupts. The 8259 serves the timer (IRQ 0) before the UART (IRQ 3); line_uart.c
 * looks at the receiver before it believes in a silence. */
#include "hal/line_uart.h"
#include "uart.h"

uint8_t uart_mcr;
volatile bool pc_had_irq;

static const uint8_t lcr_of[HAL_FORMATS] = {
    [HAL_8E1] = LCR_8E1, [HAL_8O1] = LCR_8O1, [HAL_8N2] = LCR_8N2, [HAL_8N1] = LCR_8N1,
    [HAL_7E1] = LCR_7E1, [HAL_7O1] = LCR_7O1, [HAL_7N2] = LCR_7N2,
};

uint8_t uart_err_of(uint8_t lsr)
{
    uint8_t err = 0;

    if (lsr & LSR_OVERRUN)
        err |= HAL_ERR_OVERRUN;
    if (lsr & LSR_PARITY)
        err |= HAL_ERR_PARITY;
    if (lsr & LSR_FRAMING)
        err |= HAL_ERR_FRAMING;
    if (lsr & LSR_BREAK)
        err |= HAL_ERR_BREAK;
    return err;
}

bool uart_open(uint32_t bit_per_s, uint8_t format)
{
    uint32_t divisor = line_uart_divisor(BOARD_UART_HZ / 16u, bit_per_s, 0xFFFFu);

    if (divisor == 0)
        return false;
    uart_mcr = MCR_DTR | MCR_OUT2;
    if (format & HAL_LOOP)
        uart_mcr |= MCR_LOOP;
    out8(BOARD_LINE_UART + UART_IER, 0);
    out8(BOARD_LINE_UART + UART_LCR, LCR_DLAB);
    out8(BOARD_LINE_UART + UART_DATA, (uint8_t)divisor);
    out8(BOARD_LINE_UART + UART_IER, (uint8_t)(divisor >> 8));
    out8(BOARD_LINE_UART + UART_LCR, lcr_of[format & (uint8_t)~HAL_LOOP]);
    out8(BOARD_LINE_UART + UART_FCR, FCR_ON_AND_CLEAR);
    out8(BOARD_LINE_UART + UART_MCR, uart_mcr);
    (void)in8(BOARD_LINE_UART + UART_LSR);
    (void)in8(BOARD_LINE_UART + UART_DATA);
    uart_tx_irq(false);
    return true;
}

static void uart_isr(void)
{
    uint8_t iir;

    while (!((iir = in8(BOARD_LINE_UART + UART_IIR)) & IIR_NONE)) {
        if ((iir & IIR_ID) == IIR_THRE) {
            line_uart_tx_isr();
        } else {
            line_uart_rx_isr();
            (void)in8(BOARD_LINE_UART + UART_MSR);
        }
    }
}

/* A request that has gone again shows as IRQ 7 without its in-service bit, and wants no end of interrupt. */
static bool is_spurious(uint32_t irq)
{
    if (irq != IRQ_SPURIOUS)
        return false;
    out8(PIC1, PIC_READ_ISR);
    return !(in8(PIC1) & 0x80u);
}

void pc_irq_isr(uint32_t irq)
{
    if (is_spurious(irq))
        return;
    pc_had_irq = true;
    if (irq == IRQ_TIMER)
        line_uart_timer_isr();
    else if (irq == IRQ_COM2)
        uart_isr();
    else if (irq == IRQ_COM1)
        pc_console_isr();
    out8(PIC1, PIC_EOI);
}
