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

/* The rest of bank 2: where the model is (R1), A (R2), how many octets may come (R3), their sum (R4). */
static volatile HOT uint8_t __at(0x16) bad_at; /* R6: bad: a bad octet came before what was kept from here on */

static volatile __bit store; /* the third state */
static volatile __bit full;  /* the chunk is complete, and that has not been told */
static volatile __bit bad;
static volatile __bit first; /* in store, and the next octet calls the service */
static volatile __bit begun; /* that is why it has been called, and nothing else was */
static volatile __bit rest;  /* nothing more to tell */
static volatile __bit leave; /* the chunk is longer than the service waits for */
static HOT uint8_t page;    /* of `in` */
static HOT uint8_t err;     /* HAL_ERR_* of the bad octet */
static IDATA uint8_t stop;

#define KEPT 48

#define MODEL_END (_phy_model + 9) /* PHY_MODEL_END */
#define HEAD 4                     /* PHY_HEAD */
STATIC_ASSERT(PHY_MODEL == 9 && PHY_HEAD == HEAD, what_assembly_cannot_read);
static volatile PAGED uint8_t kept[KEPT];

/* ---- high --------------------------------------------------------------------------------------------------- */

/* 42 cycles for an octet of a chunk, 47 where it has a model, 16 for a deaf one. P2 is the page of PAGED for everybody else. */
void serial_isr(void) __interrupt(4) __using(2) __naked
{
    __asm
        jnb _hear,00008$
        push psw
        mov psw,#0x10
        mov r2,a
        mov a,_SBUF
        jb _P,00001$
        jnb _RB8,00002$
        sjmp 00005$
    00001$:
        jnb _RB8,00005$
    00002$:
        clr _RI
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _ET0
        mov _P2,_page
        movx @r0,a
        mov _P2,#0
        inc r0
        cjne r0,#0,00003$
        inc _page
    00003$:
        cjne r1,#MODEL_END,00011$
    00012$:
        add a,r4
        mov r4,a
        djnz r3,00004$
        jb _store,00006$
    00013$:
        setb _full              ; what keep_isr() does, written out
        setb _store
        mov _phy_rx,r0
        mov (_phy_rx + 1),_page
        mov (_phy_rx + 2),r3
        mov (_phy_rx + 3),r4
        mov (_phy_rx + 6),#MODEL_END
        mov r0,#_kept
        mov _page,#0
        mov r3,#KEPT
        setb _IE1
    00004$:
        mov a,r2
        pop psw
        reti
    00005$:
        clr _RI
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _ET0
        mov _err,#1             ; HAL_ERR_PARITY
        sjmp 00007$
    00006$:
        jbc _first,00010$
        mov _err,#4             ; HAL_ERR_OVERRUN: no room for the next one
    00007$:
        lcall _bad_isr
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
    00010$:
        mov r3,#(KEPT - 1)
        setb _begun
        setb _IE1
        mov a,r2
        pop psw
        reti
    00011$:
        xrl a,@r1
        jnz 00014$
        mov a,@r1
        inc r1
        sjmp 00012$
    00014$:                     ; not as the model is
        xrl a,@r1
        add a,r4
        mov r4,a
        mov r1,#MODEL_END
        mov a,r3
        clr c
        subb a,(_phy_rx + 7)
        mov (_phy_rx + 7),#0
        jc 00015$
        jz 00015$
        cjne a,#HEAD,00016$     ; the first octet: no head
        mov a,r0
        add a,#(HEAD - 1)
        mov r0,a
        jnc 00018$
        inc _page
    00018$:
        mov a,#2
    00016$:
        mov r3,a
        djnz r3,00017$
        ljmp 00013$
    00017$:
        ljmp 00004$
    00015$:
        dec r3                  ; the chunk is over
        ljmp 00013$
    __endasm;
}

/* The third state begins. Called in bank 2, leaves A alone. Layout of struct phy_rx: at, left, sum;
 * octets 6 and 7: model, less. */
