/* The plan: what is done with a telegram when it turns out to be good, made while the rest of it comes in.
 *
 * Layer    fdl_rx -> [fdl_plan] -> fdl
 * Context  interrupt; main makes the plan anew, locked, where it changes what it was made from
 * Source   EN 50170-2 part 4: addresses 4.7.3, FC 4.7.4, answers of the responder 4.1.3; spec A3, A4
 */
#include "fdl/fdl_priv.h"
#include "phy_uart/phy_uart.h"

#define EXT_UNKNOWN 0xC0u /* further extension, region or segment address: not for a station without them */

HOT struct fdl_plan fdl_plan;
HOT struct fdl_req fdl_req;
HOT uint8_t fdl_ts;
IDATA uint8_t fdl_skips_others;
IDATA uint8_t fdl_watched;

/* Functions other than these are unknown to a responder and get no answer (our choice: 7, MSRD, and the clock
 * functions belong to DP-V2). */
const CODE uint8_t fdl_functions[FDL_FC_FUNCTION + 1u] = {
    [FDL_SDA_LOW] = FDL_SDA,       [FDL_SDA_HIGH] = FDL_SDA | FDL_IS_HIGH,
    [FDL_SDN_LOW] = FDL_SDN,       [FDL_SDN_HIGH] = FDL_SDN | FDL_IS_HIGH,
    [FDL_SRD_LOW] = FDL_SRD,       [FDL_SRD_HIGH] = FDL_SRD | FDL_IS_HIGH,
    [FDL_STATUS] = FDL_NUMBERLESS, [FDL_IDENT] = FDL_NUMBERLESS,
    [FDL_LSAP_STATUS] = FDL_NUMBERLESS,
};

/* ---- the answer ------------------------------------------------------------------------------------------ */

static void refuse_isr(uint8_t function) IN_ISR
{
    fdl_plan.refusal = function;
    fdl_tx_fixed_isr(function);
}

/* No L_sdu: an SD1 says "diagnosis pending" where an SC could not (spec A3; facts 3.9); SC is "no reply data". */
static void empty_isr(void) IN_ISR
{
    if (fdl_plan.is & FDL_HIGH)
        fdl_tx_fixed_isr(FDL_DH);
    else
        fdl_tx_short_isr();
}

/* The frame that stands there, if it is one and the right one; else a new one. The room that holds the answer kept for a
 * retry is not written to before the request is known to be good. */
static void room_isr(struct fdl_room PAGED *room) IN_ISR
{
    const uint8_t head = (uint8_t)(fdl_header.len - fdl_req.len);
    const uint8_t XDATA *at = room->octets;

    phy_tx.len = (uint8_t)(at[0] + head + 6u);
    at += (uint8_t)(FDL_ROOM_HEAD - 4u - head);
    phy_tx.at = at;
    if (room->head == head && !fdl_req.sd3) {
        at += 4;
        if (at[0] == fdl_header.sa && at[1] == fdl_header.da && at[2] == (FDL_DL | (fdl_plan.is & FDL_HIGH)) &&
            (head != 5u || (at[3] == fdl_header.more[1] && at[4] == fdl_header.more[0])) &&
            (head != 4u || at[3] == fdl_header.more[0]))
            return;
    }
    if (phy_tx.len == (uint8_t)(head + 6u))
        empty_isr();
    else if ((uint8_t)(phy_tx.len - 6u) > FDL_LE_MAX)
        refuse_isr(FDL_UE); /* our choice: asked with SAPs, they leave no room for so many data */
    else if (!(fdl_plan.is & FDL_FRESH) && fdl_last.reply == fdl_req.reply)
        fdl_plan.late = true;
    else
        fdl_tx_frame_isr(room);
}

