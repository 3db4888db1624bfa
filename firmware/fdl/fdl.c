/* The responder: who is meant, is it a retry, which SAP, what answer.
 *
 * Source   EN 50170-2 part 4: addresses 4.7.3, FC and FCB 4.7.4, 4.1.3; spec A3, A4; facts section 0 for the retry rule
 */
#include "fdl/fdl_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

/* Body: DA SA FC [DAE] [SAE] L_sdu */
#define DA 0u
#define SA 1u
#define FC 2u
#define EXT_UNKNOWN 0xC0u /* further extension, region or segment address: not for a station without them */

#define BUFFERS (1u + FDL_BOXES + FDL_KEPT_MAX + 1u) /* receiver, boxes, kept ones, one in exchange */

struct box {
    struct fdl_ind ind;
    uint8_t XDATA *buffer;
};

struct fdl_counters XDATA fdl_counters;
HOT struct fdl_req fdl_req;
HOT uint8_t fdl_ts;

static volatile HOT uint8_t heard;
static HOT uint8_t watched;

static uint8_t XDATA memory[BUFFERS][FDL_BUF_LEN];
static uint8_t XDATA *XDATA stock[BUFFERS]; /* free buffers: stock[0..in_stock-1] */
static uint8_t in_stock;

/* Single producer (interrupt: box_in), single consumer (main loop: box_out); a box belongs to the main loop from the
 * moment box_in has passed it until box_out has. One octet each, so neither side can see half an index. */
static struct box XDATA boxes[FDL_BOXES + 1u];
static volatile uint8_t box_in;
static volatile uint8_t box_out;

/* The last numbered request and its answer. A frame is a retry only if it is the same frame: FCV, same SA, same FCB and
 * octet-identical, for which length, header, SAPs and FCS are compared. Masters that forget to restart the FCB after a
 * lost answer would otherwise be answered with stale data for ever (facts, section 0). */
static struct {
    bool valid;
    uint8_t len;
    uint8_t header[5]; /* DA SA FC and two octets more */
    uint8_t fcs;
    const uint8_t XDATA *answer;
    uint8_t answer_len;
    struct fdl_reply XDATA *reply; /* the answer stands in its room; 0 = elsewhere */
    uint8_t turns;                 /* of reply, when the answer was built          */
} XDATA last;

/* ---- buffers --------------------------------------------------------------------------------------------------------- */

static uint8_t XDATA *stock_take_isr(void) IN_ISR
{
    return stock[--in_stock];
}

uint8_t XDATA *fdl_keep_isr(uint8_t XDATA *exchange) IN_ISR
{
    uint8_t XDATA *kept = fdl_rx_buf;

    fdl_rx_buf = exchange ? exchange : stock_take_isr();
    return kept;
}

void fdl_give_back(uint8_t XDATA *buffer)
{
    uint8_t irq = hal_irq_save();

    stock[in_stock++] = buffer;
    hal_irq_restore(irq);
}

static uint8_t next_box_isr(uint8_t box) IN_ISR
{
    return box == FDL_BOXES ? 0u : (uint8_t)(box + 1u);
}

/* Into a box for the main loop -> FDL_OK, or FDL_RR when all are taken. */
static uint8_t box_isr(void) IN_ISR
{
    uint8_t next = next_box_isr(box_in);
    struct box XDATA *box = &boxes[box_in];

    if (next == box_out)
        return FDL_RR;
    box->ind.service = fdl_req.service;
    box->ind.high = fdl_req.high;
    box->ind.dsap = fdl_req.dsap;
    box->ind.ssap = fdl_req.ssap;
    box->ind.sa = fdl_req.sa;
    box->ind.len = fdl_req.len;
    box->ind.lsdu = fdl_req.lsdu;
    box->buffer = fdl_keep_isr(0);
    box_in = next;
    return FDL_OK;
}

bool fdl_waiting_isr(uint8_t dsap) IN_ISR
{
    uint8_t box;

    for (box = box_out; box != box_in; box = next_box_isr(box))
        if (boxes[box].ind.dsap == dsap && boxes[box].ind.sa == fdl_req.sa)
            return true;
    return false;
}

void fdl_poll(void)
{
    const uint8_t in = box_in; /* what comes meanwhile waits for the next turn */
    uint8_t out;

    while (box_out != in) {
        out = box_out;
        fdl_data_ind(&boxes[out].ind);
        fdl_give_back(boxes[out].buffer);
        box_out = out == FDL_BOXES ? 0u : (uint8_t)(out + 1u);
    }
}

/* ---- answers --------------------------------------------------------------------------------------------------------- */

static void answer_isr(void) IN_ISR
{
    fdl_counters.answers++;
    phy_answer_isr(fdl_tx.at, fdl_tx.len);
}

void phy_cancelled_ind_isr(void) IN_ISR
{
    fdl_counters.cancelled++;
}

