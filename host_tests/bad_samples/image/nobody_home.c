/* expect: ES is set, and 0023 leads to no function, no __interrupt(4)
 * Interrupts are let in that nobody serves. */
#include <8052.h>

void main(void)
{
    ES = 1;
    EA = 1;
    for (;;) {
    }
}
