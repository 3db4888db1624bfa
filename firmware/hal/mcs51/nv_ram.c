/* Non-volatile octets in battery-backed RAM: each cell with its complement, so that a write the power failed in, or
 * a new battery, reads as erased. The cells lie behind what the linker uses (board.mk: XRAM_SIZE). */
#include "hal/mcs51/mcs51.h"

static volatile XDATA uint8_t __at(NV_ADDRESS) cells[2u * HAL_NV_SIZE];

uint8_t hal_nv_read(uint8_t index)
{
    uint8_t value;

    ASSERT(index < HAL_NV_SIZE);
    value = cells[index];
    return value == (uint8_t)~cells[HAL_NV_SIZE + index] ? value : 0xFFu;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    ASSERT(index < HAL_NV_SIZE);
    cells[index] = value;
    cells[HAL_NV_SIZE + index] = (uint8_t)~value;
    return hal_nv_read(index) == value;
}
