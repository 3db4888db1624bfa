/* Functions 07 and 17: exception status, report server id. [A] 6.7, 6.13.
 *
 *     07  request  07H        answer  07H  eight status bits
 *     17  request  11H        answer  11H  octets:1  server id  run indicator (00H, FFH)  additional data
 */
#include "modbus/mb.h"

uint8_t mb_exception_status(void)
{
    mb_pdu[1] = mb_exception_status_ind();
    mb_pdu_len = 2;
    return MB_OK;
}

uint8_t mb_server_id(void)
{
    mb_pdu[1] = mb_server_id_ind(mb_pdu + 2);
    mb_pdu_len = (uint8_t)(2u + mb_pdu[1]);
    return MB_OK;
}
