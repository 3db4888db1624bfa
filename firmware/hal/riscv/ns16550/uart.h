/* A 16550 and the machine timer as line_uart.h wants them. The FIFO of 16 is filled when the transmitter says it is empty;
 * the receiver's interrupts at one octet. Source: National PC16550D; RISC-V privileged architecture 3.2.1 (mtime). */
#ifndef FIELDLING_NS16550_UART_H
#define FIELDLING_NS16550_UART_H

#include "hal/hal.h"
#include "hal/riscv/core.h"
#include "hal_board.h"

#define TIMER_HZ BOARD_MTIME_HZ

#define UART_DATA 0u
#define UART_IER  1u
#define UART_IIR  2u
#define UART_FCR  2u
#define UART_LCR  3u
#define UART_MCR  4u
#define UART_LSR  5u
#define UART_MSR  6u

#define IER_RX_LINE 0x05u
#define IER_THRE    0x02u
#define MCR_DTR     0x01u
#define MCR_RTS     0x02u /* driver enable of the RS-485 converter */
#define MCR_OUT2    0x08u /* interrupt gate, where there is one */
#define MCR_LOOP    0x10u
#define LSR_READY   0x01u
#define LSR_ERRORS  0x1Eu
#define LSR_THRE    0x20u
#define LSR_TEMT    0x40u /* holding and shift register are empty: the last stop bit is out */
#define FIFO_OCTETS 16u

#define MTIME_LOW     (BOARD_CLINT + 0xBFF8u)
#define MTIME_HIGH    (BOARD_CLINT + 0xBFFCu)
#define MTIMECMP_LOW  (BOARD_CLINT + 0x4000u)
#define MTIMECMP_HIGH (BOARD_CLINT + 0x4004u)

bool uart_open(uint32_t bit_per_s, uint8_t format);

/* HAL_ERR_ flags of a line status with errors. isr. */
uint8_t uart_err_of(uint8_t lsr);

/* Modem control register as last written. */
extern uint8_t uart_mcr;

static inline bool uart_rx(uint8_t *octet, uint8_t *err)
{
    uint8_t lsr = REG8(BOARD_LINE_UART + UART_LSR);

    if (!(lsr & LSR_READY))
        return false;
    *octet = REG8(BOARD_LINE_UART + UART_DATA);
    *err = (lsr & LSR_ERRORS) ? uart_err_of(lsr) : 0;
    return true;
}

static inline uint16_t uart_tx_room(void)
{
    return (REG8(BOARD_LINE_UART + UART_LSR) & LSR_THRE) ? FIFO_OCTETS : 0u;
}

static inline void uart_tx(uint8_t octet)
{
    REG8(BOARD_LINE_UART + UART_DATA) = octet;
}

static inline void uart_tx_irq(bool on)
{
    REG8(BOARD_LINE_UART + UART_IER) = on ? IER_RX_LINE | IER_THRE : IER_RX_LINE;
}

static inline bool uart_tx_idle(void)
{
    return (REG8(BOARD_LINE_UART + UART_LSR) & LSR_TEMT) != 0;
}

static inline void uart_driver(bool on)
{
    uart_mcr = (uint8_t)(on ? uart_mcr | MCR_RTS : uart_mcr & ~MCR_RTS);
    REG8(BOARD_LINE_UART + UART_MCR) = uart_mcr;
}

static inline hal_dur_t timer_now(void)
{
    return REG(MTIME_LOW);
}

static inline void timer_stop(void)
{
    REG(MTIMECMP_HIGH) = 0xFFFFFFFFu;
}

/* The high half is never below what it shall be while the low one is not right yet: no interrupt too early. */
static inline void timer_start(hal_dur_t counts)
{
    uint32_t high = REG(MTIME_HIGH);
    uint32_t low = REG(MTIME_LOW);

    if (high != REG(MTIME_HIGH)) {
        high++;
        low = REG(MTIME_LOW);
    }
    timer_stop();
    REG(MTIMECMP_LOW) = low + counts;
    REG(MTIMECMP_HIGH) = high + (low + counts < low);
}

#endif
