/* Unsigned 32-bit division in the place of SDCC's: at most 1500 machine cycles instead of the 5000 that its C takes in
 * the large model. Main only, as every division (hal.h). By 0: all ones. */
#include "check.h"

static HOT uint8_t divisor_3;
static HOT uint8_t bits;

/* Dividend and quotient in dpl dph b a, the divisor where the compiler puts a second argument. Restoring division:
 * remainder r0..r3, dividend r4..r7 turning into the quotient, divisor dpl dph b divisor_3, low octets first. Leading
 * zero octets of the dividend are skipped. */
unsigned long _divulong(unsigned long dividend, unsigned long divisor) __naked
{
    dividend;
    divisor;
    __asm
        mov r4,dpl
        mov r5,dph
        mov r6,b
        mov r7,a
        mov dptr,#__divulong_PARM_2
        movx a,@dptr
        mov r0,a
        inc dptr
        movx a,@dptr
        mov r1,a
        inc dptr
        movx a,@dptr
        mov b,a
        inc dptr
        movx a,@dptr
        mov _divisor_3,a
        mov dpl,r0
        mov dph,r1
        mov _bits,#32
    00001$:
        mov a,r7
        jnz 00002$
        mov a,_bits
        add a,#-8
        jz 00002$
        mov _bits,a
        mov a,r6
        mov r7,a
        mov a,r5
        mov r6,a
        mov a,r4
        mov r5,a
        mov r4,#0
        sjmp 00001$
    00002$:
        clr a
        mov r0,a
        mov r1,a
        mov r2,a
        mov r3,a
    00003$:
        clr c                   ; remainder and dividend one bit up
        mov a,r4
        rlc a
        mov r4,a
        mov a,r5
        rlc a
        mov r5,a
        mov a,r6
        rlc a
        mov r6,a
        mov a,r7
        rlc a
        mov r7,a
        mov a,r0
        rlc a
        mov r0,a
        mov a,r1
        rlc a
        mov r1,a
        mov a,r2
        rlc a
        mov r2,a
        mov a,r3
        rlc a
        mov r3,a
        jc 00004$               ; 33 bits: above any divisor
        mov a,r0
        subb a,dpl
        mov a,r1
        subb a,dph
        mov a,r2
        subb a,b
        mov a,r3
        subb a,_divisor_3
        jc 00005$
    00004$:
        clr c
        mov a,r0
        subb a,dpl
        mov r0,a
        mov a,r1
        subb a,dph
        mov r1,a
        mov a,r2
        subb a,b
        mov r2,a
        mov a,r3
        subb a,_divisor_3
        mov r3,a
        inc r4
    00005$:
        djnz _bits,00003$
        mov dpl,r4
        mov dph,r5
        mov b,r6
        mov a,r7
        ret
    __endasm;
}
