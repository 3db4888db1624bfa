/* The responder: who is meant, is it a retry, which SAP, what answer.
 *
 * Source   EN 50170-2 part 4: addresses 4.7.3, FC and FCB 4.7.4, 4.1.3; spec A3, A4; facts section 0 for the retry rule
 */
#include "fdl/fdl_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

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
static uint8_t watched;

static uint8_t XDATA memory[BUFFERS][FDL_BUF_LEN];
static uint8_t XDATA *XDATA stock[BUFFERS]; /* free buffers: stock[0..in_stock-1] */
static uint8_t in_stock;

/* Single producer (interrupt: box_in), single consumer (main loop: box_out); a box belongs to the main loop from the
 * moment box_in has passed it until box_out has. One octet each, so neither side can see half an index. */
static struct box XDATA boxes[FDL_BOXES + 1u];
static volatile IDATA uint8_t box_in;
static volatile IDATA uint8_t box_out;

/* The request being received. */
static HOT uint8_t own;   /* not 0: a request to this station or to all            */
static HOT uint8_t unfit; /* not 0: header or SAPs that no request to us can have   */
static HOT uint8_t to;    /* DA without its extension bit                           */
static HOT uint8_t kind;  /* KIND_*, FDL_SDA, FDL_SDN, FDL_SRD; 0: no such          */

static HOT bool skip; /* telegrams of others are of no interest */

/* Functions other than these are unknown to a responder and get no answer (our choice: 7, MSRD, and the clock
 * functions belong to DP-V2). */
#define KIND_STATUS 0x40u
#define KIND_HIGH   0x80u
static const CODE uint8_t kinds[FDL_FC_FUNCTION + 1u] = {
    [FDL_SDA_LOW] = FDL_SDA,    [FDL_SDA_HIGH] = FDL_SDA | KIND_HIGH,
    [FDL_SDN_LOW] = FDL_SDN,    [FDL_SDN_HIGH] = FDL_SDN | KIND_HIGH,
    [FDL_SRD_LOW] = FDL_SRD,    [FDL_SRD_HIGH] = FDL_SRD | KIND_HIGH,
    [FDL_STATUS] = KIND_STATUS, [FDL_IDENT] = KIND_STATUS,            [FDL_LSAP_STATUS] = KIND_STATUS,
};

/* The last numbered request and its answer. A frame is a retry only if it is the same frame: FCV, same SA, same
 * FCB and octet-identical, for which length, header, the two octets behind it (SAPs) and FCS are compared. Masters
 * that forget to restart the FCB after a lost answer would otherwise be answered with stale data for ever (facts,
 * section 0). */
static struct {
    uint8_t len; /* 0: none */
    uint8_t da;
    uint8_t sa;
    uint8_t fc;
    uint8_t more[2];
    uint8_t fcs;
    const uint8_t XDATA *answer;
    uint8_t answer_len;
    struct fdl_reply PAGED *reply; /* the answer stands in its room; 0 = elsewhere */
    uint8_t turns;                 /* of reply, when the answer was built          */
} IDATA last;

/* ---- buffers --------------------------------------------------------------------------------------------- */

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

static uint8_t update_status_isr(void) IN_ISR
{
    if (!fdl_req.reply || !fdl_req.reply->valid)
        return FDL_UPDATED_NO;
    return (uint8_t)(FDL_UPDATED_LO + fdl_req.reply->high);
}

