/* Service access points and their update buffers.
 *
 * Source   SAP activation, REPLY_UPDATE, LSAP status, Ident: EN 50170-2 part 3; spec A4, A5
 */
#include "fdl/fdl_priv.h"
#include "hal/hal.h"
#include "phy_uart/phy_uart.h"

/* A row without services is free; the first one is that of all SAPs which are not active. */
static struct fdl_sap PAGED rows[FDL_SAPS + 1u];
struct fdl_sap PAGED *XDATA fdl_row_of[FDL_SAP_NUMBERS];
#define NO_ROW (&rows[0])

#define SSAP_OF_MASTERS 62u /* all services of DP are asked from it: spec A6 */

#define IDENT_MAX 64u /* four length octets and four strings */
#define LSAP_LEN  6u  /* Access, its extension, and an octet each for SDA SDN SRD CSRD */

static uint8_t XDATA ident_rooms[3][FDL_ROOM(IDENT_MAX)];
static uint8_t XDATA lsap_octets[FDL_ROOM(LSAP_LEN)];
static struct fdl_reply PAGED ident;
static struct fdl_room PAGED lsap;

/* ---- activation ------------------------------------------------------------------------------------------ */

void fdl_sap_reset(void)
{
    uint8_t i;

    for (i = 0; i < FDL_SAP_NUMBERS; i++)
        fdl_row_of[i] = NO_ROW;
    for (i = 0; i <= FDL_SAPS; i++)
        rows[i].services = 0;
    fdl_reply_init(&ident, ident_rooms[0], IDENT_MAX, FDL_SAP_NIL);
    lsap.octets = lsap_octets;
    lsap_octets[FDL_ROOM_HEAD + LSAP_LEN + 1u] = FDL_ED;
}

struct fdl_sap PAGED *fdl_sap_row_isr(uint8_t sap) IN_ISR
{
    return fdl_row_of[sap];
}

static bool number_is_valid(uint8_t sap)
{
    return sap <= FDL_SAP_MAX || sap == FDL_SAP_NIL;
}

/* The row a SAP has or could have, NO_ROW when there is none left. */
static struct fdl_sap PAGED *find_row(uint8_t sap)
{
    struct fdl_sap PAGED *row = fdl_row_of[sap];

    if (row != NO_ROW)
        return row;
    for (row = rows + FDL_SAPS; row != NO_ROW; row--)
        if (!row->services)
            break;
    return row;
}

bool fdl_sap_set(uint8_t sap, const struct fdl_sap PAGED *how)
{
    struct fdl_sap PAGED *row;
    uint8_t irq;
    uint8_t i;

    if (!number_is_valid(sap))
        return false;
    row = find_row(sap);
    if (row == NO_ROW)
        return false;
    ASSERT(how->services);
    irq = hal_irq_save();
    for (i = 0; i < sizeof *how; i++) /* SDCC's struct assignment is a library of its own */
        ((uint8_t PAGED *)row)[i] = ((const uint8_t PAGED *)how)[i];
    fdl_row_of[sap] = row;
    fdl_replan_isr(0);
    hal_irq_restore(irq);
    return true;
}

/* A request that has been answered and not yet executed goes with its SAP. */
bool fdl_sap_clear(uint8_t sap)
{
    struct fdl_sap PAGED *row;
    uint8_t irq;

    if (!number_is_valid(sap))
        return false;
    row = fdl_row_of[sap];
    if (row == NO_ROW)
        return false;
    irq = hal_irq_save();
    fdl_row_of[sap] = NO_ROW;
    row->services = 0;
    if (fdl_req.dsap == sap)
        fdl_plan.handling = FDL_ANSWER_ONLY;
    fdl_replan_isr(0);
    hal_irq_restore(irq);
    return true;
}

/* ---- update buffers -------------------------------------------------------------------------------------- */

