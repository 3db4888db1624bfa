/* No console: the one serial port is the line. */
#include "hal/hal.h"

int16_t hal_con_get(void)
{
    return -1;
}

void hal_con_put(uint8_t octet)
{
    (void)octet;
}
