/* Function 24: read FIFO queue. [A] 6.18. Reading does not take anything from the queue.
 *
 *     request  18H  pointer address:2
 *     answer   18H  octets:2  count:2  values          count 0..31; octets = 2 + 2 count
 *
 * A queue is a block of table MB_FIFO: its first is the pointer address, its register 0 the count.
 */
#include "modbus/mb.h"

#define COUNT_MAX 31u

uint8_t mb_read_fifo(void)
{
    const uint16_t pointer = get_u16be(mb_pdu + 1);
    const struct mb_block CODE *queue = mb_map;
    uint8_t exception;
    while (queue->table && (queue->table != MB_FIFO || queue->first != pointer))
        queue++;
    if (queue->table == 0)
        return MB_ILLEGAL_ADDRESS;
    mb_span.table = MB_FIFO;
    mb_span.write = false;
    mb_span.addr = pointer;
    mb_span.qty = queue->count <= COUNT_MAX ? queue->count : COUNT_MAX + 1u;
    mb_span.octets = mb_pdu + 3;
    exception = mb_access(); /* count and values at once: they fit each other */
    if (exception)
        return exception;
    if (mb_pdu[3] || mb_pdu[4] > COUNT_MAX)
        return MB_ILLEGAL_VALUE;
    if (mb_pdu[4] >= mb_span.qty)
        return MB_DEVICE_FAILURE; /* a count that the block cannot hold */
    mb_pdu[1] = 0;
    mb_pdu[2] = (uint8_t)(2u + 2u * mb_pdu[4]);
    mb_pdu_len = (uint8_t)(3u + mb_pdu[2]);
    return MB_OK;
}
