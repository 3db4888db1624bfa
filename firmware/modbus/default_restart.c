#include "modbus/mb.h"

void mb_restart_ind(void)
{
}
