/* The line: a 16550 on IRQ 3 and channel 0 of the 8254 as the clock of silence.
 *
 * The 16550 tells when its FIFO is empty, not when the last stop bit is out. So the driver is dropped by the timer: when
 * the last octet has gone into the shift register it is started for one character, and then asks TEMT, again after each
 * further bit time if need be. (QEMU sets TEMT at once and would hide a driver dropped too early.)
 *
 * The 8259 serves the timer before the UART, so a silence that has run out looks at the receiver first.
 */
#include "hal_board.h"
#include "hal/hal.h"
#include "hal/x86/pc.h"

enum use { TIMER_OFF, TIMER_SILENCE, TIMER_DRAIN, TIMER_WAKE };

#define WAKE_CLOCKS 11932u /* 10 ms */

volatile bool pc_had_irq;

static volatile uint8_t timer_use;
static uint16_t limit;      /* silence limit, 0 = none                 */
static uint16_t last_octet; /* pc_now_isr() at the end of the last one */
static bool reported;       /* this silence has been reported          */
static uint16_t clocks_per_bit_16; /* 8254 clocks per bit, 12.4 fixed point */
static uint8_t char_bits;
static const uint8_t *tx_at;
static uint16_t tx_left;
static bool sending;
static uint8_t mcr;

/* ---- timer -------------------------------------------------------------------------------------------------------- */

static void start_timer_isr(uint8_t use, uint16_t clocks)
{
    timer_use = use;
    if (clocks == 0)
        clocks = 1;
    out8(PIT_MODE, PIT_CH0_ONE_SHOT);
    out8(PIT_CH0, (uint8_t)clocks);
    out8(PIT_CH0, (uint8_t)(clocks >> 8));
}

static void stop_timer_isr(void)
{
    timer_use = TIMER_OFF;
    out8(PIT_MODE, PIT_CH0_ONE_SHOT);
}

void pc_wake_isr(void)
{
    if (timer_use == TIMER_OFF)
        start_timer_isr(TIMER_WAKE, WAKE_CLOCKS);
}

/* Run the timer for what is left of the limit since the last octet. */
static void arm_silence_isr(void)
{
    uint16_t gone = (uint16_t)(pc_now_isr() - last_octet);

    if (limit == 0 || sending || reported)
        stop_timer_isr();
    else
        start_timer_isr(TIMER_SILENCE, gone < limit ? (uint16_t)(limit - gone) : 1u);
}

void hal_silence(hal_dur_t d)
{
    limit = d;
    reported = false;
    if (!sending)
        arm_silence_isr();
}

/* ---- receiver ------------------------------------------------------------------------------------------------------- */

static uint8_t errors_of(uint8_t lsr)
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

/* -> an octet came. */
static bool drain_receiver_isr(void)
{
    bool any = false;
    uint8_t lsr;
    uint8_t octet;

    while ((lsr = in8(BOARD_LINE_UART + UART_LSR)) & LSR_ANY_RX) {
        octet = in8(BOARD_LINE_UART + UART_DATA);
        if (sending && !(mcr & MCR_LOOP))
            continue; /* our own octets */
        any = true;
        last_octet = pc_now_isr();
        reported = false;
        arm_silence_isr();
        line_octet_isr(octet, errors_of(lsr));
    }
    return any;
}

/* ---- transmitter ------------------------------------------------------------------------------------------------------ */

static void fill_fifo_isr(void)
{
    uint8_t room = FIFO_OCTETS;

    while (room-- && tx_left) {
        out8(BOARD_LINE_UART + UART_DATA, *tx_at++);
        tx_left--;
    }
}

void hal_send(const uint8_t *octets, uint16_t n)
{
    tx_at = octets;
    tx_left = n;
    sending = true;
    stop_timer_isr();
    mcr |= MCR_RTS;
    if (!(mcr & MCR_LOOP))
        out8(BOARD_LINE_UART + UART_MCR, mcr);
    fill_fifo_isr();
    out8(BOARD_LINE_UART + UART_IER, IER_RX | IER_LINE | IER_THRE);
}

static void sent_isr(void)
{
    mcr &= (uint8_t)~MCR_RTS;
    out8(BOARD_LINE_UART + UART_MCR, mcr);
    sending = false;
    last_octet = pc_now_isr();
    reported = false;
    arm_silence_isr();
    line_sent_isr();
}

/* One bit time in timer clocks; characters are this many bits. */
static uint16_t bits_isr(uint8_t n)
{
    return (uint16_t)(((uint32_t)n * clocks_per_bit_16) >> 4);
}