void keep_isr(void) __naked
{
    __asm
        jb _store,00002$
        setb _store
        jnb _hear,00001$
        mov _phy_rx,r0
        mov (_phy_rx + 1),_page
        mov (_phy_rx + 2),r3
        mov (_phy_rx + 3),r4
    00001$:
        mov r0,#_kept
        mov _page,#0
        mov r1,#MODEL_END
        mov r3,#KEPT
    00002$:
        ret
    __endasm;
}

/* The octet in R0's place is bad. A silence that has ended there and has not been told is none: T_SYN and T_SDR end with
 * a good octet's begin. Called in bank 2. */
void bad_isr(void) __naked
{
    __asm
        lcall _keep_isr
        jnb _first,00001$
        clr _first
        mov r3,#KEPT
    00001$:
        mov a,r0
        cjne a,_mark,00002$
        clr _due
    00002$:
        clr _hear
        clr _begun
        mov _bad_at,r0
        setb _bad
        setb _IE1
        ret
    __endasm;
}

void mark_isr(void) __naked
{
    __asm
        jb _store,00001$
        push psw
        mov psw,#0x10
        lcall _keep_isr
        pop psw
    00001$:
        clr _begun
        mov _mark,_in
        setb _hear
        reti
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

/* At rest, unless something has come meanwhile: deaf, in a chunk, or still in store, when the first octet calls the
 * service: it cancels the answer that waits, or begins a burst. */
static void open_isr(void) IN_ISR __naked
{
    __asm
        mov a,(_phy_rx + 4)     ; waiting
        orl a,(_phy_rx + 2)
        clr _EA
        jz 00003$
        mov a,_taken
        cjne a,_in,00004$
    00003$:
        jb _full,00004$
        jb _due,00004$
        jb _bad,00004$
        setb _rest
        mov _taken,#_kept
        mov a,(_phy_rx + 4)
        jnz 00001$
        clr _store
        clr _hear
        mov a,(_phy_rx + 2)
        jz 00004$               ; deaf: what has been kept is for nobody
        jb _burst,00001$
        mov _in,_phy_rx
        mov _page,(_phy_rx + 1)
        mov (_in + 1),(_phy_rx + 6)
        mov (_in + 3),a
        mov (_in + 4),(_phy_rx + 3)
        sjmp 00002$
    00001$:
        mov _in,#_kept
        mov _page,#0
        mov (_in + 1),#MODEL_END
        mov (_in + 3),#1
        mov (_in + 4),#0
        setb _first
        setb _store
    00002$:
        setb _hear
    00004$:
        setb _EA
        ret
    __endasm;
}

/* In the order in which it has come: the chunk, octets kept, a bad one or a silence. What was kept right before a bad octet
 * is dropped with it: while it was looked at the next request might be over. -> Only octets of a chunk are left to tell:
 * the service is quicker at that. */
static bool tell_isr(void) IN_ISR
{
    volatile PAGED uint8_t *next;

    if (full) {
        full = 0;
        phy_chunk_ind_isr();
    }
    stop = in;
    if (due)
        stop = mark;
    if (bad && bad_at <= stop) {
        bad = 0;
        taken = bad_at;
        line_octet_isr(0, err);
    } else if (taken != stop) {
        if (!phy_rx.waiting && !phy_rx.left) {
            taken = stop; /* deaf */
            return false;
        }
        if (!phy_rx.waiting && !bad) {
            if (due)
                IE1 = 1; /* up to its mark */
            return true;
        }
        next = (volatile PAGED uint8_t *)taken;
        taken++;
        line_octet_isr(*next, 0);
    } else if (due) {
        due = 0;
        if (phy_rx.waiting && in != stop)
            line_octet_isr(0, 0); /* somebody else was faster: it was T_SDR that is over, not T_SYN */
        else if (reload_low | reload_high)
            line_silence_isr();
        if (sending)
            sent_isr();
    }
    return false;
}

/* -> As tell_isr(). */
bool serve_isr(void) IN_ISR
{
    do {
        IE1 = 0;
        rest = 0;
        while (store && !sending) {
            if (tell_isr())
                return true;
            if (sending)
                break;
            open_isr();
            if (rest)
                break;
        }
        if (sending)
            sent_isr();
    } while (IE1);
    return false;
}

/* The usual case without C: a chunk is complete; its upcall asks for the next one; what has been kept meanwhile is
 * poured into it, which may complete it; the octets to come go there directly. In a burst, and where they are few enough,
 * they are waited for here, 22 cycles each. A silence that nothing has come before or behind is told here, too. */
void service_isr(void) __interrupt(2) __using(1) __naked
{
    __asm
        clr _ES                 ; the second octet of a burst waits from here on (timing.txt: wait)
        push acc
        push b
        push dpl
        push dph
        push psw
        mov psw,#0x08
        jbc _begun,00017$
        sjmp 00022$
    00020$:
        setb _ES
        clr c
        ljmp 00018$
    00017$:                     ; the first octet after rest: of a burst, unless an answer waits
        mov a,(_phy_rx + 2)
        jz 00022$
        mov r7,a
        mov r0,#(_kept + 1)
        mov a,_in
        cjne a,#(_kept + 1),00020$ ; and more already
        mov dpl,_phy_rx
        mov dph,(_phy_rx + 1)
        mov r6,(_phy_rx + 3)
        mov r1,(_phy_rx + 6)
        mov a,(_in + 4)         ; their sum is that octet
        movx @dptr,a
        inc dptr
        cjne r1,#MODEL_END,00027$
        sjmp 00029$
    00022$:
        jb _full,00031$
        ljmp 00016$
    00027$:
        xrl a,@r1
        jnz 00038$
        mov a,@r1
        inc r1
    00029$:
        add a,r6
        mov r6,a
        djnz r7,00005$
        sjmp 00036$
    00038$:
        setb _ES
        ljmp 00026$
    00005$:
        jb _RI,00006$
        jnb _IE1,00005$
        ljmp 00009$
    00006$:
        mov a,_SBUF
        jb _P,00007$
        jnb _RB8,00008$
        sjmp 00014$
    00007$:
        jnb _RB8,00014$
    00008$:
        clr _RI
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        movx @dptr,a
        inc dptr
        cjne r1,#MODEL_END,00027$
        add a,r6
        mov r6,a
        djnz r7,00005$
    00036$:                     ; the chunk is complete
        mov _phy_rx,dpl
        mov (_phy_rx + 1),dph
        mov (_phy_rx + 2),r7
        mov (_phy_rx + 3),r6
        mov (_phy_rx + 6),r1
        mov _taken,r0
        setb _ES
        ljmp 00001$
    00014$:
        clr _RI
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _ET0
        clr _due                ; as in bad_isr()
        mov _err,#1             ; HAL_ERR_PARITY
        mov _bad_at,_in
        clr _hear
        setb _bad
        setb _IE1
        ljmp 00009$
    00041$:
        setb _IE1               ; they came before the service was entered
        sjmp 00042$
    00034$:
        ljmp 00004$
    00031$:
        setb _ES
        clr _full
    00001$:
        lcall _phy_chunk_ind_isr
        mov a,(_phy_rx + 2)
        jz 00011$               ; deaf, or an answer waits
        jb _bad,00041$
        jb _due,00041$
    00042$:
        mov r7,a
        mov a,_few
        clr c
        subb a,r7
    00018$:
        mov _leave,c
        mov dpl,_phy_rx
        mov dph,(_phy_rx + 1)
        mov r6,(_phy_rx + 3)
        mov r1,(_phy_rx + 6)
        mov r0,_taken
    00002$:
        jnb _IE1,00030$         ; a silence or a bad octet: not past it
        jb _bad,00010$
        jnb _due,00010$
        mov a,r0
        cjne a,_mark,00003$
        sjmp 00010$
    00030$:
        mov a,r0
        cjne a,_in,00003$
        jnb _leave,00034$
        clr _EA
        cjne a,_in,00015$
        jb _IE1,00015$
        mov _in,dpl
        mov _page,dph
        mov (_in + 1),r1
        mov (_in + 3),r7
        mov (_in + 4),r6
        mov _taken,#_kept
        clr _store
        setb _EA
        sjmp 00013$
    00015$:
        setb _EA
        sjmp 00002$
    00003$:                     ; what has been kept
        movx a,@r0
        inc r0
        movx @dptr,a
        inc dptr
        cjne r1,#MODEL_END,00025$
    00024$:
        add a,r6
        mov r6,a
        djnz r7,00002$
    00010$:
        clr c
    00028$:
        setb _ES
        mov _phy_rx,dpl
        mov (_phy_rx + 1),dph
        mov (_phy_rx + 2),r7
        mov (_phy_rx + 3),r6
        mov (_phy_rx + 6),r1
        mov _taken,r0
        jc 00001$
        cjne r7,#0,00012$
        sjmp 00001$
    00025$:
        xrl a,@r1
        jnz 00035$
        mov a,@r1
        inc r1
        sjmp 00024$
    00035$:
        ljmp 00026$
    00011$:
        jb _sending,00040$
        jnb _due,00012$         ; the answer has not to wait any more
        jb _bad,00012$
        mov a,_taken
        cjne a,_in,00012$
        clr _due
        lcall _line_silence_isr
        jnb _sending,00012$
    00040$:
        lcall _sent_isr
        sjmp 00012$
    00016$:
        jb _sending,00012$
        setb _ES
        jnb _due,00012$         ; a silence, and nothing else
        jb _bad,00012$
        mov a,_mark
        cjne a,_taken,00012$
        cjne a,_in,00012$
        mov a,_reload_low
        orl a,_reload_high
        jz 00012$
        clr _due
        clr _first
        lcall _line_silence_isr
        jb _sending,00040$
        mov a,(_phy_rx + 2)
        jz 00012$
        jnb _burst,00039$
    00012$:
        lcall _serve_isr
        mov a,dpl
        jnz 00039$
    00013$:
        pop psw
        pop dph
        pop dpl
        pop b
        pop acc
        reti
    00039$:
        mov r7,(_phy_rx + 2)
        mov c,_burst
        cpl c
        ljmp 00018$
    00004$:                     ; straight from the receiver
        clr _ES
        cjne a,_in,00009$
        ljmp 00005$
    00009$:
        setb _ES
        ljmp 00002$
    00026$:                     ; not as the model is
        xrl a,@r1
        add a,r6
        mov r6,a
        mov r1,#MODEL_END
        mov a,r7
        clr c
        subb a,(_phy_rx + 7)
        mov (_phy_rx + 7),#0
        jc 00032$
        jz 00032$
        cjne a,#HEAD,00033$     ; the first octet: no head
        inc dptr
        inc dptr
        inc dptr
        mov a,#2
    00033$:
        mov r7,a
        djnz r7,00009$
        ljmp 00010$
    00032$:
        dec r7                  ; the chunk is over
        setb c
        ljmp 00028$
    __endasm;
}

/* d comes in dptr. Timer 0 stands while it is read. */
bool hal_silent(hal_dur_t d) IN_ISR __naked
{
    d;
    __asm
        clr _TR0
        clr c
        mov a,_TL0
        subb a,_reload_low
        mov r6,a
        mov a,_TH0
        subb a,_reload_high
        setb _TR0
        mov r7,a
        clr c                   ; elapsed < d?
        mov a,r6
        subb a,dpl
        mov a,r7
        subb a,dph
        mov dpl,#0
        jc 00001$
        jb _RI,00001$
        jb _bad,00001$
        mov a,_taken
        cjne a,_in,00001$
        mov dpl,#1
    00001$:
        ret
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
        clr _first
        clr _begun
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
