/* expect: octet_isr: calls smaller, which is not interrupt code
 * Its locals are on the stack, but its registers are the main loop's. */
#include "check.h"

extern HOT uint8_t state;
void octet_isr(uint8_t octet) IN_ISR;
uint8_t smaller(uint8_t a, uint8_t b) REENTRANT;

uint8_t smaller(uint8_t a, uint8_t b) REENTRANT
{
    return a < b ? a : b;
}

void octet_isr(uint8_t octet) IN_ISR
{
    state = smaller(octet, 100u);
}
