/* The responder: the end of a good telegram, retries, what follows the answer; boxes and buffers.
 *
 * A request is answered first and booked afterwards: executed, counted, remembered. That is done when PHY says that the
 * answer is out or will not go out. Invariant: until then the receiver is deaf, so the request stands unchanged in
 * fdl_header, fdl_req, fdl_plan and fdl_rx_buf. (A line that cannot show silence has no such time: booked at once.)
 * Source   EN 50170-2 part 4: FC and FCB 4.7.4, 4.1.3; spec A3, A4; facts section 0 for the retry rule
 */
#include "fdl/fdl_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

#define BUFFERS (1u + FDL_BOXES + FDL_KEPT_MAX + 1u) /* receiver, boxes, kept ones, one in exchange */

struct box {
    struct fdl_ind ind;
    uint8_t XDATA *buffer;
};

struct fdl_counters XDATA fdl_counters;
IDATA struct fdl_last fdl_last;

static volatile HOT uint8_t heard;

static uint8_t XDATA memory[BUFFERS][FDL_BUF_LEN];
static uint8_t XDATA *XDATA stock[BUFFERS]; /* free buffers: stock[0..in_stock-1] */
static IDATA uint8_t in_stock;

/* Single producer (interrupt: fdl_box_in), single consumer (main loop: fdl_box_out); a box belongs to the main loop from the
 * moment fdl_box_in has passed it until fdl_box_out has. One octet each, so neither side can see half an index. */
static struct box XDATA boxes[FDL_BOXES + 1u];
volatile HOT uint8_t fdl_box_in;
volatile HOT uint8_t fdl_box_out;

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
    if (!(fdl_plan.is & FDL_VALID))
        return FDL_UPDATED_NO;
    return fdl_plan.is & FDL_HIGH ? FDL_UPDATED_HI : FDL_UPDATED_LO;
}

bool fdl_box_is_free_isr(void) IN_ISR
{
    return next_box_isr(fdl_box_in) != fdl_box_out;
}

/* Into a box for the main loop; there is one. */
static void box_isr(void) IN_ISR
{
    struct box XDATA *box = &boxes[fdl_box_in];

    box->ind.service = fdl_req.service;
    box->ind.high = (fdl_functions[fdl_header.fc & FDL_FC_FUNCTION] & FDL_IS_HIGH) != 0;
    box->ind.dsap = fdl_req.dsap;
    box->ind.ssap = fdl_req.ssap;
    box->ind.sa = fdl_req.sa;
    box->ind.update = update_status_isr();
    box->ind.len = fdl_req.len;
    box->ind.lsdu = fdl_req.lsdu;
    box->buffer = fdl_keep_isr(0);
    fdl_box_in = next_box_isr(fdl_box_in);
}

bool fdl_waiting_isr(uint8_t dsap) IN_ISR
{
    uint8_t i;
    const struct fdl_ind XDATA *ind;

    for (i = fdl_box_out; i != fdl_box_in; i = next_box_isr(i)) {
        ind = &boxes[i].ind;
        if (ind->dsap >= dsap && ind->sa == fdl_req.sa)
            return true;
    }
    return false;
}

void fdl_poll(void)
{
    const uint8_t in = fdl_box_in; /* what comes meanwhile waits for the next turn */
    struct box XDATA *box;
    uint8_t irq;

    while (fdl_box_out != in) {
        box = &boxes[fdl_box_out];
        fdl_data_ind(&box->ind);
        fdl_give_back(box->buffer);
        irq = hal_irq_save();
        fdl_box_out = fdl_box_out == FDL_BOXES ? 0u : (uint8_t)(fdl_box_out + 1u);
        fdl_resettle_isr();
        hal_irq_restore(irq);
    }
}

/* ---- booking --------------------------------------------------------------------------------------------- */

static void remember_isr(void) IN_ISR
{
    fdl_last.len = fdl_header.len;
    fdl_last.da = fdl_header.da;
    fdl_last.sa = fdl_header.sa;
    fdl_last.fc = fdl_header.fc;
    fdl_last.fcs = fdl_header.fcs;
    fdl_last.more[0] = fdl_rx_buf[FDL_BODY + 3u];
    fdl_last.more[1] = fdl_rx_buf[FDL_BODY + 4u];
    fdl_last.answer = phy_tx.at;
    fdl_last.answer_len = phy_tx.len;
    fdl_last.reply = fdl_req.reply;
    fdl_tx_keep_isr();
}

static void execute_isr(void) IN_ISR
{
    fdl_req.lsdu = fdl_rx_buf + FDL_BODY + (uint8_t)(fdl_header.len - fdl_req.len);
    if (fdl_plan.handling == FDL_TO_ISR)
        fdl_ind_isr();
    else if (fdl_plan.handling == FDL_TO_MAIN)
        box_isr();
}

