/* A station that is an inverter and nothing else. */
#include "inverter.h"
#include "inverter_modbus.h"

const struct mb_block CODE *mb_map = inv_blocks;

uint8_t mb_check_ind(void)
{
    return inv_check();
}

uint8_t mb_block_ind(void)
{
    return inv_block();
}

uint8_t mb_exception_status_ind(void)
{
    return inv_inputs;
}

bool mb_busy_ind(void)
{
    return inv_storing();
}

uint8_t mb_server_id_ind(uint8_t XDATA *octets)
{
    return inv_server_id(octets);
}
