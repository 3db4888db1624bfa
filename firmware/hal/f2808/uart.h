/* SCI-A and CPU timers 0 and 1 of the F2808 as line_uart.h wants them. The transmit FIFO is filled when it is empty; the
 * receive FIFO interrupts at one octet. */
#ifndef FIELDLING_F2808_UART_H
#define FIELDLING_F2808_UART_H

#include "hal/f2808/f2808.h"
#include "hal/hal.h"
#include "hal_board.h"

#define TIMER_HZ BOARD_CPU_HZ

bool uart_open(uint32_t bit_per_s, uint8_t format);

/* SCIFFTX without its interrupt, and SCIFFRX as uart_open() leaves them. */
#define UART_FFTX (FFTX_ON | FFTX_FIFO_ON)
#define UART_FFRX (FFRX_FIFO_ON | FFRX_INT_ENA | 1u)

/* HAL_ERR_ flags of what SCIRXBUF and SCIFFRX say. A break stops the receiver until it is reset. isr. */
uint8_t uart_err_of(uint16_t rxbuf, uint16_t ffrx);

static inline bool uart_rx(uint8_t *octet, uint8_t *err)
{
    uint16_t ffrx = reg_get(SCIFFRX);
    uint16_t rxbuf;

    if (FIFO_COUNT(ffrx) == 0)
        return false;
    rxbuf = reg_get(SCIRXBUF);
    *octet = (uint8_t)(rxbuf & 0xFFu);
    *err = ((rxbuf & (RXBUF_FE | RXBUF_PE)) || (ffrx & FFRX_OVERFLOW)) ? uart_err_of(rxbuf, ffrx) : 0;
    return true;
}

static inline uint16_t uart_tx_room(void)
{
    return (uint16_t)(FIFO_OCTETS - FIFO_COUNT(reg_get(SCIFFTX)));
}

static inline void uart_tx(uint8_t octet)
{
    reg_set(SCITXBUF, octet);
}

/* The flag was set when the FIFO ran empty; it is the handler that clears it. */
static inline void uart_tx_irq(bool on)
{
    reg_set(SCIFFTX, (uint16_t)(UART_FFTX | (on ? FFTX_INT_ENA : 0u)));
}

static inline bool uart_tx_idle(void)
{
    return FIFO_COUNT(reg_get(SCIFFTX)) == 0 && (reg_get(SCICTL2) & CTL2_TX_EMPTY);
}

static inline void uart_driver(bool on)
{
    reg_set(on ? GPASET : GPACLEAR, BOARD_DRIVER_PIN);
}

/* Timer 1 counts down through all 32 bits, and goes on between the reads of its halves. */
static inline hal_dur_t timer_now(void)
{
    uint16_t high;
    uint16_t low;

    do {
        high = reg_get(TIMER1 + TIM_HIGH);
        low = reg_get(TIMER1 + TIM_LOW);
    } while (high != reg_get(TIMER1 + TIM_HIGH));
    return 0xFFFFFFFFu - ((hal_dur_t)high << 16 | low);
}

static inline void timer_stop(void)
{
    reg_set(TIMER0 + TCR, TCR_STOP | TCR_FLAG);
}

static inline void timer_start(hal_dur_t counts)
{
    reg_set(TIMER0 + TCR, TCR_STOP | TCR_FLAG);
    reg_set(TIMER0 + PRD_LOW, (uint16_t)counts);
    reg_set(TIMER0 + PRD_HIGH, (uint16_t)(counts >> 16));
    reg_set(TIMER0 + TCR, TCR_STOP | TCR_RELOAD);
    reg_set(TIMER0 + TCR, TCR_ENA);
}

#endif
