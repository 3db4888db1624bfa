/* FDL answers: a frame is completed around the data that already stand in a reply's room.
 *
 *   room   | length sum | SD LE LEr SD DA SA FC DAE SAE | L_sdu ......... | FCS ED |
 *          |<------------- FDL_ROOM_HEAD ------------->|
 *
 * The header ends where the L_sdu begins: a frame without SAP octets, or an SD3, starts later in the same room. At most nine
 * octets are written before and FCS behind; the data are never moved and their sum is known, and ED stands there.
 *
 * Source   EN 50170-2 part 4, 4.7.1; answers of the responder part 4, 4.1.3; spec A3
 */
#include "fdl/fdl_priv.h"
#include "phy_uart/phy_uart.h"

/* The SD1 that answered a numbered request is kept for its retry; the next one is built in the other. */
static uint8_t XDATA sd1[2][6];
static IDATA uint8_t kept;
static uint8_t XDATA short_ack[1];

static HOT uint8_t sum; /* in internal RAM: see struct fdl_header */

/* Addresses come back exchanged, without extension. */
void fdl_tx_fixed_isr(uint8_t function) IN_ISR
{
    uint8_t XDATA *at = kept ? sd1[0] : sd1[1];
    const uint8_t da = fdl_header.da & 0x7Fu;

    phy_tx.at = at;
    phy_tx.len = 6;
    at[0] = FDL_SD1;
    at[1] = fdl_req.sa;
    at[2] = da;
    at[3] = function;
    at[4] = (uint8_t)(fdl_req.sa + da + function);
    at[5] = FDL_ED;
}

/* In a room of its own, at a known place: FDL status comes in the shortest of all telegrams. */
void fdl_tx_status_isr(void) IN_ISR
{
    static uint8_t XDATA status[6];
    const uint8_t da = fdl_header.da;

    status[0] = FDL_SD1;
    status[1] = fdl_req.sa;
    status[2] = da;
    status[3] = FDL_OK;
    status[4] = (uint8_t)(fdl_req.sa + da);
    status[5] = FDL_ED;
    phy_tx.at = status;
    phy_tx.len = 6;
}

void fdl_tx_keep_isr(void) IN_ISR
{
    kept ^= 1u;
}

void fdl_tx_short_isr(void) IN_ISR
{
    short_ack[0] = FDL_SC;
    phy_tx.at = short_ack;
    phy_tx.len = 1;
}

void fdl_turn_isr(struct fdl_reply PAGED *reply) IN_ISR
{
    struct fdl_room PAGED *sent = reply->sent;

    reply->sent = reply->ready;
    reply->ready = sent;
    reply->is &= (uint8_t)~FDL_FRESH;
}

void fdl_turn_sent_isr(void) IN_ISR
{
    if (fdl_plan.turn)
        fdl_turn_isr(fdl_req.reply);
    fdl_plan.turn = 0;
}

/* What Freeze takes may give up the room of the answer kept for a retry. */
void fdl_reply_release_isr(struct fdl_reply PAGED *reply) IN_ISR
{
    if (!(reply->is & FDL_FRESH))
        return;
    fdl_turn_isr(reply);
    if (fdl_last.reply == reply)
        fdl_last.answer_len = 0;
}

void fdl_reply_priority_isr(struct fdl_reply PAGED *reply, uint8_t priority) IN_ISR
{
    uint8_t is = (uint8_t)((reply->is & ~FDL_HIGH) | priority);

    if (is == reply->is)
        return;
    reply->is = is;
    fdl_replan_isr(reply);
}

/* Where it was asked so, a frame of the right length; it is not kept. */
static void as_sd3_isr(struct fdl_room PAGED *room) IN_ISR
{
    room->head = 0;
    if (phy_tx.len != 3u + FDL_SD3_DU + 6u)
        return;
    phy_tx.at += 3;
    phy_tx.len = 3u + FDL_SD3_DU + 3u;
    *(uint8_t XDATA *)phy_tx.at = FDL_SD3;
}

/* The requester's octets come back exchanged: its SA is our DA, with its extension bit, its SSAP our DAE. */
void fdl_tx_frame_isr(struct fdl_room PAGED *room) IN_ISR
{
    const uint8_t fc = FDL_DL | (fdl_plan.is & FDL_HIGH);
    const uint8_t le = (uint8_t)(phy_tx.len - 6u);
    const uint8_t head = (uint8_t)(fdl_header.len - fdl_req.len);
    uint8_t XDATA *at = room->octets;

    sum = (uint8_t)(at[1] + fdl_header.sa + fdl_header.da + fc);
    at = (uint8_t XDATA *)phy_tx.at;
    if (room->head != head) {
        room->head = head;
        at[0] = FDL_SD2;
        at[1] = le;
        at[2] = le;
        at[3] = FDL_SD2;
    }
    at += 4;
    at[0] = fdl_header.sa;
    at[1] = fdl_header.da;
    at[2] = fc;
    if (head == 5u) {
        at[3] = fdl_header.more[1];
        at[4] = fdl_header.more[0];
        sum = (uint8_t)(sum + fdl_header.more[1] + fdl_header.more[0]);
    } else if (head == 4u) {
        at[3] = fdl_header.more[0];
        sum = (uint8_t)(sum + fdl_header.more[0]);
    }
    at[le] = sum;
    if (fdl_req.sd3)
        as_sd3_isr(room);
}
