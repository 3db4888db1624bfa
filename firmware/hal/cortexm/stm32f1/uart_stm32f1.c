/* Clocks, pins, rate and interrupts of the STM32F103. Source: RM0008, chapters 7 to 9 and 27. */
#include "hal/con_in.h"
#include "hal/line_uart.h"
#include "uart.h"

#define RCC_CR      0x40021000u
#define RCC_CFGR    0x40021004u
#define RCC_APB2ENR 0x40021018u
#define RCC_APB1ENR 0x4002101Cu
#define FLASH_ACR   0x40022000u

#define CR_HSEON  0x00010000u
#define CR_HSERDY 0x00020000u
#define CR_PLLON  0x01000000u
#define CR_PLLRDY 0x02000000u
#define CFGR_72MHZ_FROM_8MHZ 0x001D0400u /* PLL: HSE * 9; APB1: half */
#define CFGR_USE_PLL 0x2u
#define CFGR_ON_PLL  0x8u
#define APB2_USED 0x00004005u /* AFIO, port A, USART1 */
#define APB1_USED 0x00020001u /* USART2, TIM2        */
#define ACR_TWO_WAIT_STATES 0x12u

#define GPIOA_CRL 0x40010800u
#define GPIOA_CRH 0x40010804u

#define PATIENCE 1000000ul

uint8_t uart_data_mask = 0xFF;

struct format {
    uint16_t cr1;
    uint16_t cr2; /* stop bits: 0x2000 two */
    uint8_t mask;
};

static const struct format formats[HAL_FORMATS] = {
    [HAL_8E1] = {CR1_M | CR1_PCE, 0, 0xFF}, [HAL_8O1] = {CR1_M | CR1_PCE | CR1_PS, 0, 0xFF},
    [HAL_8N2] = {0, 0x2000, 0xFF},          [HAL_8N1] = {0, 0, 0xFF},
    [HAL_7E1] = {CR1_PCE, 0, 0x7F},         [HAL_7O1] = {CR1_PCE | CR1_PS, 0, 0x7F},
    [HAL_7N2] = {0, 0x1000, 0x7F}, /* no seven-bit frame without parity: refused below */
};

uint8_t uart_err_of(uint32_t sr)
{
    uint8_t err = 0;

    if (sr & SR_PE)
        err |= HAL_ERR_PARITY;
    if (sr & SR_FE)
        err |= HAL_ERR_FRAMING;
    if (sr & SR_ORE)
        err |= HAL_ERR_OVERRUN;
    return err;
}

/* BRR = clock / rate: a divider of sixteen samples a bit in 1/16, at least 1. */
static uint32_t brr_of(uint32_t clock, uint32_t bit_per_s)
{
    uint32_t brr = line_uart_divisor(clock, bit_per_s, 0xFFFFu);

    return brr < 16u ? 0 : brr;
}

/* This USART has no loop: a loop is refused. */
bool uart_open(uint32_t bit_per_s, uint8_t format)
{
    uint32_t brr = brr_of(BOARD_LINE_CLOCK_HZ, bit_per_s);

    if (brr == 0 || (format & HAL_LOOP) || format == HAL_7N2)
        return false;
    uart_driver(false);
    REG(BOARD_LINE_UART + USART_CR1) = 0;
    REG(BOARD_LINE_UART + USART_BRR) = brr;
    REG(BOARD_LINE_UART + USART_CR2) = formats[format].cr2;
    REG(BOARD_LINE_UART + USART_CR1) = formats[format].cr1 | CR1_UE | CR1_TE | CR1_RE | CR1_RXNEIE;
    uart_data_mask = formats[format].mask;
    (void)REG(BOARD_LINE_UART + USART_SR);
    (void)REG(BOARD_LINE_UART + USART_DR);
    return true;
}

static void wait_for(uint32_t reg, uint32_t bits)
{
    uint32_t patience = PATIENCE;

    while (!(REG(reg) & bits) && --patience) {
    }
}

static void init_clock(void)
{
    REG(FLASH_ACR) = ACR_TWO_WAIT_STATES;
    REG(RCC_CR) |= CR_HSEON;
    wait_for(RCC_CR, CR_HSERDY);
    REG(RCC_CFGR) = CFGR_72MHZ_FROM_8MHZ;
    REG(RCC_CR) |= CR_PLLON;
    wait_for(RCC_CR, CR_PLLRDY);
    REG(RCC_CFGR) |= CFGR_USE_PLL;
    wait_for(RCC_CFGR, CFGR_ON_PLL);
}

void part_init(void)
{
    init_clock();
    REG(RCC_APB2ENR) |= APB2_USED;
    REG(RCC_APB1ENR) |= APB1_USED;
    uart_driver(false);
    REG(GPIOA_CRL) = BOARD_GPIOA_CRL;
    REG(GPIOA_CRH) = BOARD_GPIOA_CRH;
    REG(BOARD_TIMER + TIM_PSC) = (1ul << TIM_SHIFT) - 1u;
    REG(BOARD_TIMER + TIM_CR1) = TIM_STOP;
    REG(BOARD_TIMER + TIM_EGR) = 1;
    REG(BOARD_TIMER + TIM_SR) = 0;
    REG(BOARD_TIMER + TIM_DIER) = 1;
    REG(BOARD_CONSOLE_UART + USART_BRR) = brr_of(BOARD_CONSOLE_CLOCK_HZ, BOARD_CONSOLE_RATE);
    REG(BOARD_CONSOLE_UART + USART_CR1) = CR1_UE | CR1_TE | CR1_RE | CR1_RXNEIE;
    nvic_enable(BOARD_CONSOLE_IRQ);
    nvic_enable(BOARD_LINE_IRQ);
    nvic_enable(BOARD_TIMER_IRQ);
}

void part_console_put(uint8_t octet)
{
    uint32_t patience = BOARD_CORE_HZ / 1000u;

    while (!(REG(BOARD_CONSOLE_UART + USART_SR) & SR_TXE) && --patience) {
    }
    REG(BOARD_CONSOLE_UART + USART_DR) = octet;
}

/* ---- interrupts ------------------------------------------------------------------------------------------ */

static void console_isr(void)
{
    core_interrupted = true;
    while (REG(BOARD_CONSOLE_UART + USART_SR) & (SR_RXNE | SR_ORE))
        con_in_isr((uint8_t)REG(BOARD_CONSOLE_UART + USART_DR));
}

static void line_isr(void)
{
    core_interrupted = true;
    line_uart_rx_isr();
    if (REG(BOARD_LINE_UART + USART_CR1) & CR1_TXEIE)
        line_uart_tx_isr();
}

static void timer_isr(void)
{
    core_interrupted = true;
    REG(BOARD_TIMER + TIM_SR) = 0;
    line_uart_timer_isr();
}

__attribute__((section(".vectors.part"), used)) void (*const part_vectors[])(void) = {
    [BOARD_CONSOLE_IRQ] = console_isr,
    [BOARD_LINE_IRQ] = line_isr,
    [BOARD_TIMER_IRQ] = timer_isr,
};
