/* FDL telegram receiver: chunks of octets in, one whole checked telegram out.
 *
 * Layer    phy_uart -> [fdl_rx] -> fdl; implements phy_chunk_ind_isr, phy_syn_ind_isr, phy_fault_ind_isr
 * Context  everything here runs in the UART or timer interrupt
 * Source   telegram formats: EN 50170-2 part 4, 4.7.1; FCS 4.7.1.5; T_SYN before a request 4.1.7
 */
#include "fdl/fdl_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

/* What is awaited next. */
enum rx_state {
    RX_SYN,      /* T_SYN of silence: the receiver is deaf. Out of step, only that resynchronises */
    RX_ALONE,    /* a start delimiter, on a line that cannot show silence     */
    RX_SD,       /* the octet behind a start delimiter that is not SD2        */
    RX_SD2_HEAD, /* LE LEr SD2                                                */
    RX_DA,       /* DA of an SD2                                              */
    RX_HEADER,   /* SA FC of a telegram for us or for all; FCS ED of an SD1   */
    RX_SAPS,     /* DAE SAE                                                   */
    RX_TOKEN,    /* SA of a token                                             */
    RX_PIECE,    /* a piece of a telegram that is longer than the buffer      */
    RX_BODY,     /* the rest, up to ED                                        */
    RX_ANY,      /* an SD2 up to DA, or a start delimiter and the octet behind it                */
    RX_FIRST,    /* all of the telegram that is awaited, unless it is another: then up to LEr SD2 */
};

uint8_t XDATA *HOT fdl_rx_buf;
HOT struct fdl_header fdl_header;

static HOT uint8_t state;
static IDATA uint8_t good_sd; /* the last SD was one: counted at the end of the telegram, which is answered first */
static IDATA uint8_t missing; /* octets of body, FCS and ED to come */

STATIC_ASSERT(PHY_HEAD == FDL_BODY, the_head_is_sd2_le_ler_sd2);
#define HEADER_LEN   3u /* DA SA FC       */
#define KEPT_LEN     5u /* DA SA FC and two more: kept even of a telegram that is too long */
#define TAIL_LEN     2u /* FCS ED         */
#define ONLY_SAPS    (KEPT_LEN - HEADER_LEN + TAIL_LEN) /* no data behind them: they come with FCS and ED */

/* A function, because SDCC makes 17 octets of code of each increment. */
void fdl_count_isr(uint16_t XDATA *count) IN_ISR
{
    (*count)++;
}

void fdl_rx_reset(void)
{
    good_sd = false;
    state = RX_SYN;
}

/* The telegram awaited, as a whole; of any other one its head, or two octets: at 187.5 kbit/s an 8-bit part has no time to
 * look at each. Only the short acknowledge is shorter, and is known by the silence behind it; where none can be seen, one
 * octet must do. */
static uint8_t wait_sd_isr(void) IN_ISR
{
    if (good_sd)
        fdl_count_isr(&fdl_counters.sd_count);
    good_sd = false;
    phy_rx.at = fdl_rx_buf;
    phy_rx.model = PHY_MODEL_END;
    if (phy_rx.untimed) {
        phy_rx.left = 1;
        return RX_ALONE;
    }
    if (fdl_await_isr()) {
        phy_rx.model = PHY_MODEL_END - fdl_plan.awaited;
        phy_rx.less = (uint8_t)(fdl_header.len + TAIL_LEN);
        phy_rx.left = (uint8_t)(fdl_header.len + TAIL_LEN + PHY_HEAD);
        phy_rx.sum = (uint8_t)(0u - 2u * FDL_SD2 - 2u * fdl_header.len); /* from DA on */
        return RX_FIRST;
    }
    phy_model[PHY_MODEL - 1u] = FDL_SD2;
    phy_rx.model = PHY_MODEL_END - 1;
    phy_rx.less = 1;
    phy_rx.left = PHY_HEAD + 1u;
    return RX_ANY;
}

/* A telegram has ended, good or foreign. */
static uint8_t telegram_end_isr(void) IN_ISR
{
    return phy_rx.untimed ? wait_sd_isr() : RX_SYN;
}

/* The rest, in pieces where it is longer than the buffer: what is kept stays, what follows it is overwritten by the
 * next piece (the telegram will be refused; its FCS is still checked). */
static uint8_t want_rest_isr(uint8_t room) IN_ISR
{
    if (missing <= room) {
        phy_rx.left = missing;
        return RX_BODY;
    }
    phy_rx.left = (uint8_t)(room - TAIL_LEN);
    missing = (uint8_t)(missing - phy_rx.left);
    return RX_PIECE;
}

#define ROOM_BEHIND(octets) ((uint8_t)(FDL_BUF_LEN - FDL_BODY - (octets)))

