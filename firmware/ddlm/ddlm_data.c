/* Data_Exchange, Global_Control and the process data between interrupt and main loop.
 *
 *   Data_Exchange -> newest ----------------------------> ddlm_outputs()      Operate
 *   Data_Exchange -> held  -- Sync, Unsync --> newest --> ddlm_outputs()      Sync mode
 *
 * Global_Control is executed in the interrupt, in order with Data_Exchange, so that Sync and Freeze act on the
 * data of their moment however late the main loop is. Telegram buffers change hands by pointer.
 * Source   EN 50170-2 part 8, Data_Exchange, Global_Control; spec A6; facts 3.6, 3.11
 */
#include "ddlm/ddlm_priv.h"
#include "hal/hal.h"

#define UNFREEZE 0x04u
#define FREEZE   0x08u
#define UNSYNC   0x10u
#define SYNC     0x20u
#define CLEAR    0x02u

/* What the interrupt leaves for the main loop. */
#define NOTE_WRONG_LENGTH  0x01u
#define NOTE_MODE          0x02u /* Sync or Freeze mode changed */
#define NOTE_NOT_SUPPORTED 0x04u

/* Outputs on their way. Invariant: filled implies buffer != 0. */
struct outputs {
    uint8_t XDATA *buffer; /* kept from FDL, 0 = none; may be stale: see filled */
    uint8_t XDATA *lsdu;
    bool filled;
};

struct fdl_reply PAGED ddlm_input_reply;
struct fdl_reply PAGED ddlm_rd_outp_reply;
static uint8_t XDATA input_rooms[3][FDL_ROOM(DEV_INPUT_MAX)];
static uint8_t XDATA rd_outp_rooms[3][FDL_ROOM(DEV_OUTPUT_MAX)];

static struct outputs XDATA newest;
static struct outputs XDATA held;
static IDATA volatile uint8_t safe;    /* the application must go to the fail-safe state */
static IDATA volatile uint8_t sync_on;
static HOT volatile uint8_t accepted; /* octets of outputs that Data_Exchange brings */
#define NOTHING 0xFFu                 /* a wrong length was seen: no more data exchange until the main loop has left it */
static IDATA volatile uint8_t notes;

/* ---- interrupt ------------------------------------------------------------------------------------------- */

static void keep_outputs_isr(struct outputs XDATA *to) IN_ISR
{
    to->lsdu = fdl_req.lsdu;
    to->buffer = fdl_keep_isr(to->buffer);
    to->filled = true;
}

static void clear_isr(void) IN_ISR
{
    newest.filled = false;
    held.filled = false;
    safe = true;
}

static void wrong_length_isr(void) IN_ISR
{
    fdl_count_isr(&ddlm_counters.wrong_length);
    notes |= NOTE_WRONG_LENGTH;
    if (DDLM_WRONG_LENGTH_LEAVES)
        accepted = NOTHING;
}

/* A master in Clear sends zeros, or, to a slave that offers Fail_Safe, no outputs at all. */
static bool is_clear_isr(void) IN_ISR
{
    if (DEV_FAIL_SAFE && fdl_req.len == 0)
        return accepted != NOTHING;
    return false;
}

static void data_exchange_isr(void) IN_ISR
{
    if (accepted == NOTHING)
        return;
    if (fdl_req.len != accepted) {
        if (!is_clear_isr()) {
            wrong_length_isr();
            return;
        }
        clear_isr();
    } else if (fdl_req.len) {
        if (sync_on) {
            keep_outputs_isr(&held);
        } else {
            keep_outputs_isr(&newest);
            safe = false;
        }
    }
    fdl_count_isr(&ddlm_counters.data_exchange);
}

/* What Sync mode held back goes to the application. */
static void release_outputs_isr(void) IN_ISR
{
    uint8_t XDATA *buffer = newest.buffer;

    if (!held.filled)
        return;
    newest.buffer = held.buffer;
    newest.lsdu = held.lsdu;
    newest.filled = true;
    held.buffer = buffer;
    held.filled = false;
    safe = false;
}

static void sync_command_isr(uint8_t command) IN_ISR
{
    if (command & UNSYNC) {
        release_outputs_isr();
        sync_on = false;
    } else if (command & SYNC) {
        if (!ddlm.sync_enabled) {
            notes |= NOTE_NOT_SUPPORTED;
            return;
        }
        release_outputs_isr();
        sync_on = true;
    }
}

static void freeze_command_isr(uint8_t command) IN_ISR
{
    if (command & UNFREEZE) {
        ddlm_input_reply.is &= (uint8_t)~FDL_HOLD;
    } else if (command & FREEZE) {
        if (!ddlm.freeze_enabled) {
            notes |= NOTE_NOT_SUPPORTED;
            return;
        }
        fdl_reply_release_isr(&ddlm_input_reply);
        ddlm_input_reply.is |= FDL_HOLD;
    }
}

/* Octet 1 command, octet 2 Group_Select: 0 = all. "Un" wins over its opposite. our choice: reserved bits and a
 * Global_Control of another length are ignored. */