/* An SRD or Ident is answered from fdl_req.reply. */
static void reply_isr(void) IN_ISR
{
    struct fdl_reply PAGED *reply = fdl_req.reply;

    fdl_plan.refusal = FDL_OK;
    fdl_plan.late = false;
    fdl_plan.is = reply->is;
    if (fdl_plan.is & FDL_HOLD)
        fdl_plan.is &= (uint8_t)~FDL_FRESH;
    if (!(fdl_plan.is & FDL_VALID)) {
        fdl_plan.is = 0;
        fdl_tx_short_isr();
    } else if (fdl_plan.is & FDL_FRESH) {
        room_isr(reply->ready);
    } else {
        room_isr(reply->sent);
    }
}

/* ---- the decision ---------------------------------------------------------------------------------------- */

/* What the SAP's row says. */
static void decide_isr(void) IN_ISR
{
    const struct fdl_sap PAGED *row = fdl_row_of[fdl_req.dsap];

    fdl_plan.result = FDL_RS;
    if (!(row->services & fdl_req.service))
        return;
    if (row->access != FDL_ALL && row->access != fdl_req.sa)
        return;
    fdl_plan.result = FDL_RR; /* our choice: the L_sdu is longer than the resource activated for it */
    if (fdl_header.len > FDL_BODY_MAX || fdl_req.len > row->max_len)
        return;
    fdl_plan.result = FDL_OK;
    fdl_plan.row_handling = row->handling;
    if (fdl_req.service == FDL_SRD)
        fdl_plan.row_reply = row->reply;
}

/* FDL status, Ident and LSAP status: not numbered, they leave the FCB alone. */
static void status_isr(void) IN_ISR
{
    const uint8_t function = fdl_header.fc & FDL_FC_FUNCTION;

    fdl_plan.result = FDL_OK;
    if (function == FDL_LSAP_STATUS)
        fdl_plan.result = fdl_lsap_isr();
    else if (function == FDL_IDENT)
        fdl_plan.row_reply = fdl_ident_reply_isr();
}

/* The rest of the decision: what may be another one each time. */
static void settle_isr(void) IN_ISR
{
    uint8_t refusal;

    fdl_plan.stage = FDL_PLANNED;
    fdl_plan.stale = false;
    fdl_plan.refusal = fdl_plan.result;
    fdl_plan.handling = fdl_plan.row_handling;
    fdl_req.reply = fdl_plan.row_reply;
    if (fdl_plan.handling == FDL_TO_ISR) {
        refusal = fdl_ask_isr();
        if (refusal)
            fdl_plan.refusal = refusal;
    } else if (fdl_plan.handling != FDL_ANSWER_ONLY && !fdl_box_is_free_isr()) {
        fdl_plan.handling = FDL_ANSWER_ONLY;
        fdl_plan.refusal = FDL_RR;
    }
}

/* Not from a reply. */
static void plain_isr(void) IN_ISR
{
    fdl_plan.is = 0;
    fdl_plan.late = false;
    fdl_req.reply = 0;
    if (fdl_req.service == FDL_SDN) {
        fdl_plan.refusal = FDL_OK;
        phy_tx.len = 0;
    } else if (fdl_plan.refusal) {
        fdl_tx_fixed_isr(fdl_plan.refusal);
    } else if (fdl_req.service != FDL_NUMBERLESS) {
        fdl_tx_short_isr();
    } else if ((fdl_header.fc & FDL_FC_FUNCTION) == FDL_LSAP_STATUS) {
        fdl_tx_lsap_isr();
    } else {
        fdl_tx_status_isr();
    }
}

static void answer_isr(void) IN_ISR
{
    settle_isr();
    if (fdl_req.reply && !fdl_plan.refusal)
        reply_isr();
    else
        plain_isr();
}

static void plan_isr(void) IN_ISR
{
    fdl_plan.row_reply = 0;
    fdl_plan.row_handling = FDL_ANSWER_ONLY;
    if (fdl_req.service == FDL_NUMBERLESS)
        status_isr();
    else
        decide_isr();
    answer_isr();
}

/* ---- telegram -------------------------------------------------------------------------------------------- */