/* DA is there. It is looked at now, while an 8-bit part waits for SA and FC: what follows them costs it T_SDR. */
static uint8_t da_isr(void) IN_ISR
{
    const uint8_t da = fdl_rx_buf[FDL_BODY];
    const uint8_t to = da & 0x7Fu;

    if (to == fdl_ts || to == FDL_BROADCAST) {
        fdl_da_isr(da);
        missing = (uint8_t)(fdl_header.len - HEADER_LEN + TAIL_LEN);
        phy_rx.left = fdl_header.len == HEADER_LEN ? HEADER_LEN - 1u + TAIL_LEN : HEADER_LEN - 1u;
        return RX_HEADER;
    }
    if (fdl_skips_others && !phy_rx.untimed) {
        fdl_other_isr();
        return RX_SYN;
    }
    missing = (uint8_t)(fdl_header.len - 1u + TAIL_LEN);
    return want_rest_isr(ROOM_BEHIND(1u));
}

static uint8_t st_da_isr(void) IN_ISR
{
    phy_rx.sum = fdl_rx_buf[FDL_BODY];
    return da_isr();
}

static uint8_t bad_sd_isr(void) IN_ISR
{
    good_sd = false;
    fdl_count_isr(&fdl_counters.sd_error_count);
    return RX_SYN;
}

/* Of an SD1 or SD3 DA is there, too. */
static uint8_t st_sd13_isr(uint8_t len) IN_ISR
{
    fdl_header.len = len;
    return st_da_isr();
}

static uint8_t st_sd_isr(void) IN_ISR
{
    uint8_t sd = fdl_rx_buf[0];

    good_sd = true;
    fdl_req.sd3 = 0;
    if (sd == FDL_SD1)
        return st_sd13_isr(HEADER_LEN);
    if (sd == FDL_SD3) {
        fdl_req.sd3 = FDL_AS_SD3;
        fdl_plan.made = 0;
        return st_sd13_isr(HEADER_LEN + FDL_SD3_DU);
    }
    if (sd == FDL_SD4) {
        phy_rx.left = 1;
        return RX_TOKEN;
    }
    if (sd == FDL_SC) {
        fdl_other_isr();
        return telegram_end_isr();
    }
    return bad_sd_isr();
}

/* All but the short acknowledge have an octet more. */
static uint8_t st_alone_isr(void) IN_ISR
{
    fdl_plan.stage = FDL_OTHERS;
    if (fdl_rx_buf[0] == FDL_SC)
        return st_sd_isr();
    if (fdl_rx_buf[0] == FDL_SD2) {
        phy_rx.left = PHY_HEAD - 1u;
        return RX_SD2_HEAD;
    }
    phy_rx.at = fdl_rx_buf + FDL_BODY;
    phy_rx.left = 1;
    return RX_SD;
}

static uint8_t st_sd2_head_isr(void) IN_ISR
{
    const uint8_t XDATA *at = fdl_rx_buf + 1;
    const uint8_t len = *at++;

    good_sd = true;
    fdl_req.sd3 = 0;
    fdl_header.len = len;
    if (len >= FDL_LE_MIN && len <= FDL_LE_MAX && *at++ == len && *at == FDL_SD2) {
        phy_rx.left = 1;
        return RX_DA;
    }
    fdl_count_isr(&fdl_counters.format);
    return RX_SYN;
}

static uint8_t st_piece_isr(void) IN_ISR
{
    phy_rx.at = fdl_rx_buf + FDL_BODY + KEPT_LEN;
    return want_rest_isr(ROOM_BEHIND(KEPT_LEN));
}

/* The sum of the body is FCS: with FCS and ED counted in, the whole is twice FCS and ED. */
static uint8_t st_body_isr(void) IN_ISR
{
    const uint8_t XDATA *tail = phy_rx.at - TAIL_LEN;

    fdl_header.fcs = *tail++;
    if (*tail != FDL_ED) {
        fdl_count_isr(&fdl_counters.format);
        return RX_SYN;
    }
    if ((uint8_t)(fdl_header.fcs + fdl_header.fcs + FDL_ED) != phy_rx.sum) {
        fdl_count_isr(&fdl_counters.checksum);
        return RX_SYN;
    }
    fdl_telegram_isr();
    return telegram_end_isr();
}

/* Where they are all that was missing, FCS and ED have come with SA and FC. */
static uint8_t st_header_isr(void) IN_ISR
{
    if (fdl_header_isr()) {
        phy_rx.left = missing <= ONLY_SAPS ? missing : KEPT_LEN - HEADER_LEN;
        return RX_SAPS;
    }
    if (fdl_header.len == HEADER_LEN)
        return st_body_isr();
    return want_rest_isr(ROOM_BEHIND(HEADER_LEN));
}

static uint8_t st_saps_isr(void) IN_ISR
{
    fdl_saps_isr();
    if (missing <= ONLY_SAPS)
        return st_body_isr();
    missing = (uint8_t)(missing - (KEPT_LEN - HEADER_LEN));
    return want_rest_isr(ROOM_BEHIND(KEPT_LEN));
}

/* The header awaited, and other SAPs: `there` of them have come. */
static uint8_t st_other_saps_isr(uint8_t there) IN_ISR
{
    phy_rx.left = (uint8_t)((missing <= ONLY_SAPS ? missing : KEPT_LEN - HEADER_LEN) - there);
    return phy_rx.left ? RX_SAPS : st_saps_isr();
}

