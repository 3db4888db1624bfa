/* Functions 20, 21: read and write file records. [A] 6.14, 6.15. A record is a register of a block of table
 * MB_FILE.
 *
 *     20  request  14H  octets:1  groups of  06  file:2  record:2  length:2            octets 07H..F5H
 *         answer   14H  octets:1  groups of  1 + 2 length  06  registers
 *     21  request  15H  octets:1  groups of  06  file:2  record:2  length:2  registers  octets 09H..FBH
 *         answer: the request
 *
 * All groups are checked before anything is read or written. Order of exceptions: octets 3; then per group
 * reference type, file, record, end of the file: 2. our choice: a group that is not complete, a length of 0
 * and an answer longer than a PDU are exception 3; the upper limit of function 21 is FBH (text and table; the
 * state diagram still has F5H of an older edition).
 */
#include "modbus/mb_line.h"

#define REFERENCE_TYPE  6u
#define GROUP_OCTETS    7u
#define RECORD_MAX      0x270Fu
#define READ_OCTETS_MAX 0xF5u
#define QTY_MAX         124u /* registers of one group that fit a PDU */

/* The group at p into mb_span. left: octets of the request from p on. -> exception */
static uint8_t take_group(const uint8_t XDATA *p, uint8_t left)
{
    if (left < GROUP_OCTETS)
        return MB_ILLEGAL_VALUE;
    if (p[0] != REFERENCE_TYPE)
        return MB_ILLEGAL_ADDRESS;
    mb_span.table = MB_FILE;
    mb_span.file = get_u16be(p + 1);
    mb_span.addr = get_u16be(p + 3);
    mb_span.qty = get_u16be(p + 5);
    return mb_span.qty - 1u < QTY_MAX ? MB_OK : MB_ILLEGAL_VALUE;
}

static uint8_t check_or_move(bool move)
{
    if (move)
        return mb_access();
    if (mb_span.addr > RECORD_MAX || mb_span.qty - 1u > RECORD_MAX - mb_span.addr)
        return MB_ILLEGAL_ADDRESS;
    return mb_check();
}

/* One pass over the groups of a read: their request in copy, the answer grows in mb_pdu. */
static uint8_t read_pass(const uint8_t XDATA *copy, uint8_t left, bool move)
{
    uint8_t at = 2;
    while (left) {
        uint8_t exception = take_group(copy, left);
        const uint8_t octets = (uint8_t)(2u * mb_span.qty);
        if (exception)
            return exception;
        if (at + 2u + octets > MB_PDU_MAX)
            return MB_ILLEGAL_VALUE;
        mb_span.write = false;
        mb_span.octets = mb_pdu + at + 2;
        exception = check_or_move(move);
        if (exception)
            return exception;
        mb_pdu[at] = (uint8_t)(1u + octets);
        mb_pdu[at + 1u] = REFERENCE_TYPE;
        at = (uint8_t)(at + 2u + octets);
        copy += GROUP_OCTETS;
        left = (uint8_t)(left - GROUP_OCTETS);
    }
    mb_pdu_len = at;
    return MB_OK;
}

uint8_t mb_read_file(void)
{
    uint8_t XDATA *const copy = mb_adu + MB_ADU_OCTETS / 2;
    const uint8_t octets = mb_pdu[1];
    uint8_t i;
    uint8_t exception;
    if (octets < GROUP_OCTETS || octets > READ_OCTETS_MAX)
        return MB_ILLEGAL_VALUE;
    for (i = 0; i < octets; i++)
        copy[i] = mb_pdu[2u + i];
    exception = read_pass(copy, octets, false);
    if (!exception)
        exception = read_pass(copy, octets, true);
    mb_pdu[1] = (uint8_t)(mb_pdu_len - 2u);
    return exception;
}

static uint8_t write_pass(bool move)
{
    uint8_t XDATA *group = mb_pdu + 2;
    uint8_t left = mb_pdu[1];
    while (left) {
        uint8_t exception = take_group(group, left);
        const uint8_t octets = (uint8_t)(GROUP_OCTETS + 2u * mb_span.qty);
        if (exception)
            return exception;
        if (octets > left)
            return MB_ILLEGAL_VALUE;
        mb_span.write = true;
        mb_span.octets = group + GROUP_OCTETS;
        exception = check_or_move(move);
        if (exception)
            return exception;
        group += octets;
        left = (uint8_t)(left - octets);
    }
    return MB_OK;
}

uint8_t mb_write_file(void)
{
    uint8_t exception;
    if (mb_pdu[1] < GROUP_OCTETS + 2u) /* the upper limit, FBH, is that of a PDU */
        return MB_ILLEGAL_VALUE;
    exception = write_pass(false);
    return exception ? exception : write_pass(true);
}
