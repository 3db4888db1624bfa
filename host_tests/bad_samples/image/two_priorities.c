/* expect: count_isr: interrupts of two priorities run it
 * The serial interrupt breaks into the timer's, and with it into the locals of what both call. */
#include <8052.h>

#include "check.h"

void timer_isr(void) __interrupt(1) __using(1);
void serial_isr(void) __interrupt(4) __using(2);
volatile XDATA uint8_t n;

static void count_isr(uint8_t by)
{
    n = (uint8_t)(n + by);
}

void timer_isr(void) __interrupt(1) __using(1)
{
    count_isr(1);
}

void serial_isr(void) __interrupt(4) __using(2)
{
    RI = 0;
    count_isr(2);
}

void main(void)
{
    IP = 0x10;
    ET0 = 1;
    ES = 1;
    for (;;) {
    }
}
