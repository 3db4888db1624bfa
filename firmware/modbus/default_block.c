#include "modbus/mb.h"

uint8_t mb_block_ind(void)
{
    return MB_DEVICE_FAILURE;
}
