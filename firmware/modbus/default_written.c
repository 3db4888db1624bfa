#include "modbus/mb.h"

void mb_written_ind(void)
{
}
