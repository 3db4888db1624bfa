/* What is particular to the F2808 controller: no address switches; nothing is kept without power (README). */
#include "hal/hal.h"

uint8_t hal_switches(void)
{
    return 126;
}

uint8_t hal_nv_read(uint8_t index)
{
    (void)index;
    return 0xFF;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    (void)index;
    (void)value;
    return false;
}