static void fifo_empty_isr(void)
{
    if (tx_left) {
        fill_fifo_isr();
        return;
    }
    out8(BOARD_LINE_UART + UART_IER, IER_RX | IER_LINE);
    if (in8(BOARD_LINE_UART + UART_LSR) & LSR_TEMT)
        sent_isr();
    else
        start_timer_isr(TIMER_DRAIN, bits_isr(char_bits));
}

/* ---- interrupts -------------------------------------------------------------------------------------------------------- */

static void uart_isr(void)
{
    uint8_t iir;

    while (!((iir = in8(BOARD_LINE_UART + UART_IIR)) & IIR_NONE)) {
        if ((iir & IIR_ID) == IIR_THRE)
            fifo_empty_isr();
        else if (!drain_receiver_isr())
            (void)in8(BOARD_LINE_UART + UART_MSR);
    }
}

static void timer_isr(void)
{
    uint8_t use = timer_use;

    timer_use = TIMER_OFF;
    if (use == TIMER_DRAIN) {
        if (in8(BOARD_LINE_UART + UART_LSR) & LSR_TEMT)
            sent_isr();
        else
            start_timer_isr(TIMER_DRAIN, bits_isr(1));
    } else if (use == TIMER_SILENCE && !drain_receiver_isr()) {
        reported = true;
        line_silence_isr();
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
        timer_isr();
    else if (irq == IRQ_COM2)
        uart_isr();
    else if (irq == IRQ_COM1)
        pc_console_isr();
    out8(PIC1, PIC_EOI);
}

/* ---- opening -------------------------------------------------------------------------------------------------------------- */

struct format {
    uint8_t lcr;
    uint8_t bits;
};

static const struct format formats[HAL_FORMATS] = {
    [HAL_8E1] = {LCR_8E1, 11}, [HAL_8O1] = {LCR_8O1, 11}, [HAL_8N2] = {LCR_8N2, 11}, [HAL_8N1] = {LCR_8N1, 10},
    [HAL_7E1] = {LCR_7E1, 10}, [HAL_7O1] = {LCR_7O1, 10}, [HAL_7N2] = {LCR_7N2, 10},
};

/* Divisor for a rate, 0 where it is off by more than 0.3 % (EN 50170-2 part 2; Modbus would allow 1 %). */
static uint16_t divisor_of(uint32_t bit_per_s)
{
    uint32_t divisor = (BOARD_UART_HZ / 16u + bit_per_s / 2u) / bit_per_s;
    uint32_t got;
    uint32_t off;

    if (divisor == 0 || divisor > 0xFFFFu)
        return 0;
    got = BOARD_UART_HZ / 16u / divisor;
    off = got > bit_per_s ? got - bit_per_s : bit_per_s - got;
    return off * 1000u <= bit_per_s * 3u ? (uint16_t)divisor : 0;
}

static void program_uart(uint16_t divisor, uint8_t lcr)
{
    out8(BOARD_LINE_UART + UART_IER, 0);
    out8(BOARD_LINE_UART + UART_LCR, LCR_DLAB);
    out8(BOARD_LINE_UART + UART_DATA, (uint8_t)divisor);
    out8(BOARD_LINE_UART + UART_IER, (uint8_t)(divisor >> 8));
    out8(BOARD_LINE_UART + UART_LCR, lcr);
    out8(BOARD_LINE_UART + UART_FCR, FCR_ON_AND_CLEAR);
    out8(BOARD_LINE_UART + UART_MCR, mcr);
    (void)in8(BOARD_LINE_UART + UART_LSR);
    (void)in8(BOARD_LINE_UART + UART_DATA);
    out8(BOARD_LINE_UART + UART_IER, IER_RX | IER_LINE);
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    uint8_t kind = format & (uint8_t)~HAL_LOOP;
    uint16_t divisor = bit_per_s ? divisor_of(bit_per_s) : 0;
    uint8_t irq;

    if (divisor == 0 || kind >= HAL_FORMATS)
        return HAL_LINE_NO;
    irq = hal_irq_save();
    stop_timer_isr();
    limit = 0;
    sending = false;
    tx_left = 0;
    reported = false;
    mcr = MCR_DTR | MCR_OUT2;
    if (format & HAL_LOOP)
        mcr |= MCR_LOOP;
    clocks_per_bit_16 = (uint16_t)((PIT_HZ * 16u + bit_per_s / 2u) / bit_per_s);
    char_bits = formats[kind].bits;
    program_uart(divisor, formats[kind].lcr);
    last_octet = pc_now_isr();
    hal_irq_restore(irq);
    return HAL_LINE_TIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    uint32_t clocks = ((uint32_t)n * clocks_per_bit_16 + 15u) >> 4;

    return clocks > 0xFFFFu ? 0xFFFFu : (hal_dur_t)clocks;
}
