/* expect: serial_interrupt: the name of interrupt code ends in _isr */
#include <8052.h>

void serial_interrupt(void) __interrupt(4) __using(1);

void serial_interrupt(void) __interrupt(4) __using(1)
{
    RI = 0;
}

void main(void)
{
    ES = 1;
    for (;;) {
    }
}
