/* Octets by the chunk to phy_uart: what line_octet_isr() does with an octet of a chunk, in the interrupt itself. 8E1.
 *
 * The receiver is in one of three states. Deaf: an octet only sets back the clock of silence. In a chunk: an octet
 * goes to where the stack wants it. In store: a chunk is complete, the line has been silent or an octet was bad, and
 * the service has not finished with it yet; what comes meanwhile is kept. serve_isr() empties the store into the next
 * chunk and opens that one.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"
#include "phy_uart/phy_uart.h"

#define SCON_MODE_3 0xC0u /* nine bits: the ninth is the parity, in TB8 and RB8 */

/* The rest of bank 2: page of `in` (R1), A (R2), how many octets may come (R3), their sum (R4). */
static volatile HOT uint8_t __at(0x16) bad_at; /* R6: bad: a bad octet came before what was kept from here on */

static volatile __bit hear;  /* not deaf        */
static volatile __bit store; /* the third state */
static volatile __bit full;  /* the chunk is complete, and that has not been told */
static volatile __bit bad;
static volatile __bit stay; /* in a telegram of a burst */
static HOT uint8_t err;     /* HAL_ERR_* of the bad octet */
static HOT uint8_t stop;

#define KEPT 48
static volatile PAGED uint8_t kept[KEPT];

/* ---- high --------------------------------------------------------------------------------------------------- */

/* 40 cycles for an octet of a chunk, 16 for a deaf one. P2 is the page of PAGED for everybody else. */
void serial_isr(void) __interrupt(4) __using(2) __naked
{
    __asm
        jnb _hear,00008$
        push psw
        mov psw,#0x10
        mov r2,a
        mov a,_SBUF
        clr _RI
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _ET0
        jb _P,00001$
        jnb _RB8,00002$
        sjmp 00005$
    00001$:
        jnb _RB8,00005$
    00002$:
        mov _P2,r1
        movx @r0,a
        mov _P2,#0
        inc r0
        cjne r0,#0,00003$
        inc r1
    00003$:
        add a,r4
        mov r4,a
        djnz r3,00004$
        jb _store,00006$
        setb _full              ; what keep_isr() does, written out
        setb _store
        mov _phy_rx,r0
        mov (_phy_rx + 1),r1
        mov (_phy_rx + 2),r3
        mov (_phy_rx + 3),r4
        mov r0,#_kept
        mov r1,#0
        mov r3,#KEPT
        setb _IE1
    00004$:
        mov a,r2
        pop psw
        reti
    00005$:
        mov _err,#1             ; HAL_ERR_PARITY
        sjmp 00007$
    00006$:
        mov _err,#4             ; HAL_ERR_OVERRUN: no room for the next one
    00007$:
        lcall _keep_isr
        clr _hear
        mov _bad_at,r0
        setb _bad
        setb _IE1
        sjmp 00004$
    00008$:
        jnb _RI,00009$
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _ET0
        clr _RI
        reti
    00009$:
        ljmp _send_next_isr
    __endasm;
}

/* The third state begins. Called in bank 2, leaves A alone. Layout of struct phy_rx: at, left, sum. */
void keep_isr(void) __naked
{
    __asm
        jb _store,00002$
        setb _store
        jnb _hear,00001$
        mov _phy_rx,r0
        mov (_phy_rx + 1),r1
        mov (_phy_rx + 2),r3
        mov (_phy_rx + 3),r4
    00001$:
        mov r0,#_kept
        mov r1,#0
        mov r3,#KEPT
    00002$:
        ret
    __endasm;
}

void mark_isr(void) __naked
{
    __asm
        lcall _keep_isr
        mov _mark,r0
        setb _hear
        ret
    __endasm;
}

/* ---- low: the service --------------------------------------------------------------------------------------- */

void silent_isr(void) IN_ISR __naked
{
    __asm
        jb _store,00001$
        setb _TF0               ; the interrupt does the rest
        ret
    00001$:
        mov _mark,_in
        clr _ET0
        setb _due
        setb _IE1
        ret
    __endasm;
}

/* Back from the third state, unless something has come meanwhile. While an answer waits, an octet is a chunk of its
 * own: it is told, and cancels the answer. */