/* A header to this station or to all, not that of the last request to us. */
static void read_header_isr(void) IN_ISR
{
    fdl_req.sa = fdl_header.sa & 0x7Fu;
    fdl_req.service = fdl_functions[fdl_header.fc & FDL_FC_FUNCTION] & (uint8_t)~FDL_IS_HIGH;
    fdl_req.len = (uint8_t)(fdl_header.len - 3u);
    fdl_req.dsap = FDL_SAP_NIL;
    fdl_req.ssap = FDL_SAP_NIL;
    if ((fdl_header.da & 0x7Fu) == FDL_BROADCAST) {
        fdl_plan.hears = FDL_HEARD_ANY;
        if (fdl_req.service != FDL_SDN)
            fdl_req.service = 0;
    } else {
        fdl_plan.hears = FDL_HEARD_ANY | FDL_HEARD_OWN;
        if (fdl_req.sa == fdl_watched)
            fdl_plan.hears = FDL_HEARD_ANY | FDL_HEARD_OWN | FDL_HEARD_OWNER;
    }
    if ((fdl_header.fc & FDL_FC_RESERVED) || fdl_req.sa == FDL_BROADCAST)
        fdl_req.service = 0;
}

/* [DAE] [SAE], both as a rule. */
static void read_saps_isr(void) IN_ISR
{
    fdl_req.dsap = fdl_header.more[0];
    fdl_req.ssap = fdl_header.more[1];
    fdl_req.len = (uint8_t)(fdl_header.len - 5u);
    if (fdl_header.da & fdl_header.sa & FDL_ADDRESS_EXT) {
        if (((fdl_header.more[0] | fdl_header.more[1]) & EXT_UNKNOWN) || fdl_header.len < 5u)
            fdl_req.service = 0;
        return;
    }
    fdl_req.len++;
    fdl_req.ssap = FDL_SAP_NIL;
    if (fdl_header.sa & FDL_ADDRESS_EXT) {
        fdl_req.ssap = fdl_header.more[0];
        fdl_req.dsap = FDL_SAP_NIL;
    }
    if (fdl_header.more[0] & EXT_UNKNOWN)
        fdl_req.service = 0;
}

/* All is known. */
static void make_isr(void) IN_ISR
{
    if (fdl_req.service == 0)
        return;
    plan_isr();
    if (!fdl_req.sd3)
        fdl_plan.made = fdl_header.len;
}

/* Perhaps a retry? */
static void number_isr(void) IN_ISR
{
    fdl_plan.again = 0;
    if (fdl_header.fc == fdl_last.fc)
        fdl_plan.again = fdl_header.fc & FDL_FC_FCV;
}

void fdl_da_isr(uint8_t da) IN_ISR
{
    fdl_plan.stage = FDL_UNKNOWN;
    fdl_plan.awaited = 0;
    if (da != fdl_header.da) {
        fdl_header.da = da;
        fdl_plan.made = 0;
    }
    fdl_plan.same = fdl_plan.made == fdl_header.len;
}

bool fdl_header_isr(void) IN_ISR
{
    const uint8_t XDATA *at = fdl_rx_buf + (FDL_BODY + 1u);
    const uint8_t sa = *at++;
    const uint8_t fc = *at;

    if (!(fc & FDL_FC_REQUEST)) {
        fdl_plan.stage = FDL_OTHERS;
        return false;
    }
    if (sa != fdl_header.sa || ((fc ^ fdl_header.fc) & (uint8_t)~(FDL_FC_FCB | FDL_FC_FCV))) {
        fdl_plan.same = false;
        fdl_header.sa = sa;
    }
    fdl_header.fc = fc;
    number_isr();
    if (!fdl_plan.same) {
        fdl_plan.made = 0;
        read_header_isr();
    }
    if ((fdl_header.da | fdl_header.sa) & FDL_ADDRESS_EXT) {
        if (fdl_header.len != 3u)
            return true;
        fdl_req.service = 0; /* and no SAPs */
    }
    if (fdl_plan.same)
        answer_isr();
    else
        make_isr();
    return false;
}