/* Into a box for the main loop -> FDL_OK, or FDL_RR when all are taken. */
static uint8_t box_isr(void) IN_ISR
{
    uint8_t next = next_box_isr(box_in);
    struct box XDATA *box = &boxes[box_in];

    if (next == box_out)
        return FDL_RR;
    box->ind.service = fdl_req.service;
    box->ind.high = (kinds[fdl_header.fc & FDL_FC_FUNCTION] & KIND_HIGH) != 0;
    box->ind.dsap = fdl_req.dsap;
    box->ind.ssap = fdl_req.ssap;
    box->ind.sa = fdl_req.sa;
    box->ind.update = update_status_isr();
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

/* ---- answers --------------------------------------------------------------------------------------------- */

static void answer_isr(void) IN_ISR
{
    fdl_counters.answers++;
    phy_answer_isr(fdl_tx.at, fdl_tx.len);
}

void phy_cancelled_ind_isr(void) IN_ISR
{
    fdl_count_isr(&fdl_counters.cancelled);
}

static void refuse_isr(uint8_t function) IN_ISR
{
    fdl_count_isr(&fdl_counters.refused);
    fdl_tx_fixed_isr(function);
}

/* ---- retries --------------------------------------------------------------------------------------------- */

static bool same_as_last_isr(void) IN_ISR
{
    return fdl_header.fc == last.fc && fdl_header.fcs == last.fcs && fdl_header.len == last.len &&
           fdl_header.da == last.da && fdl_header.sa == last.sa && fdl_header.more[0] == last.more[0] &&
           fdl_header.more[1] == last.more[1];
}

static void remember_isr(void) IN_ISR
{
    last.len = fdl_header.len;
    last.da = fdl_header.da;
    last.sa = fdl_header.sa;
    last.fc = fdl_header.fc;
    last.fcs = fdl_header.fcs;
    last.more[0] = fdl_header.more[0];
    last.more[1] = fdl_header.more[1];
}

/* Keep the answer just built for a retry. */
static void keep_answer_isr(struct fdl_reply PAGED *reply) IN_ISR
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

/* True: a retry, answered again. Otherwise the FCB is stored: FCV = 0 with FCB = 1 starts the sequence, FCV = 1
 * goes on with it; FCV = 0 with FCB = 0 is not numbered and starts a sequence of nobody's. */
static bool repeated_isr(void) IN_ISR
{
    if ((fdl_header.fc & FDL_FC_FCV) && same_as_last_isr()) {
        fdl_count_isr(&fdl_counters.retries);
        answer_again_isr();
        return true;
    }
    remember_isr();
    return false;
}

/* ---- services -------------------------------------------------------------------------------------------- */

static struct fdl_sap PAGED *HOT row; /* of the request's SAP */

/* The SAP's decision -> FDL_OK or the refusal. */
static uint8_t indicate_isr(void) IN_ISR
{
    row = fdl_sap_row_isr(fdl_req.dsap);
    if (!row || !(row->services & kind))
        return FDL_RS;
    if (row->access != FDL_ALL && row->access != fdl_req.sa)
        return FDL_RS;
    if (!fdl_header.whole || fdl_req.len > row->max_len)
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

/* SDA and SRD. */
static void acknowledged_isr(void) IN_ISR
{
    uint8_t result;

    if (repeated_isr())
        return;
    result = indicate_isr();
    if (result != FDL_OK || kind != FDL_SRD)
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
    struct fdl_reply PAGED *reply = 0;

    if (function == FDL_IDENT)
        reply = fdl_ident_reply_isr();
    else if (function == FDL_LSAP_STATUS)
        reply = fdl_lsap_reply_isr();
    if (reply) {
        fdl_tx_reply_isr(reply);
    } else if (function == FDL_STATUS) {
        fdl_tx_status_isr(FDL_OK);
    } else {
        fdl_count_isr(&fdl_counters.refused);
        fdl_tx_status_isr(FDL_RS);
    }
    answer_isr();
}

/* ---- telegram -------------------------------------------------------------------------------------------- */

bool fdl_header_isr(void) IN_ISR
{
    own = 0;
    to = fdl_header.da & 0x7Fu;
    if (to != fdl_ts && to != FDL_BROADCAST)
        return !skip;
    own = fdl_header.fc & FDL_FC_REQUEST;
    return true;
}

/* Body: DA SA FC [DAE] [SAE] L_sdu */
void fdl_saps_isr(void) IN_ISR
{
    if (!own)
        return;
    fdl_req.lsdu = fdl_rx_buf + (FDL_BODY + 3u);
    fdl_header.more[0] = fdl_req.lsdu[0];
    fdl_header.more[1] = fdl_req.lsdu[1];
    fdl_req.len = (uint8_t)(fdl_header.len - 3u);
    fdl_req.dsap = FDL_SAP_NIL;
    fdl_req.ssap = FDL_SAP_NIL;
    unfit = 0;
    if (fdl_header.da & FDL_ADDRESS_EXT) {
        fdl_req.dsap = fdl_header.more[0];
        unfit = fdl_req.dsap;
        fdl_req.lsdu++;
        fdl_req.len--;
    }
    if (fdl_header.sa & FDL_ADDRESS_EXT) {
        fdl_req.ssap = fdl_header.da & FDL_ADDRESS_EXT ? fdl_header.more[1] : fdl_header.more[0];
        unfit |= fdl_req.ssap;
        fdl_req.lsdu++;
        fdl_req.len--;
    }
    unfit &= EXT_UNKNOWN;
}

static void check_header_isr(void) IN_ISR
{
    kind = kinds[fdl_header.fc & FDL_FC_FUNCTION] & (uint8_t)~KIND_HIGH;
    fdl_req.service = kind;
    fdl_req.sd3 = fdl_header.sd3;
    fdl_req.sa = fdl_header.sa & 0x7Fu;
    unfit |= fdl_header.fc & FDL_FC_RESERVED;
    if (fdl_req.sa == FDL_BROADCAST)
        unfit = 1;
    if (to == FDL_BROADCAST && kind != FDL_SDN)
        unfit = 1;
    if (fdl_req.len > FDL_LE_MAX) /* below 0: the SAPs are not there */
        unfit = 1;
}

void fdl_telegram_isr(void) IN_ISR
{
    heard |= FDL_HEARD_ANY;
    if (!own) {
        fdl_count_isr(&fdl_counters.foreign);
        return;
    }
    check_header_isr();
    if (unfit) {
        fdl_count_isr(&fdl_counters.format);
        return;
    }
    fdl_counters.requests++;
    if (to != FDL_BROADCAST)
        heard |= fdl_req.sa == watched ? FDL_HEARD_OWN | FDL_HEARD_OWNER : FDL_HEARD_OWN;
    if (kind == FDL_SRD || kind == FDL_SDA)
        acknowledged_isr();
    else if (kind == FDL_SDN)
        indicate_isr();
    else if (kind == KIND_STATUS)
        status_isr(fdl_header.fc & FDL_FC_FUNCTION);
    else
        fdl_count_isr(&fdl_counters.format);
}

void fdl_other_isr(void) IN_ISR
{
    fdl_count_isr(&fdl_counters.foreign);
}

/* ---- main loop ------------------------------------------------------------------------------------------- */

uint8_t fdl_heard(void)
{
    uint8_t irq = hal_irq_save();
    uint8_t was = heard;

    heard = 0;
    hal_irq_restore(irq);
    return was;
}

void fdl_listen(bool all)
{
    skip = !all;
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
    last.len = 0;
    hal_irq_restore(irq);
}

void fdl_reset(uint8_t ts)
{
    uint8_t irq = hal_irq_save();
    uint8_t i;

    for (i = 0; i < sizeof fdl_counters; i++) /* SDCC's struct assignment and memset() are a library of their own */
        ((uint8_t XDATA *)&fdl_counters)[i] = 0;
    in_stock = 0;
    for (i = 1; i < BUFFERS; i++)
        stock[in_stock++] = memory[i];
    fdl_rx_buf = memory[0];
    box_in = 0;
    box_out = 0;
    heard = 0;
    watched = FDL_ALL;
    skip = false;
    fdl_ts = ts;
    last.len = 0;
    fdl_rx_reset();
    fdl_sap_reset();
    hal_irq_restore(irq);
}
