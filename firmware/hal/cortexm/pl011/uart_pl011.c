/* Rate, format and interrupts of the Stellaris parts. */
#include "hal/con_in.h"
#include "hal/line_uart.h"
#include "uart.h"

#define SYSCTL_RCC   0x400FE060u
#define SYSCTL_RCGC1 0x400FE104u
#define SYSCTL_RCGC2 0x400FE108u
#define RCGC1_USED   0x00010003u /* timer 0, UART 0 and 1 */
#define RCGC2_GPIO   0x0000007Fu

#define GPIO_DIR   0x400u
#define GPIO_AFSEL 0x420u
#define GPIO_DEN   0x51Cu

#define GPTM_CFG       0x00u
#define GPTM_TAMR      0x04u
#define GPTM_32_BIT    0u
#define GPTM_ONE_SHOT  1u

#define LCRH_8E1 0x66u
#define LCRH_8O1 0x62u
#define LCRH_8N2 0x68u
#define LCRH_8N1 0x60u
#define LCRH_7E1 0x46u
#define LCRH_7O1 0x42u
#define LCRH_7N2 0x48u

static const uint8_t lcrh_of[HAL_FORMATS] = {
    [HAL_8E1] = LCRH_8E1, [HAL_8O1] = LCRH_8O1, [HAL_8N2] = LCRH_8N2, [HAL_8N1] = LCRH_8N1,
    [HAL_7E1] = LCRH_7E1, [HAL_7O1] = LCRH_7O1, [HAL_7N2] = LCRH_7N2,
};

uint8_t uart_err_of(uint32_t dr)
{
    uint8_t err = 0;

    if (dr & DR_PARITY)
        err |= HAL_ERR_PARITY;
    if (dr & DR_FRAMING)
        err |= HAL_ERR_FRAMING;
    if (dr & DR_BREAK)
        err |= HAL_ERR_BREAK;
    if (dr & DR_OVERRUN)
        err |= HAL_ERR_OVERRUN;
    return err;
}

/* Sixteen samples a bit, divider in 1/64: integer part IBRD, 6 bits FBRD; at least 1. */
static uint32_t divisor_of(uint32_t bit_per_s)
{
    uint32_t divisor = line_uart_divisor(BOARD_CORE_HZ * 4u, bit_per_s, 0x3FFFFFu);

    return divisor < 64u ? 0 : divisor;
}

static void program(uint32_t uart, uint32_t divisor, uint8_t lcrh, uint32_t control)
{
    REG(uart + UART_CR) = 0;
    REG(uart + UART_IBRD) = divisor >> 6;
    REG(uart + UART_FBRD) = divisor & 63u;
    REG(uart + UART_LCRH) = lcrh;
    REG(uart + UART_CR) = control;
    REG(uart + UART_ICR) = 0x7FF;
    while (!(REG(uart + UART_FR) & FR_RXFE)) /* last: an octet left behind would hold back every interrupt to come */
        (void)REG(uart + UART_DR);
}

bool uart_open(uint32_t bit_per_s, uint8_t format)
{
    uint32_t divisor = divisor_of(bit_per_s);

    if (divisor == 0)
        return false;
    uart_driver(false);
    program(BOARD_LINE_UART, divisor, lcrh_of[format & (uint8_t)~HAL_LOOP],
            (format & HAL_LOOP) ? CR_ON | CR_LOOP : CR_ON);
    uart_tx_irq(false);
    return true;
}

void part_init(void)
{
    REG(SYSCTL_RCC) = BOARD_RCC;
    REG(SYSCTL_RCGC1) |= RCGC1_USED;
    REG(SYSCTL_RCGC2) |= RCGC2_GPIO;
    REG(BOARD_DRIVER_GPIO + (BOARD_DRIVER_PIN << 2)) = 0;
    REG(BOARD_DRIVER_GPIO + GPIO_DIR) |= BOARD_DRIVER_PIN;
    REG(BOARD_DRIVER_GPIO + GPIO_AFSEL) |= BOARD_LINE_PINS;
    REG(BOARD_DRIVER_GPIO + GPIO_DEN) |= BOARD_DRIVER_PIN | BOARD_LINE_PINS;
    REG(BOARD_TIMER + GPTM_CTL) = GPTM_STOP;
    REG(BOARD_TIMER + GPTM_CFG) = GPTM_32_BIT;
    REG(BOARD_TIMER + GPTM_TAMR) = GPTM_ONE_SHOT;
    REG(BOARD_TIMER + GPTM_IMR) = GPTM_TIME_OUT;
    program(BOARD_CONSOLE_UART, divisor_of(BOARD_CONSOLE_RATE), LCRH_8N1, CR_ON);
    REG(BOARD_CONSOLE_UART + UART_IMSC) = INT_RX;
    nvic_enable(BOARD_CONSOLE_IRQ);
    nvic_enable(BOARD_LINE_IRQ);
    nvic_enable(BOARD_TIMER_IRQ);
}

void part_console_put(uint8_t octet)
{
    uint32_t patience = BOARD_CORE_HZ / 1000u;

    while ((REG(BOARD_CONSOLE_UART + UART_FR) & FR_TXFF) && --patience) {
    }
    REG(BOARD_CONSOLE_UART + UART_DR) = octet;
}

/* ---- interrupts ------------------------------------------------------------------------------------------ */

static void console_isr(void)
{
    core_interrupted = true;
    REG(BOARD_CONSOLE_UART + UART_ICR) = INT_RX;
    while (!(REG(BOARD_CONSOLE_UART + UART_FR) & FR_RXFE))
        con_in_isr((uint8_t)REG(BOARD_CONSOLE_UART + UART_DR));
}

static void line_isr(void)
{
    uint32_t why = REG(BOARD_LINE_UART + UART_MIS);

    core_interrupted = true;
    REG(BOARD_LINE_UART + UART_ICR) = why;
    line_uart_rx_isr();
    if (why & INT_TX)
        line_uart_tx_isr();
}

static void timer_isr(void)
{
    core_interrupted = true;
    REG(BOARD_TIMER + GPTM_ICR) = GPTM_TIME_OUT;
    line_uart_timer_isr();
}

__attribute__((section(".vectors.part"), used)) void (*const part_vectors[])(void) = {
    [BOARD_CONSOLE_IRQ] = console_isr,
    [BOARD_LINE_IRQ] = line_isr,
    [BOARD_TIMER_IRQ] = timer_isr,
};
