/* Functions 01 to 04: read coils, inputs, holding registers, input registers. [A] 6.1 to 6.4.
 *
 *     request  code  address:2  quantity:2             quantity 1..2000 bits, 1..125 registers
 *     answer   code  octets:1   values                 unused bits of the last octet are 0
 */
#include "modbus/mb.h"

#define REGS_MAX 125u /* or 2000 bits */

uint8_t mb_read(void)
{
    const uint8_t octets = mb_range(mb_pdu[0], REGS_MAX); /* the code is the table */
    if (octets == 0)
        return MB_ILLEGAL_VALUE;
    mb_pdu[1] = octets;
    mb_pdu_len = (uint8_t)(2u + octets);
    mb_pdu[1u + octets] = 0;
    mb_span.write = false;
    mb_span.octets = mb_pdu + 2;
    return mb_access();
}
