/* The clock of silence: Timer 0 runs from - limit towards its overflow, and is set back by each octet.
 *
 * Always: time since the end of the last octet = Timer 0 + limit, as long as it fits 16 bits; endless says that it
 * does not. An octet is known when its interrupt is served, some 20 cycles after RI; that delay is never less than
 * the half stop bit by which RI comes early at 93.75 kbit/s and above, and below it counts little in 33 T_bit.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

volatile __bit armed;
volatile __bit endless;
static HOT uint16_t limit;
HOT uint8_t reload_low;
HOT uint8_t reload_high;

static HOT uint16_t t0; /* set_timer()'s argument */

void silence_open(void)
{
    TR0 = 0;
    ET0 = 0;
    armed = 0;
    endless = 0;
    limit = 0;
    reload_low = 0;
    reload_high = 0;
    TL0 = 0;
    TH0 = 0;
    TF0 = 0;
    TR0 = 1;
    ET0 = 1;
}

void silence_restart_isr(void) __using(2)
{
    TR0 = 0;
    TL0 = reload_low;
    TH0 = reload_high;
    TF0 = 0;
    TR0 = 1;
    endless = 0;
    armed = limit != 0;
}

/* Time since the end of the last octet into t0; Timer 0 is stopped. */
static void read_elapsed_isr(void) IN_ISR
{
    TR0 = 0;
    t0 = (uint16_t)(((uint16_t)TH0 << 8) | TL0);
    if (endless) {
        t0 = 0xFFFFu;
    } else {
        t0 = (uint16_t)(t0 + limit);
        if (t0 < limit && (!armed || TF0))
            t0 = 0xFFFFu;
    }
}

/* The interrupts run on under the lock, so this masks them for its few cycles. */
void hal_silence(hal_dur_t d) IN_ISR
{
    __bit ea = EA;

    EA = 0;
    if (!sending)
        read_elapsed_isr();
    limit = d;
    d = (hal_dur_t)(0u - d);
    reload_low = (uint8_t)d;
    reload_high = (uint8_t)(d >> 8);
    armed = limit != 0;
    if (!sending) {
        TF0 = armed && t0 >= limit;
        t0 = (uint16_t)(t0 - limit);
        TL0 = (uint8_t)t0;
        TH0 = (uint8_t)(t0 >> 8);
        endless = 0;
        TR0 = 1;
    }
    EA = ea;
}

/* Timer 0 counts on from 0 when the silence is complete. */
bool silence_cut_isr(void) __using(2)
{
    return (uint16_t)(((uint16_t)TH0 << 8) | TL0) < octet_cycles;
}

void silence_timer_isr(void) __interrupt(1) __using(2)
{
    if (sending) {
        send_end_isr();
    } else if (!armed) {
        endless = 1;
        TR0 = 0;
    } else if (RI && silence_cut_isr()) {
        /* the serial interrupt comes next and sets the clock back */
    } else if (locked) {
        hold_silence_isr();
    } else {
        armed = 0;
        line_silence_isr();
        look_isr();
        if (sending && burst)
            send_burst_isr();
    }
}
