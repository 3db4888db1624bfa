/* Function 11: comm event counter. [A] 6.9.
 *
 *     request  0BH
 *     answer   0BH  status:2 (FFFFH: a program command is being processed)  event count:2
 */
#include "modbus/mb_diag.h"

void mb_put_status(uint8_t XDATA *octets)
{
    put_u16be(octets, mb_busy_ind() ? 0xFFFFu : 0u);
    put_u16be(octets + 2, mb_diag.events);
}

uint8_t mb_event_counter(void)
{
    mb_put_status(mb_pdu + 1);
    mb_pdu_len = 5;
    return MB_OK;
}
