/* Octets one by one to line_octet_isr(): for stacks that look at each. All formats.
 *
 * Where the bits go. Mode 3 has nine bits a character, the ninth in TB8 and RB8; mode 1 has eight.
 *   8E1, 8O1  mode 3, parity ninth            7E1, 7O1  mode 1, parity eighth
 *   8N2       mode 3, ninth 1 = a stop bit    7N2       mode 1, eighth 1 = a stop bit        8N1  mode 1
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

#define SCON_MODE_3 0xC0u
#define SCON_MODE_1 0x40u

static volatile HOT uint8_t __at(0x13) room; /* R3: how many octets may come; R2 is A */

static volatile __bit parity; /* the character has a parity bit       */
static volatile __bit odd;    /* it is odd                            */
static volatile __bit seven;  /* seven data bits: the eighth is added */
static volatile __bit lost;   /* there was no room for an octet       */

/* Octets and their HAL_ERR_*. */
#define KEPT 16
static volatile PAGED uint8_t kept[2 * KEPT];

/* ---- high --------------------------------------------------------------------------------------------------- */

void serial_isr(void) __interrupt(4) __using(2) __naked
{
    __asm
        jb _RI,00001$
        ljmp _send_next_isr
    00001$:
        push psw
        mov psw,#0x10
        mov r2,a
        mov a,_SBUF
        clr _RI
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _ET0
        cjne r3,#0,00006$       ; changes C: before the parity
        setb _lost
        sjmp 00007$
    00006$:
        dec r3
        mov c,_P                ; error if parity is not even
        jnb _odd,00002$
        cpl c
    00002$:
        jnb _seven,00003$
        anl a,#0x7F
        sjmp 00004$
    00003$:
        jnb _RB8,00004$
        cpl c
    00004$:
        jb _parity,00005$
        clr c
    00005$:
        movx @r0,a
        inc r0
        clr a
        rlc a                   ; HAL_ERR_PARITY
        mov c,_lost
        mov acc.2,c             ; HAL_ERR_OVERRUN
        clr _lost
        movx @r0,a
        inc r0
    00007$:
        setb _IE1
        mov a,r2
        pop psw
        reti
    __endasm;
}

void mark_isr(void) __naked
{
    __asm
        mov _mark,_in
        reti
    __endasm;
}

/* ---- low: the service --------------------------------------------------------------------------------------- */

void receive_off_isr(void) IN_ISR __naked
{
    __asm
        mov _in,#_kept
        mov _taken,#_kept
        mov _room,#KEPT
        clr _lost
        clr _due
        ret
    __endasm;
}

void silent_isr(void) IN_ISR __naked
{
    __asm
        mov _mark,_in
        clr _ET0
        setb _due
        setb _IE1
        ret
    __endasm;
}

bool hal_silent(hal_dur_t d) IN_ISR
{
    (void)d;
    return false; /* these stacks do not ask */
}

/* All has been told: the store begins anew, unless something has come meanwhile. */
static bool empty_isr(void) IN_ISR
{
    bool empty;

    EA = 0;
    empty = taken == in && !due;
    if (empty)
        receive_off_isr();
    EA = 1;
    return empty;
}

static void tell_octet_isr(void) IN_ISR
{
    volatile PAGED uint8_t *next = (volatile PAGED uint8_t *)taken;

    taken += 2;
    line_octet_isr(next[0], next[1]);
}

static void serve_isr(void) IN_ISR
{
    while (!sending && !empty_isr()) {
        if (taken != (due ? mark : in)) {
            tell_octet_isr();
        } else if (due) {
            due = 0;
            if (reload_low | reload_high)
                line_silence_isr();
        }
    }
}

void service_isr(void) __interrupt(2) __using(1)
{
    do {
        IE1 = 0;
        serve_isr();
        if (sending)
            sent_isr();
    } while (IE1);
}

/* ---- characters --------------------------------------------------------------------------------------------- */

void ninth_isr(void) __naked
{
    __asm
        mov c,_P
        jnb _odd,00001$
        cpl c
    00001$:
        jb _parity,00002$
        setb c
    00002$:
        jb _seven,00003$
        mov _TB8,c
        ret
    00003$:
        mov acc.7,c
        ret
    __endasm;
}

/* Below this the stack cannot follow. */
#ifndef MIN_OCTET_CYCLES
#define MIN_OCTET_CYCLES 100u
#endif
#define MIN_N (MIN_OCTET_CYCLES * 3u / 88u + 1u) /* an octet lasts 88 N / 3 cycles */

bool receive_open(uint16_t n, uint8_t format)
{
    bool nine = format == HAL_8E1 || format == HAL_8O1 || format == HAL_8N2;

    if (n < MIN_N || format >= HAL_FORMATS)
        return false;
    parity = format == HAL_8E1 || format == HAL_8O1 || format == HAL_7E1 || format == HAL_7O1;
    odd = format == HAL_8O1 || format == HAL_7O1;
    seven = format >= HAL_7E1;
    SCON = nine ? SCON_MODE_3 : SCON_MODE_1;
    return true;
}
