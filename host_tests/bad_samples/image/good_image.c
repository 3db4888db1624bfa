/* expect-nothing: two priorities, a register bank each, a lock that masks, a handler by hand, DIV AB
 * budget: 400 200 40 2 15
 * The stack by hand: main saves R7 and calls add_isr, 3; tick or timer, 2; serial saves 6 and calls, 10. */
#include <8052.h>

#include "hal/hal.h"

void timer_isr(void) __interrupt(1) __using(1);
void tick_isr(void) __interrupt(3) __naked;
void serial_isr(void) __interrupt(4) __using(2);
static HOT volatile uint8_t ticks;
static volatile XDATA uint8_t n, by_n;

uint8_t hal_irq_save(void)
{
    uint8_t was = EA;

    EA = 0;
    return was;
}

void hal_irq_restore(uint8_t state)
{
    EA = state != 0;
}

void timer_isr(void) __interrupt(1) __using(1)
{
    TH0 = 0;
}

void tick_isr(void) __interrupt(3) __naked
{
    __asm
        inc _ticks
        reti
    __endasm;
}

static void add_isr(uint8_t by) __using(2)
{
    n = n / by_n;
    n = (uint8_t)(n + by);
}

void serial_isr(void) __interrupt(4) __using(2)
{
    RI = 0;
    add_isr(SBUF);
}

void main(void)
{
    IP = 0x10;
    IE = 0x1A;
    hal_irq_restore(1);
    for (;;) {
        uint8_t irq = hal_irq_save();
        add_isr(1);
        hal_irq_restore(irq);
    }
}
