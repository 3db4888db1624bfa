/* A USART and a timer of the STM32F1 as line_uart.h wants them. Source: RM0008, chapters 15 (general purpose timers) and
 * 27 (USART). The time is the core's clock; the one-shot timer has 16 bits, eight clocks a count. */
#ifndef FIELDLING_STM32F1_UART_H
#define FIELDLING_STM32F1_UART_H

#include "hal/cortexm/core.h"
#include "hal/hal.h"
#include "hal_board.h"

#define TIMER_HZ BOARD_CORE_HZ

#define USART_SR  0x00u
#define USART_DR  0x04u
#define USART_BRR 0x08u
#define USART_CR1 0x0Cu
#define USART_CR2 0x10u

#define SR_PE   0x01u
#define SR_FE   0x02u
#define SR_ORE  0x08u
#define SR_RXNE 0x20u
#define SR_TC   0x40u
#define SR_TXE  0x80u
#define SR_ERRORS (SR_ORE | SR_FE | SR_PE)

#define CR1_RE     0x0004u
#define CR1_TE     0x0008u
#define CR1_RXNEIE 0x0020u
#define CR1_TXEIE  0x0080u
#define CR1_PEIE   0x0100u
#define CR1_PS     0x0200u /* odd */
#define CR1_PCE    0x0400u
#define CR1_M      0x1000u /* nine bits, parity included */
#define CR1_UE     0x2000u

#define TIM_CR1  0x00u
#define TIM_DIER 0x0Cu
#define TIM_SR   0x10u
#define TIM_EGR  0x14u
#define TIM_CNT  0x24u
#define TIM_PSC  0x28u
#define TIM_ARR  0x2Cu
#define TIM_STOP     0x000Cu /* URS, OPM      */
#define TIM_ONE_SHOT 0x000Du /* and CEN       */
#define TIM_SHIFT    3u
#define TIM_MOST     0xFFFEu /* 7.2 ms at 72 MHz */

/* In 7-bit formats the parity bit is the eighth: it is taken off. */
extern uint8_t uart_data_mask;

bool uart_open(uint32_t bit_per_s, uint8_t format);

/* HAL_ERR_ flags of a status with errors. isr. */
uint8_t uart_err_of(uint32_t sr);

/* Reading SR, then DR clears the error flags. */
static inline bool uart_rx(uint8_t *octet, uint8_t *err)
{
    uint32_t sr = REG(BOARD_LINE_UART + USART_SR);

    if (!(sr & (SR_RXNE | SR_ORE)))
        return false;
    *octet = (uint8_t)REG(BOARD_LINE_UART + USART_DR) & uart_data_mask;
    *err = (sr & SR_ERRORS) ? uart_err_of(sr) : 0;
    return true;
}

static inline uint16_t uart_tx_room(void)
{
    return (uint16_t)((REG(BOARD_LINE_UART + USART_SR) & SR_TXE) ? 1u : 0u);
}

static inline void uart_tx(uint8_t octet)
{
    REG(BOARD_LINE_UART + USART_DR) = octet;
}

static inline void uart_tx_irq(bool on)
{
    if (on)
        REG(BOARD_LINE_UART + USART_CR1) |= CR1_TXEIE;
    else
        REG(BOARD_LINE_UART + USART_CR1) &= ~CR1_TXEIE;
}

static inline bool uart_tx_idle(void)
{
    return (REG(BOARD_LINE_UART + USART_SR) & SR_TC) != 0;
}

static inline void uart_driver(bool on)
{
    REG(BOARD_DRIVER_BSRR) = on ? BOARD_DRIVER_PIN : BOARD_DRIVER_PIN << 16;
}

static inline hal_dur_t timer_now(void)
{
    return core_clocks_isr();
}

static inline void timer_stop(void)
{
    REG(BOARD_TIMER + TIM_CR1) = TIM_STOP;
    REG(BOARD_TIMER + TIM_SR) = 0;
}

/* UG sets the count back and loads ARR; with URS set that is no interrupt. */
static inline void timer_start(hal_dur_t counts)
{
    uint32_t n = (counts >> TIM_SHIFT) + 1u;

    REG(BOARD_TIMER + TIM_CR1) = TIM_STOP;
    REG(BOARD_TIMER + TIM_ARR) = n < TIM_MOST ? n : TIM_MOST;
    REG(BOARD_TIMER + TIM_EGR) = 1;
    REG(BOARD_TIMER + TIM_SR) = 0;
    REG(BOARD_TIMER + TIM_CR1) = TIM_ONE_SHOT;
}

#endif
