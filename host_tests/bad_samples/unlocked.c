/* expect: main_loop: calls answer_isr with interrupts on */
#include "hal/hal.h"

void answer_isr(void) IN_ISR;
void main_loop(bool often);

void main_loop(bool often)
{
    uint8_t irq = hal_irq_save();

    if (often)
        hal_irq_restore(irq); /* on this path the call below is not protected */
    answer_isr();
    if (!often)
        hal_irq_restore(irq);
}
