#include "hal/hal.h"
#include "modbus/mb.h"

uint8_t mb_lock_ind(void)
{
    return hal_irq_save();
}

void mb_unlock_ind(uint8_t state)
{
    hal_irq_restore(state);
}
