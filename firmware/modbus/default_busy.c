#include "modbus/mb.h"

bool mb_busy_ind(void)
{
    return false;
}