static void refuse_isr(uint8_t function) IN_ISR
{
    fdl_counters.refused++;
    fdl_tx_fixed_isr(function);
}

/* ---- retries --------------------------------------------------------------------------------------------------------- */

static bool same_as_last_isr(uint8_t len) IN_ISR
{
    const uint8_t XDATA *body = fdl_rx_buf + FDL_BODY;
    uint8_t i;

    if (!last.valid || len != last.len || fdl_req.sa != (last.header[SA] & 0x7Fu))
        return false;
    if (phy_rx.at[-2] != last.fcs)
        return false;
    for (i = 0; i < sizeof last.header && i < len; i++)
        if (body[i] != last.header[i])
            return false;
    return true;
}

static void remember_isr(uint8_t len) IN_ISR
{
    const uint8_t XDATA *body = fdl_rx_buf + FDL_BODY;
    uint8_t i;

    last.valid = true;
    last.len = len;
    last.fcs = phy_rx.at[-2];
    for (i = 0; i < sizeof last.header; i++)
        last.header[i] = body[i];
}

/* Keep the answer just built for a retry. */
static void keep_answer_isr(struct fdl_reply XDATA *reply) IN_ISR
{
    last.answer = fdl_tx.at;
    last.answer_len = fdl_tx.len;
    last.reply = reply;
    if (reply)
        last.turns = reply->turns;
}

/* The answer given before; where its room has been given up since (Freeze takes newer inputs), a newer one. */
static void answer_again_isr(void) IN_ISR
{
    if (last.reply && last.reply->turns != last.turns) {
        fdl_tx_reply_isr(last.reply);
        keep_answer_isr(last.reply);
    }
    fdl_tx.at = last.answer;
    fdl_tx.len = last.answer_len;
    answer_isr();
}

/* True: a retry, answered again. Otherwise the FCB is stored: FCV = 0 with FCB = 1 starts the sequence, FCV = 1 goes on
 * with it; FCV = 0 with FCB = 0 is not numbered and starts a sequence of nobody's. */
static bool repeated_isr(uint8_t len) IN_ISR
{
    uint8_t fc = fdl_rx_buf[FDL_BODY + FC];

    if ((fc & FDL_FC_FCV) && same_as_last_isr(len)) {
        fdl_counters.retries++;
        answer_again_isr();
        return true;
    }
    remember_isr(len);
    return false;
}

/* ---- services -------------------------------------------------------------------------------------------------------- */

/* The SAP's decision -> FDL_OK or the refusal. */
static uint8_t indicate_isr(struct fdl_sap XDATA *row, bool whole) IN_ISR
{
    if (!row || !(row->services & fdl_req.service))
        return FDL_RS;
    if (row->access != FDL_ALL && row->access != fdl_req.sa)
        return FDL_RS;
    if (!whole || fdl_req.len > row->max_len)
        return FDL_RR; /* our choice: the L_sdu is longer than the resource activated for it */
    fdl_req.reply = row->reply;
    switch (row->handling) {
    case FDL_TO_ISR:
        return fdl_ind_isr();
    case FDL_TO_MAIN:
        return box_isr();
    default:
        return FDL_OK;
    }
}

static void sdn_isr(bool whole) IN_ISR
{
    fdl_req.service = FDL_SDN;
    indicate_isr(fdl_sap_row_isr(fdl_req.dsap), whole);
}

/* SDA and SRD. */
static void acknowledged_isr(uint8_t service, uint8_t len, bool whole) IN_ISR
{
    uint8_t result;

    if (repeated_isr(len))
        return;
    fdl_req.service = service;
    result = indicate_isr(fdl_sap_row_isr(fdl_req.dsap), whole);
    if (result != FDL_OK || service != FDL_SRD)
        fdl_req.reply = 0;
    if (result != FDL_OK)
        refuse_isr(result);
    else if (fdl_req.reply)
        fdl_tx_reply_isr(fdl_req.reply);
    else
        fdl_tx_short_isr();
    keep_answer_isr(fdl_req.reply);
    answer_isr();
}

/* FDL status, Ident and LSAP status: not numbered, they leave the FCB alone. */
static void status_isr(uint8_t function) IN_ISR
{
    struct fdl_reply XDATA *reply = 0;

    if (function == FDL_IDENT)
        reply = fdl_ident_reply_isr();
    else if (function == FDL_LSAP_STATUS)
        reply = fdl_lsap_reply_isr();
    if (reply) {
        fdl_tx_reply_isr(reply);
    } else if (function == FDL_STATUS) {
        fdl_tx_status_isr(FDL_OK);
    } else {
        fdl_counters.refused++;
        fdl_tx_status_isr(FDL_RS);
    }
    answer_isr();
}

/* ---- telegram -------------------------------------------------------------------------------------------------------- */