void fdl_reply_init(struct fdl_reply PAGED *reply, uint8_t XDATA *rooms, uint8_t max, uint8_t sap)
{
    uint8_t i;

    for (i = 0; i < 3; i++) {
        reply->rooms[i].octets = rooms;
        reply->rooms[i].head = 0;
        rooms += FDL_ROOM(max);
    }
    reply->sent = &reply->rooms[0];
    reply->ready = &reply->rooms[1];
    reply->spare = &reply->rooms[2];
    reply->max = max;
    reply->is = 0;
    reply->sap = sap;
}

static uint8_t XDATA *HOT to;
static const uint8_t XDATA *HOT from;
static HOT uint8_t sum;
static struct fdl_room PAGED *HOT room;

static void put(uint8_t octet)
{
    *to++ = octet;
    sum = (uint8_t)(sum + octet);
}

static void copy(uint8_t n)
{
    for (; n; n--)
        put(*from++);
}

/* DA SA FC DAE SAE where nobody has asked for this reply, for who asked last for any. */
static void put_header(uint8_t sap)
{
    const uint8_t ext = sap == FDL_SAP_NIL ? 0u : FDL_ADDRESS_EXT;

    put(fdl_req.sa | ext);
    put(fdl_ts | ext);
    put(FDL_DL);
    if (ext) {
        put(SSAP_OF_MASTERS);
        put(sap);
    }
}

/* The L_sdu in the spare room, with the frame around it: for who asked last. Where somebody else asks meanwhile, its head
 * may be a mixture of both, with the right FCS. */
static void write_spare(struct fdl_reply PAGED *reply, const uint8_t XDATA *lsdu, uint8_t len)
{
    const uint8_t asked = reply->sent->head;
    uint8_t head = asked;
    uint8_t le;

    if (!asked)
        head = reply->sap == FDL_SAP_NIL ? 3u : 5u;
    le = (uint8_t)(len + head);
    to = room->octets + (uint8_t)(FDL_ROOM_HEAD - 4u - head);
    put(FDL_SD2);
    put(le);
    put(le);
    put(FDL_SD2);
    sum = 0;
    if (asked) {
        from = reply->sent->octets + (uint8_t)(FDL_ROOM_HEAD - head);
        copy(head);
    } else {
        put_header(reply->sap);
    }
    room->octets[1] = sum; /* not kept in a local: SDCC takes `sum` itself for its copy, over the call */
    from = lsdu;
    copy(len);
    to[0] = sum;
    to[1] = FDL_ED;
    to = room->octets;
    to[0] = len;
    to[1] = (uint8_t)(sum - to[1]);
    room->head = len == 0 || le > FDL_LE_MAX ? 0u : head;
}

/* our choice: a request that is being decided goes first. On an 8051 what is locked here would add up to 14 T_bit to its
 * T_SDR at 93.75 kbit/s. Not waited for longer than for a short one. */
static void let_request_go_first(void)
{
    const volatile uint8_t HOT *stage = &fdl_plan.stage;
    uint8_t turns = 60;

    while ((*stage == FDL_UNKNOWN || *stage == FDL_PLANNED) && turns)
        turns--;
}

void fdl_reply_write(struct fdl_reply PAGED *reply, const uint8_t XDATA *lsdu, uint8_t len, uint8_t how)
{
    uint8_t irq;

    room = reply->spare;
    write_spare(reply, lsdu, len);
    let_request_go_first();
    irq = hal_irq_save();
    fdl_turn_sent_isr();
    reply->spare = reply->ready;
    reply->ready = room;
    reply->is = (uint8_t)((reply->is & ~FDL_SINGLE) | FDL_FRESH | FDL_VALID | (how & FDL_SINGLE));
    if (!(how & FDL_UPDATE_KEEP))
        fdl_reply_priority_isr(reply, how & FDL_UPDATE_HIGH);
    fdl_written_isr(reply);
    hal_irq_restore(irq);
    irq = hal_irq_save();
    fdl_refresh_isr();
    hal_irq_restore(irq);
}

