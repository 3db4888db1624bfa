/* Slave_Diag: what the master is told about the station.
 *
 *   octet 1 Station_status_1   2 Station_status_2   3 Ext_Diag_Overflow   4 Diag.Master_Add   5, 6 Ident_Number
 *         7... extended diagnosis: blocks, each with its kind in bits 7..6 of its first octet
 * Source   EN 50170-2 part 8, Slave_Diag; spec A6; facts 3.9
 */
#include "bytes.h"
#include "ddlm/ddlm_priv.h"
#include "hal/hal.h"

#define FIXED_LEN 6u
#define MAX_LEN   (FIXED_LEN + DEV_EXT_DIAG_MAX)

struct fdl_reply PAGED ddlm_diag_reply;
static uint8_t XDATA rooms[3][FDL_ROOM(MAX_LEN)];
static uint8_t XDATA diag[MAX_LEN];

/* What is said to a master whose Set_Prm or Chk_Cfg has been acknowledged but not looked at yet: not ready,
 * nothing wrong. A master that polls faster than the main loop turns would otherwise read "parameters requested"
 * and begin anew. */
static struct fdl_reply PAGED pending_reply;
static uint8_t XDATA pending_rooms[3][FDL_ROOM(FIXED_LEN)];

static uint8_t len;
static uint8_t flags; /* DDLM_EXT_DIAG, DDLM_STAT_DIAG */

void ddlm_diag_init(void)
{
    fdl_reply_init(&ddlm_diag_reply, rooms[0], MAX_LEN, SAP_SLAVE_DIAG);
    fdl_reply_init(&pending_reply, pending_rooms[0], FIXED_LEN, SAP_SLAVE_DIAG);
    len = FIXED_LEN;
    flags = 0;
    diag[0] = DIAG_NOT_READY;
    diag[1] = DIAG2_ALWAYS;
    diag[2] = 0;
    diag[3] = DDLM_NO_MASTER;
    put_u16be(diag + 4, DEV_IDENT);
    fdl_reply_write(&pending_reply, diag, FIXED_LEN, FDL_UPDATE_LOW);
}

static uint8_t status_1(void)
{
    uint8_t bits = ddlm.faults;

    if (ddlm.state != DDLM_DATA_EXCH)
        bits |= DIAG_NOT_READY;
    if (flags & DDLM_EXT_DIAG)
        bits |= DIAG_EXT_DIAG;
    return bits;
}

static uint8_t status_2(void)
{
    uint8_t bits = DIAG2_ALWAYS;

    if (ddlm.state <= DDLM_WAIT_PRM)
        bits |= DIAG2_PRM_REQ;
    if (flags & DDLM_STAT_DIAG)
        bits |= DIAG2_STAT_DIAG;
    if (ddlm_wd_on())
        bits |= DIAG2_WD_ON;
    if (ddlm_freeze_mode())
        bits |= DIAG2_FREEZE;
    if (ddlm_sync_mode())
        bits |= DIAG2_SYNC;
    return bits;
}

void ddlm_diag_update(void)
{
    diag[0] = status_1();
    diag[1] = status_2();
    diag[3] = ddlm.master;
    fdl_reply_write(&ddlm_diag_reply, diag, len, FDL_UPDATE_LOW);
}

void ddlm_diag_ask_isr(void) IN_ISR
{
    if (fdl_waiting_isr(SAP_SET_PRM)) /* or for Chk_Cfg, the only SAP above */
        fdl_req.reply = &pending_reply;
}

/* The owner has the news, unless there are newer ones; anybody else may look without taking them away. */
void ddlm_diag_read_isr(void) IN_ISR
{
    if (fdl_req.reply == &ddlm_diag_reply && fdl_req.sa == ddlm.master && !(ddlm_diag_reply.is & FDL_FRESH) &&
        !(flags & DDLM_STAT_DIAG))
        fdl_reply_priority_isr(&ddlm_input_reply, FDL_UPDATE_LOW);
}

/* Diag_Flag: Data_Exchange is answered DH. */
static void raise_flag(void)
{
    uint8_t irq = hal_irq_save();

    fdl_reply_priority_isr(&ddlm_input_reply, FDL_UPDATE_HIGH);
    hal_irq_restore(irq);
}

/* Length of the block at ext[0], 0 where there is none that fits in n octets. */
#define KIND_CHANNEL  0x80u
#define KIND_RESERVED 0xC0u
#define CHANNEL_LEN   3u

static uint8_t block_length(const uint8_t XDATA *ext, uint8_t n)
{
    uint8_t kind = ext[0] & 0xC0u;
    uint8_t length = kind == KIND_CHANNEL ? CHANNEL_LEN : (uint8_t)(ext[0] & 0x3Fu);

    if (kind == KIND_RESERVED || length < 2 || length > n)
        return 0;
    return length;
}

/* Octets of whole blocks that fit; n where all do. 0xFF: malformed. */
#define MALFORMED 0xFFu

static uint8_t whole_blocks(const uint8_t XDATA *ext, uint8_t n)
{
    uint8_t fit = 0;
    uint8_t at = 0;
    uint8_t length;

    while (at < n) {
        length = block_length(ext + at, (uint8_t)(n - at));
        if (length == 0)
            return MALFORMED;
        at = (uint8_t)(at + length);
        if (at <= DEV_EXT_DIAG_MAX)
            fit = at;
    }
    return fit;
}

bool ddlm_diag(const uint8_t XDATA *ext, uint8_t n, uint8_t how)
{
    uint8_t fit = whole_blocks(ext, n);
    uint8_t i;

    if (fit == MALFORMED || (how & ~(DDLM_EXT_DIAG | DDLM_STAT_DIAG)))
        return false;
    for (i = 0; i < fit; i++)
        diag[FIXED_LEN + i] = ext[i];
    len = (uint8_t)(FIXED_LEN + fit);
    diag[2] = fit < n ? DIAG3_OVERFLOW : 0;
    flags = how;
    ddlm_diag_update();
    raise_flag();
    return true;
}
