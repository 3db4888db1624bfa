/* expect: main_loop: returns with interrupts masked */
#include "hal/hal.h"

void answer_isr(void) IN_ISR;
bool main_loop(bool often);

bool main_loop(bool often)
{
    uint8_t irq = hal_irq_save();

    answer_isr();
    if (often)
        return true;
    hal_irq_restore(irq);
    return false;
}