static void global_control_isr(void) IN_ISR
{
    uint8_t command;

    if (fdl_req.len != 2 || (fdl_req.lsdu[1] != 0 && !(fdl_req.lsdu[1] & ddlm.groups)))
        return;
    command = fdl_req.lsdu[0];
    fdl_count_isr(&ddlm_counters.global_control);
    if (command & CLEAR)
        clear_isr();
    sync_command_isr(command);
    freeze_command_isr(command);
    if (command & (SYNC | UNSYNC | FREEZE | UNFREEZE))
        notes |= NOTE_MODE;
}

uint8_t fdl_ask_isr(void) IN_ISR
{
    if (fdl_req.dsap == FDL_SAP_NIL) {
        if (fdl_req.len != accepted && !is_clear_isr())
            return FDL_RS;
    } else if (fdl_req.dsap == SAP_SLAVE_DIAG) {
        if (fdl_box_in != fdl_box_out)
            ddlm_diag_ask_isr();
    } else if (fdl_req.dsap != SAP_GLOBAL_CONTROL) {
        return FDL_RS;
    }
    return FDL_OK;
}

void fdl_ind_isr(void) IN_ISR
{
    if (fdl_req.dsap == FDL_SAP_NIL)
        data_exchange_isr();
    else if (fdl_req.dsap == SAP_SLAVE_DIAG)
        ddlm_diag_read_isr();
    else if (fdl_req.dsap == SAP_GLOBAL_CONTROL)
        global_control_isr();
}

/* ---- main loop ------------------------------------------------------------------------------------------- */

void ddlm_data_init(void)
{
    newest.buffer = 0; /* FDL was reset: all buffers are its own again */
    held.buffer = 0;
    fdl_reply_init(&ddlm_input_reply, input_rooms[0], DEV_INPUT_MAX, FDL_SAP_NIL);
    fdl_reply_init(&ddlm_rd_outp_reply, rd_outp_rooms[0], DEV_OUTPUT_MAX, SAP_RD_OUTP);
    ddlm_data_safe();
}

void ddlm_data_safe(void)
{
    uint8_t irq = hal_irq_save();

    newest.filled = false;
    held.filled = false;
    safe = true;
    sync_on = false;
    notes = 0;
    ddlm_input_reply.is &= (uint8_t)~FDL_HOLD;
    hal_irq_restore(irq);
}

/* A station without inputs has nothing to wait for: its (empty) inputs are ready. */
void ddlm_data_start(void)
{
    fdl_reply_empty(&ddlm_input_reply);
    accepted = ddlm.output_len;
    if (ddlm.input_len == 0)
        ddlm_inputs(0);
}

void ddlm_inputs(const uint8_t XDATA *inputs)
{
    bool first = ddlm.state == DDLM_WAIT_CFG && ddlm.cfg_ok;

    if (!first && ddlm.state != DDLM_DATA_EXCH)
        return;
    fdl_reply_write(&ddlm_input_reply, inputs, ddlm.input_len, FDL_UPDATE_KEEP);
    if (!first)
        return;
    ddlm_enter();
    ddlm_diag_update();
}

static uint8_t XDATA *IDATA taken; /* L_sdu of the buffer */

static uint8_t XDATA *take_newest(void)
{
    uint8_t irq = hal_irq_save();
    uint8_t XDATA *buffer = 0;

    if (newest.filled) {
        buffer = newest.buffer;
        taken = newest.lsdu;
        newest.buffer = 0;
        newest.filled = false;
    }
    hal_irq_restore(irq);
    return buffer;
}

static bool take_safe(void)
{
    uint8_t irq = hal_irq_save();
    bool was = safe;

    safe = false;
    hal_irq_restore(irq);
    return was;
}

uint8_t ddlm_outputs(uint8_t XDATA *outputs)
{
    uint8_t XDATA *buffer;
    uint8_t out = DDLM_OUT_NEW;
    uint8_t i;

    if (take_safe()) {
        for (i = 0; i < ddlm.output_len; i++)
            outputs[i] = 0;
        out = DDLM_OUT_SAFE;
    } else {
        buffer = take_newest();
        if (!buffer)
            return DDLM_OUT_SAME;
        for (i = 0; i < ddlm.output_len; i++)
            outputs[i] = *taken++;
        fdl_give_back(buffer);
    }
    fdl_reply_write(&ddlm_rd_outp_reply, outputs, ddlm.output_len, FDL_UPDATE_LOW); /* RD_Outp_Upd */
    return out;
}

bool ddlm_sync_mode(void)
{
    return sync_on;
}

bool ddlm_freeze_mode(void)
{
    return (ddlm_input_reply.is & FDL_HOLD) != 0;
}

void ddlm_data_poll(void)
{
    uint8_t irq = hal_irq_save();
    uint8_t now = notes;

    notes = 0;
    hal_irq_restore(irq);
    if (now & NOTE_NOT_SUPPORTED)
        ddlm.faults |= DIAG_NOT_SUPPORTED;
    if ((now & NOTE_WRONG_LENGTH) && DDLM_WRONG_LENGTH_LEAVES) {
        ddlm.faults |= DIAG_CFG_FAULT;
        ddlm_leave_master();
    } else if (now & (NOTE_MODE | NOTE_NOT_SUPPORTED)) {
        ddlm_diag_update();
    }
}
