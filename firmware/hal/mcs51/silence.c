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

void silence_restart_isr(void) __using(2) __naked
{
    __asm
        clr _TR0
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _TR0
        clr _endless
        setb _armed
        ret
    __endasm;
}

/* d comes in dptr. In C this is 150 cycles of every answer. EA is masked for it: the interrupts run on under the lock. */
void hal_silence(hal_dur_t d) IN_ISR __naked
{
    d;
    __asm
        mov c,_EA
        clr _EA
        mov _F0,c
        clr a                   ; reload = - d
        clr c
        subb a,dpl
        mov _reload_low,a
        clr a
        subb a,dph
        mov _reload_high,a
        jb _sending,00005$
        clr _TR0
        jb _endless,00002$
        mov a,_TL0              ; elapsed = Timer 0 + limit, into dpl and limit + 1
        add a,_limit
        mov r6,a
        mov a,_TH0
        addc a,(_limit + 1)
        mov r7,a
        jnc 00003$
        jb _TF0,00002$          ; more than 16 bits after the limit: too long to count
        jb _armed,00003$
    00002$:
        mov r6,#0xFF
        mov r7,#0xFF
    00003$:
        clr _endless
        clr c                   ; Timer 0 = elapsed - d
        mov a,r6
        subb a,dpl
        mov _TL0,a
        mov a,r7
        subb a,dph
        mov _TH0,a
        cpl c
        mov _TF0,c              ; silent for d already
        setb _TR0
    00005$:
        mov _limit,dpl
        mov (_limit + 1),dph
        setb _armed
        mov a,dpl
        orl a,dph
        jnz 00006$
        clr _armed              ; no limit
        clr _TF0
    00006$:
        mov c,_F0
        mov _EA,c
        ret
    __endasm;
}

/* Timer 0 counts on from 0 when the silence is complete. */
bool silence_cut_isr(void) __using(2)
{
    return (uint16_t)(((uint16_t)TH0 << 8) | TL0) < octet_cycles;
}

static void silence_ind_isr(void) __using(2)
{
    armed = 0;
    line_silence_isr();
    look_isr();
    if (sending && polled)
        send_burst_isr();
}

/* Burst only: a limit that has passed while a telegram was being decided is reported without another interrupt. */
void silence_now_isr(void) __using(2)
{
    if (TF0 && armed && !RI) {
        TF0 = 0;
        silence_ind_isr();
    }
}

void silence_timer_isr(void) __interrupt(1) __using(2)
{
    if (sending) {
        send_end_isr();
    } else if (!armed || limit == 0) {
        endless = 1;
        TR0 = 0;
    } else if (RI && silence_cut_isr()) {
        /* the serial interrupt comes next and sets the clock back */
    } else if (locked) {
        hold_silence_isr();
    } else {
        silence_ind_isr();
    }
}
