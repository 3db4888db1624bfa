/* crc16_append() for a processor that has one pointer, to memory and to tables alike: 25 machine cycles an octet, of
 * which the compiler makes 32. */
#include "crc16.h"

#if CRC16_ENTRIES != 512
#error "the tables must be of octets"
#endif

/* octets come in dptr. r2: how many are left, r7 r6: the next, r5 r4: the CRC. */
void crc16_append(uint8_t XDATA *octets, uint_fast8_t n) __naked
{
    octets, n;
    __asm
        mov r6,dpl
        mov r7,dph
    __endasm;
#ifdef __SDCC_STACK_AUTO /* so are the module tests: n below the return address */
    __asm
        mov a,sp
        add a,#-2
        mov r0,a
        mov a,@r0
    __endasm;
#else
    __asm
        mov dptr,#_crc16_append_PARM_2
        movx a,@dptr
    __endasm;
#endif
    __asm
        mov r2,a
        mov r4,#0xFF
        mov r5,#0xFF
    00001$:
        mov dpl,r6
        mov dph,r7
        movx a,@dptr
        inc r6
        cjne r6,#0,00002$
        inc r7
    00002$:
        xrl a,r4
        mov r3,a
        mov dptr,#_crc16_low
        movc a,@a+dptr
        xrl a,r5
        mov r4,a
        mov a,r3
        mov dptr,#_crc16_high
        movc a,@a+dptr
        mov r5,a
        djnz r2,00001$
        mov dpl,r6
        mov dph,r7
        mov a,r4
        movx @dptr,a
        inc dptr
        mov a,r5
        movx @dptr,a
        ret
    __endasm;
}
