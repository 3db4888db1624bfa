/* expect: serial_isr: has no vector: 0023 leads to _timer_isr
 * doctor: ljmp	_serial_isr -> ljmp	_timer_isr
 * A fault of the tools: what counts is where the linked image jumps. */
#include <8052.h>

void timer_isr(void) __interrupt(1) __using(1);
void serial_isr(void) __interrupt(4) __using(1);

void timer_isr(void) __interrupt(1) __using(1)
{
    TH0 = 0;
}

void serial_isr(void) __interrupt(4) __using(1)
{
    RI = 0;
}

void main(void)
{
    IE = 0x92;
    for (;;) {
    }
}
