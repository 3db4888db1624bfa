/* expect: octet_isr: calls hal_irq_save, which is not interrupt code */
#include "hal/hal.h"

void octet_isr(void) IN_ISR;

void octet_isr(void) IN_ISR
{
    uint8_t irq = hal_irq_save();

    hal_irq_restore(irq);
}
