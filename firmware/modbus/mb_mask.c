/* Function 22: mask write register. [A] 6.16.
 *
 *     request  16H  address:2  and:2  or:2      answer: the request
 *     register = (register AND and) OR (or AND NOT and)
 */
#include "modbus/mb.h"

uint8_t mb_mask_write(void)
{
    const uint16_t and_mask = get_u16be(mb_pdu + 3);
    const uint16_t or_mask = get_u16be(mb_pdu + 5);
    uint8_t XDATA *const value = mb_pdu + 7; /* behind the request */
    uint8_t exception;
    mb_span.table = MB_HOLDING;
    mb_span.write = false;
    mb_span.addr = get_u16be(mb_pdu + 1);
    mb_span.qty = 1;
    mb_span.octets = value;
    exception = mb_access();
    if (exception)
        return exception;
    put_u16be(value, (uint16_t)((get_u16be(value) & and_mask) | (or_mask & (uint16_t)~and_mask)));
    mb_span.write = true;
    return mb_access();
}
