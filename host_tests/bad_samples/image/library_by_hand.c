/* expect: serial_isr > _gptrget: a routine of SDCC's library in interrupt code
 * Assembly written by hand jumps there, by a conditional jump. */
#include <8052.h>

void serial_isr(void) __interrupt(4) __naked;

void serial_isr(void) __interrupt(4) __naked
{
    __asm
        jnb _RI,__gptrget
        reti
    __endasm;
}

const char *volatile text = "x";

void main(void)
{
    ES = 1;
    for (;;)
        P1 = *text;
}
