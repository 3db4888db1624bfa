/* Function 08: diagnostics. [A] 6.8; counters [S] appendix A.
 *
 *     request  08H  sub-function:2  data:2 (sub-function 0: any number of octets)
 *     answer   08H  sub-function:2  data:2
 *
 * Sub-functions 5..9, 13H and from 15H on are reserved: exception 1.
 */
#include "modbus/mb_diag.h"
#include "modbus/mb_line.h"

enum { /* [A] 6.8.1 */
       RETURN_QUERY_DATA = 0x00,
       RESTART = 0x01,
       RETURN_DIAGNOSTIC_REGISTER = 0x02,
       CHANGE_DELIMITER = 0x03,
       FORCE_LISTEN_ONLY = 0x04,
       CLEAR_COUNTERS = 0x0A,
       FIRST_COUNTER = 0x0B,
       LAST_COUNTER = 0x12,
       CLEAR_OVERRUN = 0x14,
};

static void put_data(uint16_t value)
{
    put_u16be(mb_pdu + 3, value);
}

/* Data 0000H keeps the event log, FF00H clears it. */
static uint8_t restart(void)
{
    if (mb_pdu[4] || (uint8_t)(mb_pdu[3] + 1u) > 1u)
        return MB_ILLEGAL_VALUE;
    mb_diag_restart(mb_pdu[3] != 0);
    return MB_OK;
}

/* Data: the character, 00H. Our choice: a character that frames are made of is refused; in RTU the character
 * is taken and has no effect. */
static uint8_t change_delimiter(void)
{
    const uint8_t c = mb_pdu[3];
    if (mb_pdu[4] || c == 0 || c > 0x7Fu || c == ':' || c == '\r' || (c >= '0' && c <= '9') ||
        (c >= 'A' && c <= 'F'))
        return MB_ILLEGAL_VALUE;
    mb_next_delimiter = c;
    return MB_OK;
}

static uint8_t listen_only(void)
{
    if (MB_HAS_LOG) {
        const uint8_t irq = hal_irq_save();
        mb_log_isr(MB_EVENT_ENTERED_LISTEN);
        hal_irq_restore(irq);
    }
    mb_diag.listen_only = true;
    return MB_OK;
}

uint8_t mb_diagnostics(void)
{
    const uint8_t sub = mb_pdu[2];
    if (mb_pdu[1] || (!MB_WITH_ASCII && sub == CHANGE_DELIMITER) ||
        (sub > FORCE_LISTEN_ONLY && sub < CLEAR_COUNTERS) || sub == 0x13 || sub > CLEAR_OVERRUN)
        return MB_ILLEGAL_FUNCTION;
    if (sub == RETURN_QUERY_DATA)
        return MB_OK;
    if (mb_pdu_len != 5)
        return MB_ILLEGAL_VALUE;
    if (sub == RESTART)
        return restart();
    if (MB_WITH_ASCII && sub == CHANGE_DELIMITER)
        return change_delimiter();
    if (mb_pdu[3] || mb_pdu[4])
        return MB_ILLEGAL_VALUE;
    if (sub >= FIRST_COUNTER && sub <= LAST_COUNTER)
        put_data(mb_diag.counter[sub - FIRST_COUNTER]);
    else if (sub == RETURN_DIAGNOSTIC_REGISTER)
        put_data(mb_diag.diagnostic);
    else if (sub == CLEAR_COUNTERS)
        mb_diag_clear();
    else if (sub == CLEAR_OVERRUN)
        mb_diag.counter[MB_OVERRUN] = 0;
    else
        return listen_only();
    return MB_OK;
}
