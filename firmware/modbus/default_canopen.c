#include "modbus/mb.h"

uint8_t mb_canopen_ind(void)
{
    return MB_ILLEGAL_FUNCTION;
}
