/* Function 23: read/write multiple registers. [A] 6.17: the write is done before the read.
 *
 *     request  17H  read address:2  quantity:2  write address:2  quantity:2  octets:1  registers
 *     answer   17H  octets:1  registers                      quantity read 1..125, written 1..121
 */
#include "modbus/mb.h"

#define READ_MAX  125u
#define WRITE_MAX 121u

static void read_range(void)
{
    mb_span.write = false;
    mb_span.addr = get_u16be(mb_pdu + 1);
    mb_span.qty = mb_pdu[4];
    mb_span.octets = mb_pdu + 2;
}

static void write_range(void)
{
    mb_span.write = true;
    mb_span.addr = get_u16be(mb_pdu + 5);
    mb_span.qty = mb_pdu[8];
    mb_span.octets = mb_pdu + 10;
}

uint8_t mb_read_write(void)
{
    const uint16_t read_qty = get_u16be(mb_pdu + 3);
    const uint16_t write_qty = get_u16be(mb_pdu + 7);
    uint8_t exception;
    if (read_qty - 1u >= READ_MAX || write_qty - 1u >= WRITE_MAX || mb_pdu[9] != (uint8_t)(2u * write_qty))
        return MB_ILLEGAL_VALUE;
    mb_span.table = MB_HOLDING;
    read_range();
    exception = mb_check();
    if (exception)
        return exception;
    write_range();
    exception = mb_access();
    if (exception)
        return exception;
    read_range();
    mb_pdu[1] = (uint8_t)(2u * read_qty);
    mb_pdu_len = (uint8_t)(2u + mb_pdu[1]);
    return mb_access();
}
