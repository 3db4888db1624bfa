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
    RX_SYN,      /* T_SYN of silence: the receiver is deaf                    */
    RX_SD,       /* a start delimiter                                         */
    RX_SD2_HEAD, /* LE LEr SD2                                                */
    RX_TOKEN,    /* DA SA of a token                                          */
    RX_PIECE,    /* a piece of a telegram that is longer than the buffer      */
    RX_BODY,     /* the rest, up to ED                                        */
};

uint8_t XDATA *HOT fdl_rx_buf;

static HOT uint8_t state;
static HOT uint8_t body_len; /* DA..last DU octet                    */
static HOT uint8_t missing;  /* octets of body, FCS and ED to come   */

#define HEADER_LEN 5u /* DA SA FC DAE SAE: kept even of a telegram that is too long */
#define TAIL_LEN   2u /* FCS ED */

void fdl_rx_reset(void)
{
    state = RX_SYN;
}

static uint8_t wait_sd_isr(void) IN_ISR
{
    phy_rx.at = fdl_rx_buf;
    phy_gather_isr(1);
    return RX_SD;
}

/* A telegram has ended, good or foreign. */
static uint8_t telegram_end_isr(void) IN_ISR
{
    if (phy_telegram_end_isr())
        return wait_sd_isr();
    return RX_SYN;
}

/* Out of step: only T_SYN of silence resynchronises. */
static uint8_t drop_isr(void) IN_ISR
{
    phy_deaf_isr();
    return RX_SYN;
}

/* The body, FCS and ED, in pieces where they are longer than the buffer: the header stays, what follows it is
 * overwritten by the next piece (the telegram will be refused; its FCS is still checked). */
static uint8_t want_body_isr(void) IN_ISR
{
    const uint8_t room = (uint8_t)(FDL_BUF_LEN - FDL_BODY - HEADER_LEN);

    if (missing <= room) {
        phy_gather_isr(missing);
        return RX_BODY;
    }
    phy_gather_isr((uint8_t)(room - TAIL_LEN));
    missing = (uint8_t)(missing - (room - TAIL_LEN));
    return RX_PIECE;
}

static uint8_t start_body_isr(void) IN_ISR
{
    phy_rx.at = fdl_rx_buf + FDL_BODY;
    phy_rx.sum = 0;
    if (body_len <= FDL_BODY_MAX) {
        phy_gather_isr((uint8_t)(body_len + TAIL_LEN));
        return RX_BODY;
    }
    missing = (uint8_t)(body_len + TAIL_LEN - HEADER_LEN);
    phy_gather_isr(HEADER_LEN);
    return RX_PIECE;
}

static uint8_t st_sd_isr(void) IN_ISR
{
    uint8_t sd = fdl_rx_buf[0];

    fdl_counters.sd_count++;
    switch (sd) {
    case FDL_SD1:
        body_len = 3;
        return start_body_isr();
    case FDL_SD2:
        phy_gather_isr(3);
        return RX_SD2_HEAD;
    case FDL_SD3:
        body_len = 3 + FDL_SD3_DU;
        return start_body_isr();
    case FDL_SD4:
        phy_gather_isr(2);
        return RX_TOKEN;
    case FDL_SC:
        fdl_other_isr();
        return telegram_end_isr();
    default:
        fdl_counters.sd_count--;
        fdl_counters.sd_error_count++;
        return drop_isr();
    }
}

static uint8_t st_sd2_head_isr(void) IN_ISR
{
    uint8_t le = fdl_rx_buf[1];

    if (le != fdl_rx_buf[2] || le < FDL_LE_MIN || le > FDL_LE_MAX || fdl_rx_buf[3] != FDL_SD2) {
        fdl_counters.format++;
        return drop_isr();
    }
    body_len = le;
    return start_body_isr();
}

static uint8_t st_piece_isr(void) IN_ISR
{
    phy_rx.at = fdl_rx_buf + FDL_BODY + HEADER_LEN;
    return want_body_isr();
}

static uint8_t st_body_isr(void) IN_ISR
{
    const uint8_t XDATA *end = phy_rx.at;
    uint8_t ed = end[-1];
    uint8_t fcs = end[-2];

    if (ed != FDL_ED) {
        fdl_counters.format++;
        return drop_isr();
    }
    if ((uint8_t)(phy_rx.sum - ed - fcs) != fcs) {
        fdl_counters.checksum++;
        return drop_isr();
    }
    fdl_telegram_isr(body_len, body_len <= FDL_BODY_MAX);
    return telegram_end_isr();
}

void phy_chunk_ind_isr(void) IN_ISR
{
    switch (state) {
    case RX_SD:
        state = st_sd_isr();
        break;
    case RX_SD2_HEAD:
        state = st_sd2_head_isr();
        break;
    case RX_TOKEN:
        fdl_other_isr();
        state = telegram_end_isr();
        break;
    case RX_PIECE:
        state = st_piece_isr();
        break;
    case RX_BODY:
        state = st_body_isr();
        break;
    default:
        state = drop_isr();
        break;
    }
}

void phy_syn_ind_isr(void) IN_ISR
{
    if (state > RX_SD)
        fdl_counters.gap++;
    state = wait_sd_isr();
}

void phy_fault_ind_isr(uint8_t err) IN_ISR
{
    if (err & HAL_ERR_OVERRUN)
        fdl_counters.overrun++;
    else
        fdl_counters.parity++;
    state = RX_SYN;
}
