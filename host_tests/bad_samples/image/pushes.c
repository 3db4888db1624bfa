/* expect: wait: returns with 1 octets on the stack
 * budget: 1000 100 60 8 100 */
#include <8052.h>

static void wait(void) __naked
{
    __asm
        push acc
    00001$:
        jnb _RI,00001$
        ret
    __endasm;
}

void main(void)
{
    for (;;)
        wait();
}
