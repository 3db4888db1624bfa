/* FDL answers: a frame is completed around the data that already stand in a reply's room.
 *
 *   room   | SD LE LEr SD DA SA FC DAE SAE | L_sdu ......... | FCS ED |
 *          |<------ FDL_ROOM_HEAD -------->|
 *
 * The header grows from the L_sdu towards the front, so that a frame without SAP octets, or an SD3, starts later
 * in the same room. At most nine octets are written before and two behind; the data are never moved and their sum
 * is known.
 *
 * Source   EN 50170-2 part 4, 4.7.1; answers of the responder part 4, 4.1.3; spec A3
 */
#include "fdl/fdl_priv.h"

IDATA struct fdl_frame fdl_tx;

/* An SD1 that answers a numbered request (FCB) is kept for the retry, so status answers have a room of their own. */
static uint8_t XDATA numbered[6];
static uint8_t XDATA unnumbered[6];
static uint8_t XDATA short_ack[1];

static void tx_sd1_isr(uint8_t XDATA *room, uint8_t function) IN_ISR
{
    room[0] = FDL_SD1;
    room[1] = fdl_req.sa;
    room[2] = fdl_ts;
    room[3] = function;
    room[4] = (uint8_t)(fdl_req.sa + fdl_ts + function);
    room[5] = FDL_ED;
    fdl_tx.at = room;
    fdl_tx.len = 6;
}

void fdl_tx_fixed_isr(uint8_t function) IN_ISR
{
    tx_sd1_isr(numbered, function);
}

void fdl_tx_status_isr(uint8_t function) IN_ISR
{
    tx_sd1_isr(unnumbered, function);
}

void fdl_tx_short_isr(void) IN_ISR
{
    short_ack[0] = FDL_SC;
    fdl_tx.at = short_ack;
    fdl_tx.len = 1;
}

void fdl_reply_release_isr(struct fdl_reply PAGED *reply) IN_ISR
{
    uint8_t XDATA *sent;

    if (!reply->fresh)
        return;
    sent = reply->sent;
    reply->sent = reply->ready;
    reply->ready = sent;
    reply->turns++;
    reply->fresh = false;
}

/* No L_sdu: an SD1 says "diagnosis pending" where an SC could not (spec A3; facts 3.9); SC is "no reply data". */
static void tx_empty_isr(bool high) IN_ISR
{
    if (high)
        fdl_tx_fixed_isr(FDL_DH);
    else
        fdl_tx_short_isr();
}

/* By name and in internal RAM, not as arguments: see struct fdl_header. */
static struct fdl_reply PAGED *HOT from;
static uint8_t XDATA *HOT lsdu;
static uint8_t XDATA *HOT at;
static HOT uint8_t len; /* of the L_sdu                      */
static HOT uint8_t le;  /* of DA SA FC DAE SAE and the L_sdu */
static HOT uint8_t da;
static HOT uint8_t sa;
static HOT uint8_t sum;

/* SAP octets are mirrored: the requester's SSAP is our DAE. */
static void measure_isr(void) IN_ISR
{
    da = fdl_req.sa;
    sa = fdl_ts;
    le = (uint8_t)(len + 3u);
    if (fdl_req.ssap != FDL_SAP_NIL) {
        da |= FDL_ADDRESS_EXT;
        le++;
    }
    if (fdl_req.dsap != FDL_SAP_NIL) {
        sa |= FDL_ADDRESS_EXT;
        le++;
    }
}

static void put_saps_isr(void) IN_ISR
{
    if (da & FDL_ADDRESS_EXT) {
        *at = fdl_req.ssap;
        sum = (uint8_t)(sum + fdl_req.ssap);
        at++;
    }
    if (sa & FDL_ADDRESS_EXT) {
        *at = fdl_req.dsap;
        sum = (uint8_t)(sum + fdl_req.dsap);
    }
}

/* SD2, or SD3 where it was asked so and fits: around the L_sdu, whose length and sum are known. */
static void frame_isr(void) IN_ISR
{
    at = lsdu - (uint8_t)(le - len);
    at[0] = da;
    at[1] = sa;
    at[2] = fdl_tx.function;
    sum = (uint8_t)(sum + da + sa + fdl_tx.function);
    at -= 4;
    fdl_tx.len = (uint8_t)(le + 6u);
    if (fdl_req.sd3 && le == 3u + FDL_SD3_DU) {
        at += 3;
        fdl_tx.len = (uint8_t)(le + 3u);
        at[0] = FDL_SD3;
    } else {
        at[0] = FDL_SD2;
        at[1] = le;
        at[2] = le;
        at[3] = FDL_SD2;
    }
    fdl_tx.at = at;
    if (le != len + 3u) {
        at = lsdu - (uint8_t)(le - len - 3u);
        put_saps_isr();
    }
    at = lsdu + len;
    at[0] = sum;
    at[1] = FDL_ED;
}

void fdl_tx_reply_isr(struct fdl_reply PAGED *reply) IN_ISR
{
    from = reply;
    if (!from->valid) {
        fdl_tx_short_isr();
        return;
    }
    if (!from->hold && from->fresh)
        fdl_reply_release_isr(from);
    if (from->single)
        from->valid = false;
    lsdu = from->sent;
    len = lsdu[0];
    sum = lsdu[1];
    lsdu += FDL_ROOM_HEAD;
    if (len == 0) {
        tx_empty_isr(from->high);
        return;
    }
    measure_isr();
    if (le > FDL_LE_MAX || le < len) {
        fdl_counters.refused++;
        fdl_tx_fixed_isr(FDL_UE); /* our choice: asked with SAPs, they leave no room for so many data */
        return;
    }
    fdl_tx.function = from->high ? FDL_DH : FDL_DL;
    frame_isr();
}
