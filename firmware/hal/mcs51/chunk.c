/* Octets by the chunk to phy_uart: what line_octet_isr() does with an octet of a chunk, without the call.
 *
 * In burst the interrupt stays until nobody wants an octet any more or the line has fallen silent. The loop for it is
 * in assembly: 27 machine cycles an octet, of the 59 that 187.5 kbit/s at 12 MHz leaves; what a chunk's end costs more
 * than that is caught up with by the octets behind it.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"
#include "phy_uart/phy_uart.h"

static void store_isr(void) __using(2)
{
    if (octet_err || phy_rx.waiting || phy_rx.left == 0) {
        line_octet_isr(octet, octet_err);
        return;
    }
    *phy_rx.at = octet;
    phy_rx.at++;
    phy_rx.sum += octet;
    if (--phy_rx.left == 0)
        phy_chunk_ind_isr();
}

/* Octets straight from SBUF into the chunk, 8E1, until it is full, the line is silent (TF0), or an octet is bad:
 * then it is in octet and octet_err. Layout of struct phy_rx: at, at + 1, left, sum. */
static void fill_isr(void) __using(2) __naked
{
    __asm
        mov dpl,_phy_rx
        mov dph,(_phy_rx + 1)
        mov r7,(_phy_rx + 2)
        mov r6,(_phy_rx + 3)
        mov _octet_err,#0
        clr _endless
        setb _armed
        .globl _fill_wait_isr
    _fill_wait_isr:
    00001$:
        jb _RI,00002$
        jnb _TF0,00001$
        sjmp 00005$
    00002$:
        mov a,_SBUF
        clr _RI
        clr _TR0
        mov _TL0,_reload_low
        mov _TH0,_reload_high
        clr _TF0
        setb _TR0
        mov c,_P
        jnb _RB8,00003$
        cpl c
    00003$:
        jc 00004$
        movx @dptr,a
        inc dptr
        add a,r6
        mov r6,a
        djnz r7,00001$
        sjmp 00005$
    00004$:
        mov _octet_err,#1 ; HAL_ERR_PARITY
    00005$:
        mov _phy_rx,dpl
        mov (_phy_rx + 1),dph
        mov (_phy_rx + 2),r7
        mov (_phy_rx + 3),r6
        ret
    __endasm;
}

void burst_isr(void) __using(2)
{
    while (phy_rx.left) {
        fill_isr();
        if (phy_rx.left == 0)
            phy_chunk_ind_isr();
        else if (octet_err)
            line_octet_isr(octet, octet_err);
        else
            break;
    }
    silence_now_isr();
    look_isr();
}

void take_isr(void) __using(2)
{
    store_isr();
    look_isr();
}

/* Held octets into the chunk, until one of them is at its end. */
static void pour_isr(void) __using(2) __naked
{
    __asm
        mov dpl,_phy_rx
        mov dph,(_phy_rx + 1)
        mov r7,(_phy_rx + 2)
        mov r6,(_phy_rx + 3)
        mov r0,#_held_in
        mov a,@r0
        mov r5,a
        mov r0,#_held_out
        mov a,@r0
        mov r4,a
        add a,#_held
        mov r1,a
    00001$:
        mov a,r4
        xrl a,r5
        jz 00002$
        mov a,@r1
        movx @dptr,a
        add a,r6
        mov r6,a
        inc dptr
        inc r1
        inc r4
        djnz r7,00001$
    00002$:
        mov @r0,ar4
        mov _phy_rx,dpl
        mov (_phy_rx + 1),dph
        mov (_phy_rx + 2),r7
        mov (_phy_rx + 3),r6
        ret
    __endasm;
}

/* What has waited is caught up with chunk by chunk; then the burst goes on where the line is. */
void serve_octets_isr(void) __using(2)
{
    while (held_octet_isr()) {
        store_isr();
        while (burst && phy_rx.left && !phy_rx.waiting && held_out != held_in) {
            pour_isr();
            if (phy_rx.left == 0)
                phy_chunk_ind_isr();
            if (RI) {
                receive_isr();
                hold_octet_isr();
            }
        }
    }
    held_any = 0;
    look_isr();
    if (eager)
        burst_isr();
}

void look_isr(void) __using(2)
{
    deaf = 0;
    eager = 0;
    if (phy_rx.waiting || sending)
        return;
    if (phy_rx.left == 0)
        deaf = 1;
    else if (burst)
        eager = 1;
}
