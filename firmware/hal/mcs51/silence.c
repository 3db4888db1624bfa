/* The clock of silence: Timer 0 runs from - limit towards its overflow, and is set back by each octet.
 *
 * Always: time since the end of the last octet = Timer 0 - reload, as long as it fits 16 bits. ET0 is off when the
 * limit has been reported; a second overflow then stays in TF0 and says that it does not fit. An octet is known when
 * its interrupt is served, some 15 cycles after RI; that delay is never less than the half stop bit by which RI comes
 * early at 93.75 kbit/s and above, and below it counts little in 33 T_bit.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

volatile __bit due;
HOT uint8_t reload_low;
HOT uint8_t reload_high;

void silence_open_isr(void) IN_ISR
{
    reload_low = 0;
    reload_high = 0;
    due = 0;
    silence_restart_isr();
}

void silence_restart_isr(void) IN_ISR __naked
{
    __asm
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _TR0
        setb _ET0
        ret
    __endasm;
}

/* Notes the silence, and where it stands among the octets. */
void silence_timer_isr(void) __interrupt(1) __using(2) __naked
{
    __asm
        clr _ET0
        setb _due
        setb _IE1
        jb _sending,00001$
        ljmp _mark_isr
    00001$:
        reti
    __endasm;
}

/* d comes in dptr. In C this is 150 cycles of every answer. With Timer 0 stopped its interrupt does not come. */
void hal_silence(hal_dur_t d) IN_ISR __naked
{
    d;
    __asm
        mov a,dpl               ; reload = - d, its low octet never so near to its overflow that Timer 0 would
        dec a                   ; carry into the high one while both are being set
        add a,#0xFD
        jc 00001$
        mov dpl,#4
    00001$:
        clr c
        clr a
        subb a,dpl
        mov r4,a
        clr a
        subb a,dph
        mov r5,a
        jb _sending,00006$
        clr _TR0
        clr _ES                 ; not for longer than 40 cycles
        jnb _due,00002$
        mov a,_mark
        cjne a,_in,00002$
        clr _due                ; with the limit as it was
    00002$:
        clr c                   ; elapsed = Timer 0 - reload
        mov a,_TL0
        subb a,_reload_low
        mov r6,a
        mov a,_TH0
        subb a,_reload_high
        mov r7,a
        jb _ET0,00004$
        jnc 00003$
        jnb _TF0,00004$
    00003$:
        mov r6,#0xFF            ; reported and overflowed again: too long to count
        mov r7,#0xFF
    00004$:
        mov a,r6                ; Timer 0 = elapsed + reload
        add a,r4
        mov _TL0,a
        mov a,r7
        addc a,r5
        mov _TH0,a
        mov _reload_low,r4
        mov _reload_high,r5
        clr _TF0
        setb _ET0
        jnc 00005$
        jb _RI,00005$           ; silent for d already, unless the receiver knows better
        lcall _silent_isr
    00005$:
        setb _TR0
        setb _ES
        ret
    00006$:
        mov _reload_low,r4
        mov _reload_high,r5
        ret
    __endasm;
}
