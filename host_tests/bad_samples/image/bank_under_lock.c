/* expect: main: selects the register bank of interrupts that the lock leaves on
 * The lock only holds back upcalls; the serial interrupt runs on in bank 2, in the middle of restart_isr(). */
#include <8052.h>

#include "hal/hal.h"

void serial_isr(void) __interrupt(4) __using(2);
void restart_isr(uint8_t by) __using(2);
static volatile __bit locked;
static volatile XDATA uint8_t n;

uint8_t hal_irq_save(void)
{
    locked = 1;
    return 0;
}

void hal_irq_restore(uint8_t state)
{
    locked = state;
}

void restart_isr(uint8_t by) __using(2)
{
    n = (uint8_t)(n + by + P1);
}

void serial_isr(void) __interrupt(4) __using(2)
{
    RI = 0;
    if (!locked)
        restart_isr(P1);
}

void main(void)
{
    ES = 1;
    for (;;) {
        uint8_t irq = hal_irq_save();
        restart_isr(1);
        hal_irq_restore(irq);
    }
}