static void open_isr(void) IN_ISR __naked
{
    __asm
        clr _EA
        mov a,_taken
        cjne a,_in,00003$
        jb _full,00003$
        jb _due,00003$
        jb _bad,00003$
        clr _store
        clr _hear
        mov _taken,#_kept
        mov a,(_phy_rx + 4)     ; waiting
        jnz 00001$
        mov a,(_phy_rx + 2)
        jz 00003$
        mov _in,_phy_rx
        mov (_in + 1),(_phy_rx + 1)
        mov (_in + 3),a
        mov (_in + 4),(_phy_rx + 3)
        sjmp 00002$
    00001$:
        mov _in,#_kept
        mov (_in + 1),#0
        mov (_in + 3),#1
    00002$:
        setb _hear
    00003$:
        setb _EA
        ret
    __endasm;
}

/* In the order in which it has come: the chunk, octets kept, a bad one or a silence. */
static void tell_isr(void) IN_ISR
{
    volatile PAGED uint8_t *next;

    if (full) {
        full = 0;
        stay = burst;
        if (phy_rx.waiting)
            line_octet_isr(0, 0);
        else
            phy_chunk_ind_isr();
    }
    stop = in;
    if (due)
        stop = mark;
    if (bad && bad_at <= stop)
        stop = bad_at;
    if (taken != stop) {
        next = (volatile PAGED uint8_t *)taken;
        taken++;
        line_octet_isr(*next, 0);
    } else if (bad && stop == bad_at) {
        bad = 0;
        line_octet_isr(0, err);
    } else if (due) {
        due = 0;
        stay = 0;
        if (phy_rx.waiting && in != stop)
            line_octet_isr(0, 0); /* somebody else was faster */
        if (reload_low | reload_high)
            line_silence_isr();
    }
}

void serve_isr(void) IN_ISR
{
    do {
        IE1 = 0;
        if (sending)
            sent_isr();
        while (store) {
            tell_isr();
            open_isr();
        }
    } while (IE1);
}

/* The usual case without C: a chunk is complete; its upcall asks for the next one; what has been kept meanwhile is
 * poured into it, which may complete it; or the octets to come go there directly. */
void service_isr(void) __interrupt(2) __using(1) __naked
{
    __asm
        push acc
        push b
        push dpl
        push dph
        push psw
        mov psw,#0x08
    00001$:
        jnb _full,00007$
        mov a,(_phy_rx + 4)     ; waiting
        jnz 00007$
        clr _full
    00002$:
        lcall _phy_chunk_ind_isr
        mov c,_burst
        mov _stay,c
        mov a,(_phy_rx + 2)
        jz 00006$               ; deaf, or an answer waits
        mov r7,a
        mov dpl,_phy_rx
        mov dph,(_phy_rx + 1)
        mov r6,(_phy_rx + 3)
        mov r0,_taken
    00003$:
        mov a,r0
        cjne a,_in,00004$
        clr _EA
        cjne a,_in,00004$
        jb _IE1,00004$
        mov _in,dpl
        mov (_in + 1),dph
        mov (_in + 3),r7
        mov (_in + 4),r6
        mov _taken,#_kept
        clr _store
        setb _EA
        jb _stay,00008$
        sjmp 00009$
    00004$:
        setb _EA
        jb _IE1,00005$          ; a silence or a bad octet: not past it
        movx a,@r0
        inc r0
        movx @dptr,a
        inc dptr
        add a,r6
        mov r6,a
        djnz r7,00003$
    00005$:
        mov _phy_rx,dpl
        mov (_phy_rx + 1),dph
        mov (_phy_rx + 2),r7
        mov (_phy_rx + 3),r6
        mov _taken,r0
        cjne r7,#0,00007$
        sjmp 00002$
    00006$:
        jnb _due,00007$         ; the answer has not to wait any more
        mov a,_taken
        cjne a,_in,00007$
        clr _due
        lcall _line_silence_isr
    00007$:
        lcall _serve_isr
        jnb _stay,00009$
        jnb _hear,00009$
    00008$:
        jnb _IE1,00008$         ; in a burst: until there is more to do
        clr _IE1
        sjmp 00001$
    00009$:
        pop psw
        pop dph
        pop dpl
        pop b
        pop acc
        reti
    __endasm;
}

void receive_off_isr(void) IN_ISR __naked
{
    __asm
        clr _hear
        clr _store
        clr _full
        clr _bad
        clr _due
        clr _stay
        mov _taken,#_kept
        ret
    __endasm;
}

/* ---- characters --------------------------------------------------------------------------------------------- */

void ninth_isr(void) __naked
{
    __asm
        mov c,_P
        mov _TB8,c
        ret
    __endasm;
}

#define MIN_N 2u /* 59 machine cycles an octet */
bool receive_open(uint16_t n, uint8_t format)
{
    if (n < MIN_N || format != HAL_8E1)
        return false;
    SCON = SCON_MODE_3;
    return true;
}
