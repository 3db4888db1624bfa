/* Functions 05, 06, 15, 16: write coils and holding registers. [A] 6.5, 6.6, 6.11, 6.12.
 *
 *     05  request  code  address:2  FF00H or 0000H                     answer: the request
 *     06  request  code  address:2  value:2                            answer: the request
 *     15  request  code  address:2  quantity:2  octets:1  bits         answer: its first five octets
 *     16  request  code  address:2  quantity:2  octets:1  registers    answer: its first five octets
 *
 * The codes of coils are odd, those of registers even.
 */
#include "modbus/mb.h"

#define REGS_MAX 123u /* or 7B0H bits */

uint8_t mb_write_one(void)
{
    mb_span.table = MB_HOLDING;
    if (mb_pdu[0] & 1u) {
        mb_span.table = MB_COILS;
        if (mb_pdu[4] || (uint8_t)(mb_pdu[3] + 1u) > 1u)
            return MB_ILLEGAL_VALUE; /* not 0000H, FF00H: bit 0 of their first octet is the coil */
    }
    mb_span.addr = get_u16be(mb_pdu + 1);
    mb_span.qty = 1;
    mb_span.octets = mb_pdu + 3;
    mb_span.write = true;
    return mb_access();
}

uint8_t mb_write_many(void)
{
    const uint8_t octets = mb_range(mb_pdu[0] & 1u ? MB_COILS : MB_HOLDING, REGS_MAX);
    if (octets == 0 || octets != mb_pdu[5])
        return MB_ILLEGAL_VALUE;
    mb_pdu_len = 5;
    mb_span.octets = mb_pdu + 6;
    mb_span.write = true;
    return mb_access();
}
