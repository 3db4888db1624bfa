/* A 16550 and the 8254 as line_uart.h wants them. Its FIFO of 16 is filled when the transmitter says it is empty. */
#ifndef FIELDLING_X86_UART_H
#define FIELDLING_X86_UART_H

#include "hal/hal.h"
#include "hal/x86/pc.h"
#include "hal_board.h"

#define TIMER_HZ PIT_HZ

bool uart_open(uint32_t bit_per_s, uint8_t format);

/* HAL_ERR_ flags of a line status with errors. isr. */
uint8_t uart_err_of(uint8_t lsr);

/* Modem control register as last written; the driver enable is RTS. */
extern uint8_t uart_mcr;

static inline bool uart_rx(uint8_t *octet, uint8_t *err)
{
    uint8_t lsr = in8(BOARD_LINE_UART + UART_LSR);

    if (!(lsr & LSR_READY))
        return false;
    *octet = in8(BOARD_LINE_UART + UART_DATA);
    *err = (lsr & LSR_ERRORS) ? uart_err_of(lsr) : 0;
    return true;
}

static inline uint16_t uart_tx_room(void)
{
    return (in8(BOARD_LINE_UART + UART_LSR) & LSR_THRE) ? FIFO_OCTETS : 0u;
}

static inline void uart_tx(uint8_t octet)
{
    out8(BOARD_LINE_UART + UART_DATA, octet);
}

static inline void uart_tx_irq(bool on)
{
    out8(BOARD_LINE_UART + UART_IER, on ? IER_RX | IER_LINE | IER_THRE : IER_RX | IER_LINE);
}

static inline bool uart_tx_idle(void)
{
    return (in8(BOARD_LINE_UART + UART_LSR) & LSR_TEMT) != 0;
}

static inline void uart_driver(bool on)
{
    uart_mcr = on ? uart_mcr | MCR_RTS : uart_mcr & (uint8_t)~MCR_RTS;
    out8(BOARD_LINE_UART + UART_MCR, uart_mcr);
}

static inline hal_dur_t timer_now(void)
{
    return pc_clocks_isr();
}

static inline void timer_start(hal_dur_t counts)
{
    out8(PIT_MODE, PIT_CH0_ONE_SHOT);
    out8(PIT_CH0, (uint8_t)counts);
    out8(PIT_CH0, (uint8_t)(counts >> 8));
}

/* A control word without a count: the output stays low and does not rise. */
static inline void timer_stop(void)
{
    out8(PIT_MODE, PIT_CH0_ONE_SHOT);
}

#endif
