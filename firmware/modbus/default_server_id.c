#include "modbus/mb.h"

uint8_t mb_server_id_ind(uint8_t XDATA *octets)
{
    octets[0] = 0;
    octets[1] = 0xFF; /* running */
    return 2;
}