/* The same with another SA or FC: `there` of them have come. */
static uint8_t st_other_header_isr(uint8_t there) IN_ISR
{
    uint8_t next;

    phy_rx.left = 1;
    if (there == 1)
        return RX_HEADER;
    next = st_header_isr();
    phy_rx.left = (uint8_t)(phy_rx.left - (uint8_t)(there - (HEADER_LEN - 1u)));
    return phy_rx.left ? next : st_saps_isr();
}

/* Not the telegram awaited, and that was seen by DA or by one of the `more` octets that are there behind it. What was as
 * awaited is not read again, unless main has changed what the plan was made from. */
static uint8_t st_other_body_isr(void) IN_ISR
{
    const uint8_t more = (uint8_t)(fdl_header.len + TAIL_LEN - 1u - phy_rx.left);

    good_sd = true;
    if (fdl_plan.stage == FDL_AWAITED && more) {
        fdl_plan.stage = FDL_UNKNOWN;
        fdl_plan.awaited = 0;
        missing = (uint8_t)(fdl_header.len - HEADER_LEN + TAIL_LEN);
        if (more >= HEADER_LEN)
            return st_other_saps_isr((uint8_t)(more - (HEADER_LEN - 1u)));
        return st_other_header_isr(more);
    }
    fdl_plan.stage = FDL_OTHERS;
    phy_rx.left = 0;
    if (!more)
        return da_isr();
    if (da_isr() == RX_HEADER)
        return st_other_header_isr(more);
    phy_rx.left = 0; /* main has changed the address */
    return RX_SYN;
}

/* Not the telegram awaited. */
static uint8_t st_another_isr(void) IN_ISR
{
    if (phy_rx.left)
        return st_other_body_isr();
    fdl_plan.stage = FDL_OTHERS;
    if (fdl_rx_buf[0] == FDL_SD2)
        return st_sd2_head_isr();
    return st_sd_isr();
}

static uint8_t st_any_isr(void) IN_ISR
{
    fdl_plan.stage = FDL_OTHERS;
    if (!phy_rx.less)
        return st_sd_isr();
    return st_sd2_head_isr() == RX_DA ? st_da_isr() : RX_SYN;
}

/* Main has changed what the plan of the telegram awaited was made from: it is made now. */
static uint8_t plan_late_isr(void) IN_ISR
{
    uint8_t next;

    fdl_plan.stage = FDL_OTHERS;
    next = da_isr();
    if (next == RX_HEADER && st_header_isr() == RX_SAPS)
        fdl_saps_isr();
    phy_rx.left = 0;
    return next == RX_SYN ? RX_SYN : st_body_isr();
}

/* The telegram awaited, or another one. */
static void st_first_isr(void) IN_ISR
{
    if (!phy_rx.less) {
        state = st_another_isr();
        return;
    }
    if (fdl_plan.stage == FDL_AWAITED) {
        fdl_plan.stage = FDL_PLANNED;
        state = st_body_isr();
    } else {
        state = plan_late_isr();
    }
    good_sd = true;
}

static uint8_t st_rest_isr(void) IN_ISR
{
    switch (state) {
    case RX_ANY:
        return st_any_isr();
    case RX_ALONE:
        return st_alone_isr();
    case RX_SD:
        return st_sd_isr();
    case RX_SD2_HEAD:
        return st_sd2_head_isr();
    case RX_DA:
        return st_da_isr();
    case RX_TOKEN:
        fdl_other_isr();
        return telegram_end_isr();
    case RX_PIECE:
        return st_piece_isr();
    default:
        return RX_SYN;
    }
}

/* In front: where the other station waits. */
void phy_chunk_ind_isr(void) IN_ISR
{
    const uint8_t was = state;

    if (was == RX_FIRST)
        st_first_isr();
    else if (was == RX_SAPS)
        state = st_saps_isr();
    else if (was == RX_HEADER)
        state = st_header_isr();
    else if (was == RX_BODY)
        state = st_body_isr();
    else
        state = st_rest_isr();
}

/* T_SYN or a bad octet in the telegram awaited, or before it. */
static void leave_awaited_isr(void) IN_ISR
{
    if (state < RX_ANY)
        return;
    if (phy_rx.at == fdl_rx_buf)
        state = RX_SYN;
    else if (fdl_rx_buf[0] == FDL_SD2)
        good_sd = true;
    else
        state = RX_SD;
}

void phy_syn_ind_isr(void) IN_ISR
{
    fdl_drop_isr();
    leave_awaited_isr();
    if (state == RX_SD && phy_rx.left == 1)
        state = st_sd_isr(); /* one octet and then silence: a short acknowledge, or nothing that makes sense */
    if (state > RX_SD)
        fdl_count_isr(&fdl_counters.gap);
    state = wait_sd_isr();
}

void phy_fault_ind_isr(uint8_t err) IN_ISR
{
    if (err & HAL_ERR_OVERRUN)
        fdl_count_isr(&fdl_counters.overrun);
    else
        fdl_count_isr(&fdl_counters.parity);
    leave_awaited_isr();
    state = RX_SYN;
}
