/* Function 12: comm event log. [A] 6.10.
 *
 *     request  0CH
 *     answer   0CH  octets:1  status:2  event count:2  message count:2  events, newest first, at most 64
 *
 * Our choice: the receive event of this very request is the newest one, for [A] stores it "before the remote
 * device processes the message".
 */
#include "modbus/mb_diag.h"
#include "modbus/mb_line.h"

/* Invariant: newest < MB_LOG_OCTETS, stored <= MB_LOG_OCTETS. */
static uint8_t XDATA events[MB_LOG_OCTETS];
static uint8_t newest, stored;

void mb_log_isr(uint8_t event) IN_ISR
{
    newest = (uint8_t)((newest + 1u) % MB_LOG_OCTETS);
    events[newest] = event;
    if (stored < MB_LOG_OCTETS)
        stored++;
}

void mb_log_clear(void)
{
    const uint8_t irq = hal_irq_save();
    stored = 0;
    hal_irq_restore(irq);
}

/* Nothing is logged by interrupts while main holds a frame. */
uint8_t mb_event_log(void)
{
    uint8_t i;
    uint8_t from = newest;
    for (i = 0; i < stored; i++) {
        mb_pdu[8u + i] = events[from];
        from = (uint8_t)((from + MB_LOG_OCTETS - 1u) % MB_LOG_OCTETS);
    }
    mb_pdu[1] = (uint8_t)(6u + stored);
    mb_put_status(mb_pdu + 2);
    put_u16be(mb_pdu + 6, mb_diag.counter[MB_BUS_MESSAGE]);
    mb_pdu_len = (uint8_t)(8u + stored);
    return MB_OK;
}