void fdl_reply_empty(struct fdl_reply PAGED *reply)
{
    uint8_t irq = hal_irq_save();

    reply->is &= (uint8_t)~FDL_VALID;
    fdl_replan_isr(reply);
    hal_irq_restore(irq);
}

uint8_t fdl_reply_update(uint8_t ssap, const uint8_t XDATA *lsdu, uint8_t len, uint8_t how)
{
    struct fdl_sap PAGED *row;
    uint8_t irq;

    if (!number_is_valid(ssap) || (how & ~(FDL_UPDATE_HIGH | FDL_UPDATE_SINGLE)))
        return FDL_L_IV;
    irq = hal_irq_save();
    row = fdl_sap_row_isr(ssap);
    hal_irq_restore(irq);
    if (!row->services || !row->reply)
        return FDL_L_LS;
    if (len > row->reply->max)
        return FDL_L_LR;
    fdl_reply_write(row->reply, lsdu, len, how);
    return FDL_L_OK;
}

/* ---- Ident and LSAP status ------------------------------------------------------------------------------- */

void fdl_set_ident(const uint8_t XDATA *data, uint8_t len)
{
    fdl_reply_write(&ident, data, len < IDENT_MAX ? len : IDENT_MAX, FDL_UPDATE_LOW);
}

struct fdl_reply PAGED *fdl_ident_reply_isr(void) IN_ISR
{
    return &ident;
}

/* Service_type in the low half, Role_in_service in the high half: responder, or not activated. The two nibbles'
 * values: our choice where the clause could not be read; role 1 = responder, 3 = not activated; types as numbered
 * there. */
#define ROLE_RESPONDER 0x10u
#define ROLE_NONE      0x30u
#define TYPE_SDA  0u
#define TYPE_SDN  1u
#define TYPE_SRD  3u
#define TYPE_CSRD 5u

/* Made where it will be sent from, anew for each request: nobody keeps it. */
uint8_t fdl_lsap_isr(void) IN_ISR
{
    const struct fdl_sap PAGED *row = fdl_row_of[fdl_req.dsap];
    const uint8_t access = row->access;
    const uint8_t services = row->services;
    const uint8_t sda = services & FDL_SDA ? ROLE_RESPONDER | TYPE_SDA : ROLE_NONE | TYPE_SDA;
    const uint8_t sdn = services & FDL_SDN ? ROLE_RESPONDER | TYPE_SDN : ROLE_NONE | TYPE_SDN;
    const uint8_t srd = services & FDL_SRD ? ROLE_RESPONDER | TYPE_SRD : ROLE_NONE | TYPE_SRD;
    const uint8_t csrd = (uint8_t)(srd + (TYPE_CSRD - TYPE_SRD));

    if (!services)
        return FDL_RS;
    lsap_octets[1] = (uint8_t)(access + sda + sdn + srd + csrd);
    lsap_octets[FDL_ROOM_HEAD] = access;
    lsap_octets[FDL_ROOM_HEAD + 1u] = 0;
    lsap_octets[FDL_ROOM_HEAD + 2u] = sda;
    lsap_octets[FDL_ROOM_HEAD + 3u] = sdn;
    lsap_octets[FDL_ROOM_HEAD + 4u] = srd;
    lsap_octets[FDL_ROOM_HEAD + 5u] = csrd;
    return FDL_OK;
}

void fdl_tx_lsap_isr(void) IN_ISR
{
    const uint8_t head = (uint8_t)(fdl_header.len - fdl_req.len);

    lsap.head = 0;
    phy_tx.at = lsap_octets + (uint8_t)(FDL_ROOM_HEAD - 4u - head);
    phy_tx.len = (uint8_t)(head + LSAP_LEN + 6u);
    fdl_tx_frame_isr(&lsap);
}
