#include "hal/line_uart.h"
#include "uart.h"

STATIC_ASSERT((hal_dur_t)0xFFFFFFFFu == 0xFFFFFFFFu, silence_needs_32_bits);

enum use { TIMER_OFF, TIMER_SILENCE, TIMER_DRAIN, TIMER_WAKE };

/* A silence older than this is kept at this age. */
#define AGE_MOST 0xC0000000u

/* The timer never runs longer than 10 ms: a sleeping main loop sees the milliseconds go by, a clock of few bits is looked
 * at before it has gone round. */
#define TIMER_MOST (TIMER_HZ / 100u)

/* Invariants: limit == 0 switches the silence clock off; reported is set from line_silence_isr() until the next octet
 * or limit; while there is something to report, timer_use is not TIMER_OFF or TIMER_WAKE; tx.at[0..tx.left-1] is what has
 * not gone into the transmitter yet. */
static volatile uint8_t timer_use;
static hal_dur_t limit;
static hal_dur_t last_octet; /* timer_now() at the end of the last one, or when the line was opened */
static bool reported;
static bool loop;

static struct {
    const uint8_t *at;
    uint16_t left;
    bool busy;
} tx;

static uint32_t counts_per_bit_256; /* 24.8 fixed point, rounded up */
static hal_dur_t bit_counts;
static hal_dur_t char_counts;

/* ---- silence --------------------------------------------------------------------------------------------- */

static void start_isr(uint8_t use, hal_dur_t counts)
{
    timer_use = use;
    timer_start(counts < TIMER_MOST ? counts : TIMER_MOST);
}

static void stop_isr(void)
{
    timer_use = TIMER_OFF;
    timer_stop();
}

/* Run the timer for what is left of the limit since the last octet. */
static void arm_isr(void)
{
    hal_dur_t gone = (hal_dur_t)(timer_now() - last_octet);

    if (limit == 0 || reported)
        stop_isr();
    else
        start_isr(TIMER_SILENCE, gone < limit ? (hal_dur_t)(limit - gone) : 1u);
}

static inline void heard_isr(void)
{
    last_octet = timer_now();
    reported = false;
    if (timer_use != TIMER_SILENCE && limit)
        start_isr(TIMER_SILENCE, limit);
}

void hal_silence(hal_dur_t d)
{
    limit = d < AGE_MOST ? d : AGE_MOST;
    reported = false;
    if (!tx.busy)
        arm_isr();
}

bool hal_silent(hal_dur_t d)
{
    (void)d;
    return false;
}

void line_uart_wake(void)
{
    hal_dur_t now = timer_now();

    if ((hal_dur_t)(now - last_octet) > AGE_MOST)
        last_octet = (hal_dur_t)(now - AGE_MOST);
    if (timer_use == TIMER_OFF)
        start_isr(TIMER_WAKE, TIMER_MOST);
}

/* ---- receiver -------------------------------------------------------------------------------------------- */

/* Everything the receiver holds, to the stack. -> an octet came. */
static bool drain_isr(void)
{
    bool any = false;
    uint8_t octet;
    uint8_t err;

    while (uart_rx(&octet, &err)) {
        if (!tx.busy)
            heard_isr();
        else if (!loop)
            continue; /* our own */
        any = true;
        line_octet_isr(octet, err);
    }
    return any;
}

void line_uart_rx_isr(void)
{
    drain_isr();
}

/* ---- transmitter ----------------------------------------------------------------------------------------- */

static void fill_isr(void)
{
    uint16_t room = uart_tx_room();

    while (room-- && tx.left) {
        uart_tx(*tx.at++);
        tx.left--;
    }
}

void hal_send(const uint8_t *octets, uint16_t n)
{
    stop_isr();
    tx.at = octets;
    tx.left = n;
    tx.busy = true;
    if (!loop)
        uart_driver(true);
    fill_isr();
    uart_tx_irq(true);
}

/* Our last octet may still wait in the receiver: it is taken while it is known to be ours. */
static void sent_isr(void)
{
    drain_isr();
    if (!loop)
        uart_driver(false);
    tx.busy = false;
    heard_isr();
    line_sent_isr();
}

