/* A PL011 and a 32-bit general purpose timer of the Stellaris family as line_uart.h wants them. The FIFOs stay off: with
 * them the receiver interrupt comes late, and one octet in the holding register is enough to send without a gap.
 * Source: ARM PrimeCell UART PL011 technical reference manual; LM3S6965 data sheet, chapters 9 to 12. */
#ifndef FIELDLING_PL011_UART_H
#define FIELDLING_PL011_UART_H

#include "hal/cortexm/core.h"
#include "hal/hal.h"
#include "hal_board.h"

#define TIMER_HZ BOARD_CORE_HZ

#define UART_DR   0x00u
#define UART_FR   0x18u
#define UART_IBRD 0x24u
#define UART_FBRD 0x28u
#define UART_LCRH 0x2Cu
#define UART_CR   0x30u
#define UART_IMSC 0x38u
#define UART_MIS  0x40u
#define UART_ICR  0x44u

#define FR_BUSY 0x08u
#define FR_RXFE 0x10u
#define FR_TXFF 0x20u

#define DR_FRAMING 0x100u
#define DR_PARITY  0x200u
#define DR_BREAK   0x400u
#define DR_OVERRUN 0x800u
#define DR_ERRORS  0xF00u

#define INT_RX    0x010u
#define INT_TX    0x020u
#define INT_ERROR 0x780u

#define CR_ON   0x301u /* UART, transmitter, receiver */
#define CR_LOOP 0x080u

#define GPTM_CTL  0x0Cu
#define GPTM_IMR  0x18u
#define GPTM_ICR  0x24u
#define GPTM_ILR  0x28u
#define GPTM_STOP 0u
#define GPTM_RUN  1u
#define GPTM_TIME_OUT 1u

bool uart_open(uint32_t bit_per_s, uint8_t format);

/* HAL_ERR_ flags of a data register with errors. isr. */
uint8_t uart_err_of(uint32_t dr);

static inline bool uart_rx(uint8_t *octet, uint8_t *err)
{
    uint32_t dr;

    if (REG(BOARD_LINE_UART + UART_FR) & FR_RXFE)
        return false;
    dr = REG(BOARD_LINE_UART + UART_DR);
    *octet = (uint8_t)dr;
    *err = (dr & DR_ERRORS) ? uart_err_of(dr) : 0;
    return true;
}

static inline uint16_t uart_tx_room(void)
{
    return (uint16_t)((REG(BOARD_LINE_UART + UART_FR) & FR_TXFF) ? 0u : 1u);
}

static inline void uart_tx(uint8_t octet)
{
    REG(BOARD_LINE_UART + UART_DR) = octet;
}

static inline void uart_tx_irq(bool on)
{
    REG(BOARD_LINE_UART + UART_IMSC) = on ? INT_RX | INT_ERROR | INT_TX : INT_RX | INT_ERROR;
}

static inline bool uart_tx_idle(void)
{
    return !(REG(BOARD_LINE_UART + UART_FR) & FR_BUSY);
}

/* The address bits of a GPIO data register are the mask of what a write changes. */
static inline void uart_driver(bool on)
{
    REG(BOARD_DRIVER_GPIO + (BOARD_DRIVER_PIN << 2)) = on ? BOARD_DRIVER_PIN : 0u;
}

static inline hal_dur_t timer_now(void)
{
    return core_clocks_isr();
}

static inline void timer_stop(void)
{
    REG(BOARD_TIMER + GPTM_CTL) = GPTM_STOP;
}

static inline void timer_start(hal_dur_t counts)
{
    REG(BOARD_TIMER + GPTM_CTL) = GPTM_STOP;
    REG(BOARD_TIMER + GPTM_ILR) = counts;
    REG(BOARD_TIMER + GPTM_CTL) = GPTM_RUN;
}

#endif
