/* FDL answers: a frame is completed around the data that already stand in a reply's room.
 *
 *   room   | SD LE LEr SD DA SA FC DAE SAE | L_sdu ......... | FCS ED |
 *          |<------ FDL_ROOM_HEAD -------->|
 *
 * The header grows from the L_sdu towards the front, so that a frame without SAP octets, or an SD3, starts later in the
 * same room. At most nine octets are written before and two behind; the data are never moved and their sum is known.
 *
 * Source   EN 50170-2 part 4, 4.7.1; answers of the responder part 4, 4.1.3; spec A3
 */
#include "fdl/fdl_priv.h"

struct fdl_frame XDATA fdl_tx;

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

void fdl_reply_release_isr(struct fdl_reply XDATA *reply) IN_ISR
{
    uint8_t sent;

    if (!reply->fresh)
        return;
    sent = reply->sent;
    reply->sent = reply->ready;
    reply->ready = sent;
    reply->turns++;
    reply->fresh = false;
}

static uint8_t XDATA *head; /* first octet of the header so far  */
static uint8_t head_sum;    /* of DA SA FC DAE SAE and the L_sdu */

/* SAP octets, mirrored: the requester's SSAP is our DAE. */
static void put_saps_isr(void) IN_ISR
{
    if (fdl_req.dsap != FDL_SAP_NIL) {
        *--head = fdl_req.dsap;
        head_sum = (uint8_t)(head_sum + fdl_req.dsap);
    }
    if (fdl_req.ssap != FDL_SAP_NIL) {
        *--head = fdl_req.ssap;
        head_sum = (uint8_t)(head_sum + fdl_req.ssap);
    }
}

static void put_addresses_isr(uint8_t function) IN_ISR
{
    uint8_t sa = fdl_ts;
    uint8_t da = fdl_req.sa;

    if (fdl_req.dsap != FDL_SAP_NIL)
        sa |= FDL_ADDRESS_EXT;
    if (fdl_req.ssap != FDL_SAP_NIL)
        da |= FDL_ADDRESS_EXT;
    *--head = function;
    *--head = sa;
    *--head = da;
    head_sum = (uint8_t)(head_sum + function + sa + da);
}

/* No L_sdu: an SD1 says "diagnosis pending" where an SC could not (spec A3; facts 3.9); SC is "no reply data". */
static void tx_empty_isr(bool high) IN_ISR
{
    if (high)
        fdl_tx_fixed_isr(FDL_DH);
    else
        fdl_tx_short_isr();
}

void fdl_tx_reply_isr(struct fdl_reply XDATA *reply) IN_ISR
{
    uint8_t XDATA *lsdu;
    uint8_t len;
    uint8_t le;
    uint8_t i;

    if (!reply->hold)
        fdl_reply_release_isr(reply);
    i = reply->sent;
    len = reply->len[i];
    if (!reply->valid) {
        fdl_tx_short_isr();
        return;
    }
    if (reply->single)
        reply->valid = false;
    if (len == 0) {
        tx_empty_isr(reply->high);
        return;
    }
    le = (uint8_t)(len + (fdl_req.dsap != FDL_SAP_NIL) + (fdl_req.ssap != FDL_SAP_NIL));
    if (le > FDL_LE_MAX - 3u) {
        fdl_counters.refused++;
        fdl_tx_fixed_isr(FDL_UE); /* our choice: asked with SAPs, they leave no room for so many data */
        return;
    }

    lsdu = reply->room[i] + FDL_ROOM_HEAD;
    head = lsdu;
    head_sum = reply->sum[i];
    put_saps_isr();
    put_addresses_isr(reply->high ? FDL_DH : FDL_DL);
    if (fdl_req.sd3 && le == FDL_SD3_DU) {
        *--head = FDL_SD3;
    } else {
        le += 3;
        *--head = FDL_SD2;
        *--head = le;
        *--head = le;
        *--head = FDL_SD2;
    }
    lsdu[len] = head_sum;
    lsdu[len + 1u] = FDL_ED;
    fdl_tx.at = head;
    fdl_tx.len = (uint8_t)(&lsdu[len] - head + 2);
}
