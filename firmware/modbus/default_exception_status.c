#include "modbus/mb.h"

uint8_t mb_exception_status_ind(void)
{
    return 0;
}
