/* expect: serial_isr > tenth_isr > _divuint: a routine of SDCC's library in interrupt code
 * Division of two octets is the core's own and allowed. */
#include <8052.h>

#include "check.h"

void serial_isr(void) __interrupt(4) __using(1);
void tenth_isr(void) IN_ISR;
volatile HOT uint16_t n;
volatile HOT uint8_t small, ten;

void tenth_isr(void) IN_ISR
{
    small = small / ten;
    n = n / 10u;
}

void serial_isr(void) __interrupt(4) __using(1)
{
    RI = 0;
    tenth_isr();
}

void main(void)
{
    ES = 1;
    for (;;) {
    }
}
