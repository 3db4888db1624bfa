/* expect: serial_isr: interrupts of two priorities use register bank 1
 * SDCC does not save a bank of its own: the serial interrupt breaks into the timer's registers. */
#include <8052.h>

void timer_isr(void) __interrupt(1) __using(1);
void serial_isr(void) __interrupt(4) __using(1);

static volatile __xdata unsigned int a, b;

void timer_isr(void) __interrupt(1) __using(1)
{
    a += b ^ P1;
}

void serial_isr(void) __interrupt(4) __using(1)
{
    RI = 0;
    b += a ^ SBUF;
}

void main(void)
{
    PT0 = 1;
    ET0 = 1;
    ES = 1;
    for (;;) {
    }
}
