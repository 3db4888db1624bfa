/* expect: octet_isr: calls in_main, which is not interrupt code
 * Assembly written by hand has no ret: it runs on into the next function. */
#include "check.h"

void octet_isr(void) __naked;
void in_main(void);
extern HOT uint8_t state;

void octet_isr(void) __naked
{
    __asm
        mov _state,#1
    __endasm;
}

void in_main(void)
{
    state++;
}
