/* What is counted and logged of each message. [S] appendix A, [A] 6.10.
 *
 * Counters of the line (bus message, bus error, overrun) are written by the interrupts, the others by main
 * while it holds the frame; the event log by both, in the interrupt or with interrupts masked.
 */
#include "modbus/mb_diag.h"
#include "modbus/mb_line.h"

struct mb_diag XDATA mb_diag;

static enum { NO_RESTART, RESTART_KEEP_LOG, RESTART_CLEAR_LOG } restart;
static bool executed; /* the request at hand; not so in listen-only mode */

static void log_event(uint8_t event)
{
    if (MB_HAS_LOG) {
        const uint8_t irq = hal_irq_save();
        mb_log_isr(event);
        hal_irq_restore(irq);
    }
}

void mb_bad_frame_isr(uint8_t flaws) IN_ISR
{
    mb_diag.counter[MB_BUS_ERROR]++;
    if (flaws & HAL_ERR_OVERRUN)
        mb_diag.counter[MB_OVERRUN]++;
    if (MB_HAS_LOG)
        mb_log_isr((uint8_t)(MB_EVENT_RECEIVE | MB_EVENT_COMM_ERROR |
                             (flaws & HAL_ERR_OVERRUN ? MB_EVENT_OVERRUN : 0u) |
                             (mb_diag.listen_only ? MB_EVENT_LISTEN_ONLY : 0u)));
}

void mb_diag_clear(void)
{
    uint8_t i;
    const uint8_t irq = hal_irq_save();
    for (i = 0; i < MB_COUNTERS; i++)
        mb_diag.counter[i] = 0;
    hal_irq_restore(irq);
    mb_diag.events = 0;
    mb_diag.diagnostic = 0;
}

void mb_diag_restart(bool clear_log)
{
    restart = clear_log ? RESTART_CLEAR_LOG : RESTART_KEEP_LOG;
}

/* Our choice: everything is cleared when the answer has left, so the request that asked for it is in no
 * counter. */
void mb_diag_poll(void)
{
    if (restart == NO_RESTART || mb_rx.state == MB_SENDING)
        return;
    if (MB_HAS_LOG && restart == RESTART_CLEAR_LOG)
        mb_log_clear();
    restart = NO_RESTART;
    mb_diag.listen_only = false;
    mb_diag_clear();
    log_event(MB_EVENT_RESTART);
    mb_open();
    mb_restart_ind();
}

/* Function 8/1, the only one that is executed in listen-only mode. */
static bool is_restart(void)
{
    return mb_adu[0] != 0 && mb_pdu_len >= 3 && mb_pdu[0] == 8 && mb_pdu[1] == 0 && mb_pdu[2] == 1;
}

bool mb_diag_begin(void)
{
    mb_diag.counter[MB_SLAVE_MESSAGE]++;
    log_event((uint8_t)(MB_EVENT_RECEIVE | (mb_adu[0] ? 0u : MB_EVENT_BROADCAST) |
                        (mb_diag.listen_only ? MB_EVENT_LISTEN_ONLY : 0u)));
    executed = !mb_diag.listen_only || is_restart();
    return executed;
}

static uint8_t exception_event(uint8_t exception)
{
    if (exception == MB_OK || exception > MB_NEGATIVE_ACKNOWLEDGE)
        return 0;
    if (exception <= MB_ILLEGAL_VALUE)
        return MB_EVENT_EXCEPTION_1_3;
    if (exception == MB_DEVICE_FAILURE)
        return MB_EVENT_EXCEPTION_4;
    return exception == MB_NEGATIVE_ACKNOWLEDGE ? MB_EVENT_EXCEPTION_7 : MB_EVENT_EXCEPTION_5_6;
}

/* [A] 6.9: the event counter counts successful messages, but not function 11. [S] appendix A: a refused
 * broadcast counts as an exception, too; counter 5 has broadcasts, and our choice: what listen-only mode
 * keeps silent. */
void mb_diag_end(uint8_t exception, bool answered)
{
    if (exception)
        mb_diag.counter[MB_EXCEPTION]++;
    else if (executed && mb_pdu[0] != 11)
        mb_diag.events++;
    if (exception == MB_NEGATIVE_ACKNOWLEDGE)
        mb_diag.counter[MB_NAK]++;
    if (exception == MB_BUSY)
        mb_diag.counter[MB_BUSY_COUNT]++;
    if (!answered)
        mb_diag.counter[MB_NO_RESPONSE]++;
    log_event((uint8_t)(MB_EVENT_SEND | exception_event(exception) |
                        (mb_diag.listen_only ? MB_EVENT_LISTEN_ONLY : 0u)));
}
