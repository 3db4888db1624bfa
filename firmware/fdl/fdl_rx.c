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
    RX_SD,       /* a start delimiter and the octet behind it                 */
    RX_SD2_HEAD, /* LEr SD2 DA SA FC                                          */
    RX_HEADER,   /* SA FC, of the other formats                               */
    RX_SAPS,     /* DAE SAE                                                   */
    RX_TOKEN,    /* SA of a token                                             */
    RX_PIECE,    /* a piece of a telegram that is longer than the buffer      */
    RX_BODY,     /* the rest, up to ED                                        */
    RX_AWAITED,  /* all of the telegram that is awaited, unless it is another */
};

uint8_t XDATA *HOT fdl_rx_buf;
HOT struct fdl_header fdl_header;
HOT struct fdl_now fdl_now;

static HOT uint8_t state;
static IDATA uint8_t good_sd; /* the last SD was one: counted at the end of the telegram, which is answered first */
static IDATA uint8_t missing; /* octets of body, FCS and ED to come */

#define SD2_HEAD_LEN 4u /* SD2 LE LEr SD2 */
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

/* The telegram awaited, as a whole. Else two octets: at 187.5 kbit/s an 8-bit part has no time to look at each. Only the
 * short acknowledge is shorter, and is known by the silence behind it; where none can be seen, one octet must do. */
