/* SCI-A: rate, format, interrupts. */
#include "hal/f2808/machine.h"
#include "hal/line_uart.h"
#include "uart.h"

/* The SCI knows one or two stop bits with or without parity. */
static const uint8_t ccr_of[HAL_FORMATS] = {
    [HAL_8E1] = CCR_8_BITS | CCR_PARITY | CCR_EVEN, [HAL_8O1] = CCR_8_BITS | CCR_PARITY,
    [HAL_8N2] = CCR_8_BITS | CCR_TWO_STOP,          [HAL_8N1] = CCR_8_BITS,
    [HAL_7E1] = CCR_7_BITS | CCR_PARITY | CCR_EVEN, [HAL_7O1] = CCR_7_BITS | CCR_PARITY,
    [HAL_7N2] = CCR_7_BITS | CCR_TWO_STOP,
};

static uint16_t ctl1 = CTL1_RXENA | CTL1_TXENA;

/* Rate = LSPCLK / ((BRR + 1) * 8) for BRR 1..65535, LSPCLK / 16 for BRR 0: so the divisor is 2..65536. */
bool uart_open(uint32_t bit_per_s, uint8_t format)
{
    uint32_t divisor = line_uart_divisor(BOARD_LSPCLK_HZ / 8u, bit_per_s, 0x10000u);

    if (divisor < 2u)
        return false;
    uart_driver(false);
    reg_set(SCICTL1, ctl1);
    reg_set(SCICCR, (uint16_t)(ccr_of[format & (uint8_t)~HAL_LOOP] | ((format & HAL_LOOP) ? CCR_LOOP : 0u)));
    divisor = divisor == 2u ? 0u : divisor - 1u;
    reg_set(SCIHBAUD, (uint16_t)(divisor >> 8));
    reg_set(SCILBAUD, (uint16_t)(divisor & 0xFFu));
    reg_set(SCICTL2, 0);
    reg_set(SCIFFTX, FFTX_ON | FFTX_INT_CLEAR);
    reg_set(SCIFFRX, FFRX_OVF_CLEAR | FFRX_INT_CLEAR | 1u);
    reg_set(SCIFFCT, 0);
    reg_set(SCIFFTX, UART_FFTX);
    reg_set(SCIFFRX, UART_FFRX);
    reg_set(SCICTL1, ctl1 | CTL1_RUN);
    return true;
}

/* After a break the SCI hears nothing more until SW RESET: the rest of the registers keep their values. */
uint8_t uart_err_of(uint16_t rxbuf, uint16_t ffrx)
{
    uint8_t err = 0;

    if (rxbuf & RXBUF_PE)
        err |= HAL_ERR_PARITY;
    if (rxbuf & RXBUF_FE)
        err |= HAL_ERR_FRAMING;
    if (ffrx & FFRX_OVERFLOW) {
        err |= HAL_ERR_OVERRUN;
        reg_set(SCIFFRX, UART_FFRX | FFRX_OVF_CLEAR);
    }
    if (reg_get(SCIRXST) & RXST_BREAK) {
        err |= HAL_ERR_BREAK;
        reg_set(SCICTL1, ctl1);
        reg_set(SCICTL1, ctl1 | CTL1_RUN);
    }
    return err;
}

void f2808_sci_rx_isr(void)
{
    f2808_interrupted = true;
    reg_set(SCIFFRX, UART_FFRX | FFRX_INT_CLEAR); /* before the FIFO is emptied: what comes later interrupts again */
    line_uart_rx_isr();
    reg_set(PIEACK, PIEACK_GROUP9);
}

/* The flag is cleared before the FIFO is filled; where nothing is left to give, line_uart.c has switched the interrupt
 * off. */
void f2808_sci_tx_isr(void)
{
    f2808_interrupted = true;
    reg_set(SCIFFTX, UART_FFTX | FFTX_INT_ENA | FFTX_INT_CLEAR);
    line_uart_tx_isr();
    reg_set(PIEACK, PIEACK_GROUP9);
}

void f2808_timer0_isr(void)
{
    f2808_interrupted = true;
    reg_set(TIMER0 + TCR, TCR_STOP | TCR_FLAG);
    line_uart_timer_isr();
    reg_set(PIEACK, PIEACK_GROUP1);
}