/* Address extension octets into fdl_req; false where they are none of ours. */
static bool parse_saps_isr(uint8_t len) IN_ISR
{
    const uint8_t XDATA *body = fdl_rx_buf + FDL_BODY;
    uint8_t at = 3;

    fdl_req.dsap = FDL_SAP_NIL;
    fdl_req.ssap = FDL_SAP_NIL;
    if (body[DA] & FDL_ADDRESS_EXT) {
        if (at >= len || (body[at] & EXT_UNKNOWN))
            return false;
        fdl_req.dsap = body[at++];
    }
    if (body[SA] & FDL_ADDRESS_EXT) {
        if (at >= len || (body[at] & EXT_UNKNOWN))
            return false;
        fdl_req.ssap = body[at++];
    }
    fdl_req.lsdu = fdl_rx_buf + FDL_BODY + at;
    fdl_req.len = (uint8_t)(len - at);
    return true;
}

/* Functions other than these are unknown to a responder and get no answer (our choice: 7, MSRD, and the clock functions
 * belong to DP-V2). */
static void request_isr(uint8_t function, uint8_t len, bool whole) IN_ISR
{
    switch (function) {
    case FDL_SDN_LOW:
    case FDL_SDN_HIGH:
        fdl_req.high = function == FDL_SDN_HIGH;
        sdn_isr(whole);
        break;
    case FDL_SDA_LOW:
    case FDL_SDA_HIGH:
        fdl_req.high = function == FDL_SDA_HIGH;
        acknowledged_isr(FDL_SDA, len, whole);
        break;
    case FDL_SRD_LOW:
    case FDL_SRD_HIGH:
        fdl_req.high = function == FDL_SRD_HIGH;
        acknowledged_isr(FDL_SRD, len, whole);
        break;
    case FDL_STATUS:
    case FDL_IDENT:
    case FDL_LSAP_STATUS:
        status_isr(function);
        break;
    default:
        fdl_counters.format++;
        break;
    }
}

static void own_request_isr(uint8_t len, bool whole) IN_ISR
{
    const uint8_t XDATA *body = fdl_rx_buf + FDL_BODY;
    bool broadcast = (body[DA] & 0x7Fu) == FDL_BROADCAST;
    uint8_t function = body[FC] & FDL_FC_FUNCTION;
    bool sdn = function == FDL_SDN_LOW || function == FDL_SDN_HIGH;

    fdl_req.sa = body[SA] & 0x7Fu;
    fdl_req.sd3 = fdl_rx_buf[0] == FDL_SD3;
    if ((body[FC] & FDL_FC_RESERVED) || fdl_req.sa == FDL_BROADCAST || (broadcast && !sdn) || !parse_saps_isr(len)) {
        fdl_counters.format++;
        return;
    }
    fdl_counters.requests++;
    if (!broadcast)
        heard |= fdl_req.sa == watched ? FDL_HEARD_OWN | FDL_HEARD_OWNER : FDL_HEARD_OWN;
    request_isr(function, len, whole);
}

void fdl_telegram_isr(uint8_t len, bool whole) IN_ISR
{
    const uint8_t XDATA *body = fdl_rx_buf + FDL_BODY;
    uint8_t da = body[DA] & 0x7Fu;

    heard |= FDL_HEARD_ANY;
    if ((da == fdl_ts || da == FDL_BROADCAST) && (body[FC] & FDL_FC_REQUEST))
        own_request_isr(len, whole);
    else
        fdl_counters.foreign++;
}

void fdl_other_isr(void) IN_ISR
{
    fdl_counters.foreign++;
}

/* ---- main loop ------------------------------------------------------------------------------------------------------- */

uint8_t fdl_heard(void)
{
    uint8_t irq = hal_irq_save();
    uint8_t was = heard;

    heard = 0;
    hal_irq_restore(irq);
    return was;
}

void fdl_watch(uint8_t station)
{
    watched = station;
}

void fdl_read_counters(struct fdl_counters XDATA *to)
{
    uint8_t irq = hal_irq_save();

    *to = fdl_counters;
    hal_irq_restore(irq);
}

void fdl_set_address(uint8_t ts)
{
    uint8_t irq = hal_irq_save();

    fdl_ts = ts;
    last.valid = false;
    hal_irq_restore(irq);
}

void fdl_reset(uint8_t ts)
{
    static const CODE struct fdl_counters none = {0}; /* "= {0}": SDCC leaves it to the EPROM otherwise */
    uint8_t irq = hal_irq_save();
    uint8_t i;

    fdl_counters = none;
    in_stock = 0;
    for (i = 1; i < BUFFERS; i++)
        stock[in_stock++] = memory[i];
    fdl_rx_buf = memory[0];
    box_in = 0;
    box_out = 0;
    heard = 0;
    watched = FDL_ALL;
    fdl_ts = ts;
    last.valid = false;
    fdl_rx_reset();
    fdl_sap_reset();
    hal_irq_restore(irq);
}