/* Once for each telegram. */
static void book_isr(void) IN_ISR
{
    fdl_plan.stage = FDL_IDLE;
    fdl_plan.awaited = 0;
    fdl_turn_sent_isr();
    fdl_count_isr(&fdl_counters.requests);
    if (phy_tx.len)
        fdl_count_isr(&fdl_counters.answers);
    if (fdl_plan.again) {
        fdl_count_isr(&fdl_counters.retries);
        return;
    }
    if (fdl_plan.refusal)
        fdl_count_isr(&fdl_counters.refused);
    if (fdl_req.service & (FDL_SRD | FDL_SDA))
        remember_isr();
    execute_isr();
}

void phy_done_ind_isr(bool sent) IN_ISR
{
    if (!sent)
        fdl_count_isr(&fdl_counters.cancelled);
    if (fdl_plan.stage == FDL_TO_BOOK)
        book_isr();
    if (sent)
        fdl_answered_isr();
}

/* The line was opened anew under the answer: the master will ask again, and that is then a new request. */
void fdl_drop_isr(void) IN_ISR
{
    if (fdl_plan.stage == FDL_TO_BOOK) {
        fdl_plan.stage = FDL_IDLE;
        fdl_plan.awaited = 0;
        fdl_turn_sent_isr();
        fdl_last.len = 0;
    }
}

/* ---- the end of a telegram ------------------------------------------------------------------------------- */

/* FC is that of the request answered last: is it the same telegram? Those whose header is alike differ in FCS most of the
 * time. */
static void compare_isr(void) IN_ISR
{
    if (fdl_header.fcs != fdl_last.fcs || fdl_header.len != fdl_last.len || fdl_header.da != fdl_last.da ||
        fdl_header.sa != fdl_last.sa || fdl_rx_buf[FDL_BODY + 3u] != fdl_last.more[0] ||
        fdl_rx_buf[FDL_BODY + 4u] != fdl_last.more[1])
        fdl_plan.again = false;
}

/* As planned: the room that is sent now is kept until the next answer. (It is turned afterwards: the other station
 * waits.) */
static void take_reply_isr(void) IN_ISR
{
    struct fdl_reply PAGED *reply = fdl_req.reply;

    fdl_plan.turn = fdl_plan.is & FDL_FRESH;
    if (fdl_plan.is & FDL_SINGLE)
        reply->is &= (uint8_t)~FDL_VALID;
    if (fdl_plan.late)
        fdl_tx_frame_isr(reply->sent);
}

/* The answer given before; where its room has been given up since (Freeze takes newer inputs), the one planned. */
static void again_isr(void) IN_ISR
{
    if (fdl_last.answer_len == 0) {
        take_reply_isr();
        fdl_last.answer = phy_tx.at;
        fdl_last.answer_len = phy_tx.len;
    }
    phy_tx.at = fdl_last.answer;
    phy_tx.len = fdl_last.answer_len;
}

void fdl_telegram_isr(void) IN_ISR
{
    if (fdl_plan.stage != FDL_PLANNED) {
        heard |= FDL_HEARD_ANY;
        fdl_count_isr(fdl_plan.stage == FDL_OTHERS ? &fdl_counters.foreign : &fdl_counters.format);
        return;
    }
    if (fdl_plan.stale)
        fdl_refresh_isr();
    heard |= fdl_plan.hears;
    fdl_plan.stage = FDL_TO_BOOK;
    if (fdl_plan.again)
        compare_isr();
    if (fdl_plan.again)
        again_isr();
    else if (fdl_plan.is)
        take_reply_isr();
    if (phy_tx.len) {
        phy_answer_isr();
        if (!phy_rx.untimed)
            return;
    }
    if (fdl_plan.stage == FDL_TO_BOOK)
        book_isr();
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
    fdl_skips_others = !all;
}

void fdl_watch(uint8_t station)
{
    uint8_t irq = hal_irq_save();

    fdl_watched = station;
    fdl_unplan_isr();
    hal_irq_restore(irq);
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
    fdl_last.len = 0;
    fdl_unplan_isr();
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
    fdl_box_in = 0;
    fdl_box_out = 0;
    heard = 0;
    fdl_watched = FDL_ALL;
    fdl_skips_others = false;
    fdl_ts = ts;
    fdl_last.len = 0;
    fdl_plan.stage = FDL_IDLE;
    fdl_plan.turn = 0;
    fdl_plan.stale = false;
    fdl_unplan_isr();
    fdl_rx_reset();
    fdl_sap_reset();
    hal_irq_restore(irq);
}