static uint8_t wait_sd_isr(void) IN_ISR
{
    if (good_sd)
        fdl_count_isr(&fdl_counters.sd_count);
    good_sd = false;
    phy_rx.model = PHY_MODEL_END;
    if (phy_rx.untimed) {
        phy_rx.at = fdl_rx_buf;
        phy_rx.left = 1;
        return RX_ALONE;
    }
    if (fdl_await_isr()) {
        phy_rx.at = fdl_rx_buf;
        phy_rx.model = PHY_MODEL_END - fdl_plan.awaited;
        phy_rx.left = (uint8_t)(fdl_header.len + SD2_HEAD_LEN + TAIL_LEN);
        phy_rx.less = (uint8_t)(fdl_header.len - HEADER_LEN + TAIL_LEN);
        phy_rx.sum = (uint8_t)(0u - 2u * FDL_SD2 - 2u * fdl_header.len); /* from DA on */
        return RX_AWAITED;
    }
    phy_rx.at = fdl_rx_buf;
    phy_rx.left = 2;
    return RX_SD;
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

/* DA SA FC are there, at their place. They are looked at now, while the rest comes in: what is decided here costs no
 * T_SDR. */
static uint8_t st_header_isr(void) IN_ISR
{
    uint8_t to;

    fdl_now.da = fdl_rx_buf[FDL_BODY];
    fdl_now.sa = fdl_rx_buf[FDL_BODY + 1u];
    fdl_now.fc = fdl_rx_buf[FDL_BODY + 2u];
    phy_rx.sum = (uint8_t)(fdl_now.da + fdl_now.sa + fdl_now.fc);
    missing = (uint8_t)(fdl_header.len - HEADER_LEN + TAIL_LEN);
    to = fdl_now.da & 0x7Fu;
    if (to == fdl_ts || to == FDL_BROADCAST) {
        if (fdl_header_isr()) {
            phy_rx.left = missing <= ONLY_SAPS ? missing : KEPT_LEN - HEADER_LEN;
            return RX_SAPS;
        }
    } else if (fdl_skips_others && !phy_rx.untimed) {
        fdl_other_isr();
        return RX_SYN;
    }
    return want_rest_isr(ROOM_BEHIND(HEADER_LEN));
}

/* DA is there, right behind SD. */
static uint8_t start_body_isr(uint8_t len) IN_ISR
{
    fdl_header.len = len;
    fdl_rx_buf[FDL_BODY] = fdl_rx_buf[1];
    phy_rx.at = fdl_rx_buf + (FDL_BODY + 1u);
    phy_rx.left = HEADER_LEN - 1u;
    return RX_HEADER;
}

static uint8_t bad_sd_isr(void) IN_ISR
{
    good_sd = false;
    fdl_count_isr(&fdl_counters.sd_error_count);
    return RX_SYN;
}

static uint8_t st_sd_isr(void) IN_ISR
{
    uint8_t sd = fdl_rx_buf[0];

    fdl_plan.stage = FDL_OTHERS;
    good_sd = true;
    fdl_req.sd3 = 0;
    if (sd == FDL_SD2) {
        phy_rx.left = SD2_HEAD_LEN - 2u + HEADER_LEN;
        return RX_SD2_HEAD;
    }
    if (sd == FDL_SD1)
        return start_body_isr(HEADER_LEN);
    if (sd == FDL_SD3) {
        fdl_req.sd3 = FDL_AS_SD3;
        fdl_plan.made = 0;
        return start_body_isr(HEADER_LEN + FDL_SD3_DU);
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
    if (fdl_rx_buf[0] == FDL_SC)
        return st_sd_isr();
    phy_rx.left = 1;
    return RX_SD;
}

static uint8_t st_sd2_head_isr(void) IN_ISR
{
    fdl_header.len = fdl_rx_buf[1];
    if (fdl_header.len != fdl_rx_buf[2] || fdl_header.len < FDL_LE_MIN || fdl_header.len > FDL_LE_MAX ||
        fdl_rx_buf[3] != FDL_SD2) {
        fdl_count_isr(&fdl_counters.format);
        return RX_SYN;
    }
    return st_header_isr();
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

static uint8_t st_saps_isr(void) IN_ISR
{
    fdl_saps_isr();
    if (missing <= ONLY_SAPS)
        return st_body_isr();
    missing = (uint8_t)(missing - (KEPT_LEN - HEADER_LEN));
    return want_rest_isr(ROOM_BEHIND(KEPT_LEN));
}

/* Not the telegram awaited, and that was seen behind the header. */
static uint8_t st_other_saps_isr(void) IN_ISR
{
    const uint8_t there = (uint8_t)(phy_rx.at - fdl_rx_buf);
    const uint8_t sum = phy_rx.sum;
    uint8_t next;

    phy_rx.left = 0;
    next = st_sd2_head_isr();
    if (next == RX_SYN)
        return RX_SYN;
    phy_rx.sum = sum;
    phy_rx.left = (uint8_t)(phy_rx.left - (uint8_t)(there - (FDL_BODY + HEADER_LEN)));
    return phy_rx.left ? next : st_saps_isr();
}

/* Not the telegram awaited: two octets of it, its header, or more. */
static uint8_t st_another_isr(void) IN_ISR
{
    fdl_plan.stage = FDL_OTHERS;
    good_sd = true;
    if (phy_rx.left)
        return st_other_saps_isr();
    if (fdl_rx_buf[0] == FDL_SD2)
        return st_sd2_head_isr();
    return st_sd_isr();
}

/* Main has changed what the plan of the telegram awaited was made from: it is made now. */
static uint8_t plan_late_isr(void) IN_ISR
{
    const uint8_t sum = phy_rx.sum;
    uint8_t next;

    fdl_plan.stage = FDL_OTHERS;
    next = st_header_isr();
    if (next == RX_SYN)
        return RX_SYN;
    if (next == RX_SAPS)
        fdl_saps_isr();
    phy_rx.sum = sum;
    phy_rx.left = 0;
    return st_body_isr();
}

/* The telegram awaited, or another one. */
static void st_awaited_isr(void) IN_ISR
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

void phy_chunk_ind_isr(void) IN_ISR
{
    if (state >= RX_BODY) { /* first: the other station waits */
        if (state == RX_BODY)
            state = st_body_isr();
        else
            st_awaited_isr();
        return;
    }
    switch (state) {
    case RX_ALONE:
        state = st_alone_isr();
        break;
    case RX_SD:
        state = st_sd_isr();
        break;
    case RX_SD2_HEAD:
        state = st_sd2_head_isr();
        break;
    case RX_HEADER:
        state = st_header_isr();
        break;
    case RX_SAPS:
        state = st_saps_isr();
        break;
    case RX_TOKEN:
        fdl_other_isr();
        state = telegram_end_isr();
        break;
    case RX_PIECE:
        state = st_piece_isr();
        break;
    default:
        state = RX_SYN;
        break;
    }
}

/* T_SYN or a bad octet in the telegram awaited, or before it. */
static void leave_awaited_isr(void) IN_ISR
{
    if (state != RX_AWAITED)
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