/* With nothing left to give, the transmitter interrupt has no more to say: the timer asks when the last stop bit is
 * out, after one character and then after each bit. */
void line_uart_tx_isr(void)
{
    if (!tx.busy || timer_use == TIMER_DRAIN)
        return;
    if (tx.left) {
        fill_isr();
        return;
    }
    uart_tx_irq(false);
    if (uart_tx_idle())
        sent_isr();
    else
        start_isr(TIMER_DRAIN, char_counts);
}

/* ---- timer ----------------------------------------------------------------------------------------------- */

static void drained_isr(void)
{
    if (uart_tx_idle())
        sent_isr();
    else
        start_isr(TIMER_DRAIN, bit_counts);
}

static void silent_isr(void)
{
    if (drain_isr())
        return;
    if ((hal_dur_t)(timer_now() - last_octet) < limit) {
        arm_isr();
        return;
    }
    reported = true;
    line_silence_isr();
}

void line_uart_timer_isr(void)
{
    uint8_t use = timer_use;

    timer_use = TIMER_OFF;
    if (use == TIMER_DRAIN)
        drained_isr();
    else if (use == TIMER_SILENCE)
        silent_isr();
}

/* ---- opening --------------------------------------------------------------------------------------------- */

static const uint8_t char_bits[HAL_FORMATS] = {
    [HAL_8E1] = 11, [HAL_8O1] = 11, [HAL_8N2] = 11, [HAL_8N1] = 10, [HAL_7E1] = 10, [HAL_7O1] = 10, [HAL_7N2] = 10,
};

uint32_t line_uart_divisor(uint32_t clock, uint32_t bit_per_s, uint32_t most)
{
    uint32_t divisor = (clock + bit_per_s / 2u) / bit_per_s;
    uint32_t got;
    uint32_t off;

    if (divisor == 0 || divisor > most)
        return 0;
    got = clock / divisor;
    off = got > bit_per_s ? got - bit_per_s : bit_per_s - got;
    return off <= bit_per_s / 1000u * 3u + bit_per_s % 1000u * 3u / 1000u ? divisor : 0;
}

static void set_times(uint32_t bit_per_s, uint8_t bits)
{
    counts_per_bit_256 = (uint32_t)(TIMER_HZ / bit_per_s) << 8;
    counts_per_bit_256 += (((uint32_t)(TIMER_HZ % bit_per_s) << 8) + bit_per_s - 1u) / bit_per_s;
    bit_counts = hal_tbit(1);
    char_counts = hal_tbit(bits);
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    uint8_t kind = format & (uint8_t)~HAL_LOOP;
    uint8_t irq;

    if (bit_per_s == 0 || bit_per_s > 12000000u || kind >= HAL_FORMATS)
        return HAL_LINE_NO;
    irq = hal_irq_save();
    if (!uart_open(bit_per_s, format)) {
        hal_irq_restore(irq);
        return HAL_LINE_NO;
    }
    stop_isr();
    limit = 0;
    reported = false;
    tx.left = 0;
    tx.busy = false;
    loop = (format & HAL_LOOP) != 0;
    set_times(bit_per_s, char_bits[kind]);
    last_octet = timer_now();
    hal_irq_restore(irq);
    return HAL_LINE_TIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    const hal_dur_t most = (hal_dur_t)~(hal_dur_t)0;
    uint32_t whole = counts_per_bit_256 >> 8;
    uint32_t part = ((counts_per_bit_256 & 0xFFu) * n + 0xFFu) >> 8;

    return whole && n > (most - part) / whole ? most : (hal_dur_t)(whole * n + part);
}

/* ---- milliseconds: from the same clock ---------------------------------------------------------------------- */

static uint32_t last_ms; /* timer_now() at the last whole one */
static uint16_t ms;

uint16_t hal_ticks(void)
{
    uint8_t irq = hal_irq_save();
    uint32_t now = timer_now();

    while ((uint32_t)(now - last_ms) >= TIMER_HZ / 1000u) {
        last_ms += TIMER_HZ / 1000u;
        ms++;
    }
    hal_irq_restore(irq);
    return ms;
}
