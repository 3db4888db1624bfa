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
#include "phy_uart/phy_uart.h"

/* The SD1 that answered a numbered request is kept for its retry; the next one is built in the other. */
static uint8_t XDATA sd1[2][6];
static IDATA uint8_t kept;
static uint8_t XDATA short_ack[1];

/* By name and in internal RAM, not as arguments: see struct fdl_header. */
static uint8_t XDATA *HOT at;
static HOT uint8_t sum;
static HOT uint8_t le;

static void put_isr(uint8_t octet) IN_ISR
{
    *at++ = octet;
    sum = (uint8_t)(sum + octet);
}

/* Addresses come back exchanged, without extension. */
void fdl_tx_fixed_isr(uint8_t function) IN_ISR
{
    at = kept ? sd1[0] : sd1[1];
    phy_tx.at = at;
    phy_tx.len = 6;
    put_isr(FDL_SD1);
    sum = 0;
    put_isr(fdl_req.sa);
    put_isr(fdl_header.da & 0x7Fu);
    put_isr(function);
    put_isr(sum);
    put_isr(FDL_ED);
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

/* The requester's octets come back exchanged: its SA is our DA, with its extension bit, its SSAP our DAE. SD2, or SD3
 * where it was asked so and fits; that is not kept. */
static void build_isr(struct fdl_room PAGED *room) IN_ISR
{
    const uint8_t fc = FDL_DL | (fdl_plan.is & FDL_HIGH);
    uint8_t XDATA *at = room->octets;

    le = (uint8_t)(fdl_header.len - fdl_req.len + at[0]);
    phy_tx.len = (uint8_t)(le + 6u);
    if (!fdl_req.sd3)
        room->frame_len = phy_tx.len;
    sum = (uint8_t)(at[1] + fdl_header.sa + fdl_header.da + fc);
    at += (uint8_t)(FDL_ROOM(at[0]) - phy_tx.len);
    phy_tx.at = at;
    at[0] = FDL_SD2;
    at[1] = le;
    at[2] = le;
    at[3] = FDL_SD2;
    if (fdl_req.sd3 && le == 3u + FDL_SD3_DU) {
        at[3] = FDL_SD3;
        phy_tx.at += 3;
        phy_tx.len = 3u + FDL_SD3_DU + 3u;
    }
    at += 4;
    at[0] = fdl_header.sa;
    at[1] = fdl_header.da;
    at[2] = fc;
    at += 3;
    if (fdl_header.sa & FDL_ADDRESS_EXT) {
        *at++ = fdl_req.ssap;
        sum = (uint8_t)(sum + fdl_req.ssap);
    }
    if (fdl_header.da & FDL_ADDRESS_EXT) {
        *at++ = fdl_req.dsap;
        sum = (uint8_t)(sum + fdl_req.dsap);
    }
    at += room->octets[0];
    at[0] = sum;
    at[1] = FDL_ED;
}

void fdl_tx_frame_isr(struct fdl_room PAGED *room) IN_ISR
{
    const uint8_t fc = FDL_DL | (fdl_plan.is & FDL_HIGH);
    uint8_t XDATA *to;

    phy_tx.len = room->frame_len;
    if (!phy_tx.len) {
        build_isr(room);
        return;
    }
    to = room->octets + (uint8_t)(FDL_ROOM_HEAD + fdl_req.len - fdl_header.len);
    sum = (uint8_t)(fdl_header.sa - to[0]); /* what FCS grows by */
    to[0] = fdl_header.sa;
    sum = (uint8_t)(sum + fdl_header.da - to[1]);
    to[1] = fdl_header.da;
    sum = (uint8_t)(sum + fc - to[2]);
    to[2] = fc;
    to += (uint8_t)(phy_tx.len - 6u);
    *to = (uint8_t)(*to + sum);
}