void fdl_saps_isr(void) IN_ISR
{
    const uint8_t XDATA *more = fdl_rx_buf + (FDL_BODY + 3u);
    const uint8_t first = more[0];
    const uint8_t second = more[1];

    if (fdl_plan.same) {
        if (first == fdl_header.more[0] && second == fdl_header.more[1]) {
            answer_isr();
            return;
        }
        fdl_plan.same = false;
        fdl_plan.made = 0;
    }
    fdl_header.more[0] = first;
    fdl_header.more[1] = second;
    read_saps_isr();
    make_isr();
}

/* ---- the next one ---------------------------------------------------------------------------------------- */

/* A numbered request, or the first of a row of them, is followed by one with the other FCB. */
void fdl_answered_isr(void) IN_ISR
{
    if (fdl_header.fc & (FDL_FC_FCB | FDL_FC_FCV))
        fdl_header.fc = (uint8_t)((fdl_header.fc | FDL_FC_FCV) ^ FDL_FC_FCB);
}

/* What the next telegram looks like that has the header of the plan. */
static void model_isr(void) IN_ISR
{
    uint8_t IDATA *at = PHY_MODEL_END;

    if (fdl_header.sa & FDL_ADDRESS_EXT)
        *--at = fdl_header.da & FDL_ADDRESS_EXT ? fdl_header.more[1] : fdl_header.more[0];
    if (fdl_header.da & FDL_ADDRESS_EXT)
        *--at = fdl_header.more[0];
    *--at = fdl_header.fc;
    *--at = fdl_header.sa;
    *--at = fdl_header.da;
    *--at = FDL_SD2;
    *--at = fdl_header.len;
    *--at = fdl_header.len;
    *--at = FDL_SD2;
    fdl_plan.awaited = (uint8_t)(PHY_MODEL_END - at);
}

bool fdl_await_isr(void) IN_ISR
{
    fdl_plan.stage = FDL_IDLE;
    if (fdl_plan.made < FDL_LE_MIN || fdl_plan.made > FDL_BODY_MAX)
        return false;
    fdl_header.len = fdl_plan.made;
    if (!fdl_plan.awaited) {
        number_isr();
        fdl_plan.same = true;
        answer_isr();
        model_isr();
    }
    fdl_plan.stage = FDL_AWAITED;
    return true;
}

/* ---- main changes something ------------------------------------------------------------------------------ */

void fdl_unplan_isr(void) IN_ISR
{
    fdl_plan.made = 0;
    fdl_plan.same = false; /* nor is it when only the SAPs are still to come: they are read into a new fdl_req */
    if (fdl_plan.stage == FDL_UNKNOWN)
        read_header_isr();
    if (fdl_plan.stage == FDL_AWAITED)
        fdl_plan.stage = FDL_IDLE;
}

void fdl_resettle_isr(void) IN_ISR
{
    const uint8_t stage = fdl_plan.stage;

    if (stage == FDL_PLANNED || stage == FDL_AWAITED)
        answer_isr();
    else
        fdl_plan.awaited = 0;
    fdl_plan.stage = stage;
}

void fdl_written_isr(struct fdl_reply PAGED *reply) IN_ISR
{
    if (fdl_plan.stage != FDL_PLANNED && fdl_plan.stage != FDL_AWAITED)
        fdl_plan.awaited = 0;
    else if (reply == fdl_req.reply)
        fdl_plan.stale = true;
}

void fdl_refresh_isr(void) IN_ISR
{
    if (!fdl_plan.stale)
        return;
    if (fdl_plan.stage == FDL_PLANNED || fdl_plan.stage == FDL_AWAITED)
        reply_isr();
    else
        fdl_plan.awaited = 0;
    fdl_plan.stale = false;
}

void fdl_replan_isr(struct fdl_reply PAGED *reply) IN_ISR
{
    if (reply) {
        fdl_written_isr(reply);
        fdl_refresh_isr();
        return;
    }
    fdl_unplan_isr();
    if (fdl_plan.stage == FDL_PLANNED)
        plan_isr();
}
