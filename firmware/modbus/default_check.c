#include "modbus/mb.h"

uint8_t mb_check_ind(void)
{
    return MB_OK;
}
