#include "hdlc/hdlc_nrm.h"
#include "hal/hal.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_cmd.h"

/* Frames of the source document: a command and its answer. */
#define DOCUMENT_COMMAND 0x08u
#define DOCUMENT_ANSWER  0x09u

/* FRMR, last octet: why (ISO 13239 5.5.3.3). */
#define FRMR_W 0x01u /* undefined command             */
#define FRMR_X 0x02u /* has an information field it may not have (with W) */
#define FRMR_Y 0x04u /* information field too long    */
#define FRMR_Z 0x08u /* invalid N(R)                  */
#define FRMR_OCTETS 3u

#define A_C 2u /* octets before the information field */

struct hdlc_nrm_counters XDATA hdlc_nrm_counters;

/* Two slots for our I-frames: one unacknowledged, one for the answer to the I-frame that may come meanwhile.
 * Invariants: vs, vr 0..7; waiting <= OUT_SLOTS; unacked: out[first] was sent with N(S) = V(S)-1, so waiting >= 1. */
#define OUT_SLOTS 2u
static struct {
    uint8_t state, address;
    uint8_t vs, vr;
    bool unacked;
    bool busy;      /* the application is                        */
    bool peer_busy; /* the primary is: RNR                       */
    bool rejected;  /* our REJ is not cleared yet: no second one */
    uint8_t first, waiting;
    uint16_t inactive_ms, heard;
} nrm;

static struct {
    uint8_t n;
    uint8_t info[HDLC_INFO_MAX];
} XDATA out[OUT_SLOTS];
static uint8_t XDATA frmr[FRMR_OCTETS];
static uint8_t XDATA identification[HDLC_XID_MAX];

/* The command being processed. n > HDLC_INFO_MAX: longer than what is there. */
static struct {
    uint8_t control, kind;
    bool poll;
    const uint8_t XDATA *info;
    uint8_t n;
} cmd;

/* The only writer of the state. */
static void set_state(uint8_t state)
{
    ASSERT(state != HDLC_FRJ || nrm.state == HDLC_NRM);
    if (nrm.state == state)
        return;
    nrm.state = state;
    hdlc_state_ind(state);
}

/* ---- answers: one frame, F = 1, our own address (ISO 13239 6.4.2) -------------------------------------- */

static void send(uint8_t control, const uint8_t XDATA *info, uint8_t n)
{
    uint8_t XDATA *to = hdlc_8273_out.octets;
    uint8_t left = n;

    *to++ = nrm.address;
    *to++ = control;
    for (; left; left--)
        *to++ = *info++;
    hdlc_nrm_counters.responses++;
    hdlc_8273_send((uint8_t)(A_C + n));
}

static void unnumbered(uint8_t control)
{
    send(control | HDLC_PF, NULL, 0);
}

static uint8_t numbered(uint8_t control)
{
    return (uint8_t)(control | HDLC_PF | (uint8_t)(nrm.vr << 5));
}

static void supervisory(uint8_t control)
{
    send(numbered(control), NULL, 0);
}

static bool ready(void)
{
    return !nrm.busy && nrm.waiting < OUT_SLOTS;
}

/* The stored I-frame again if the poll did not acknowledge it (checkpoint, ISO 13239 5.6.2.1), the next one, or how
 * ready we are. */
static void answer(void)
{
    if (nrm.waiting == 0 || nrm.peer_busy) {
        supervisory(ready() ? HDLC_C_RR : HDLC_C_RNR);
        return;
    }
    if (nrm.unacked)
        hdlc_nrm_counters.resent++;
    else
        nrm.vs = (nrm.vs + 1u) & 7u;
    nrm.unacked = true;
    send(numbered((uint8_t)(((nrm.vs - 1u) & 7u) << 1)), out[nrm.first].info, out[nrm.first].n);
}

/* ---- receiving N(R), I, and what must be rejected ------------------------------------------------------ */

static bool nr_is_valid(uint8_t nr)
{
    return nr == nrm.vs || (nrm.unacked && nr == ((nrm.vs - 1u) & 7u));
}

static void acknowledge(uint8_t nr)
{
    if (!nrm.unacked || nr != nrm.vs)
        return;
    nrm.unacked = false;
    nrm.first ^= 1u;
    nrm.waiting--;
}

/* Why the command must be answered FRMR, 0: it need not (ISO 13239 5.5.3.3). */
static uint8_t wrong(void)
{
    if (cmd.kind == HDLC_UNDEFINED)
        return FRMR_W;
    if (cmd.n && !hdlc_may_carry_info(cmd.kind))
        return FRMR_W | FRMR_X;
    if (cmd.n > HDLC_INFO_MAX)
        return FRMR_Y;
    if (hdlc_has_nr(cmd.kind) && !nr_is_valid(hdlc_nr(cmd.control)))
        return FRMR_Z;
    return 0;
}

/*   octet 1  rejected control field   2  V(R) C/R=0 (a command) V(S) 0   3  0 0 0 0 Z Y X W */
static void reject(uint8_t why)
{
    frmr[0] = cmd.control;
    frmr[1] = (uint8_t)((uint8_t)(nrm.vr << 5) | (uint8_t)(nrm.vs << 1));
    frmr[2] = why;
    hdlc_nrm_counters.rejected++;
    set_state(HDLC_FRJ);
    if (cmd.poll)
        send(HDLC_C_FRMR | HDLC_PF, frmr, FRMR_OCTETS);
}

/* N(S) is not V(R): not delivered. our choice: with window 1 the frame before is a duplicate whose answer was lost,
 * V(R) tells so; REJ, once, if it is another one, and there is nothing of ours to repeat. */
static void out_of_sequence(uint8_t ns)
{
    const bool duplicate = ns == ((nrm.vr - 1u) & 7u);

    hdlc_nrm_counters.sequence++;
    if (!cmd.poll)
        return;
    if (duplicate || nrm.unacked || nrm.rejected || !ready()) {
        answer();
        return;
    }
    nrm.rejected = true;
    supervisory(HDLC_C_REJ);
}

/* An I-frame that comes while we are not ready is not accepted: V(R) stays, the primary sends it again. */
static void information(void)
{
    const uint8_t ns = hdlc_ns(cmd.control);
    uint8_t slot;

    if (ns != nrm.vr) {
        out_of_sequence(ns);
        return;
    }
    if (ready()) {
        slot = (nrm.first + nrm.waiting) & 1u;
        nrm.vr = (nrm.vr + 1u) & 7u;
        nrm.rejected = false;
        hdlc_nrm_counters.delivered++;
        out[slot].n = hdlc_info_ind(cmd.info, cmd.n, out[slot].info);
        ASSERT(out[slot].n <= HDLC_INFO_MAX);
        if (out[slot].n)
            nrm.waiting++;
    }
    if (cmd.poll)
        answer();
}

/* ---- one function per state ---------------------------------------------------------------------------- */

/* SNRM and DISC where they are the same: NRM and frame reject. our choice: without P they are ignored, we could not
 * say that we obeyed. -> it was one of them. */
static bool mode_setting(void)
{
    if (cmd.n || (cmd.kind != HDLC_SNRM && cmd.kind != HDLC_DISC))
        return false;
    if (!cmd.poll)
        return true;
    nrm.vs = nrm.vr = 0;
    nrm.unacked = nrm.rejected = nrm.peer_busy = false;
    nrm.waiting = 0;
    set_state(cmd.kind == HDLC_SNRM ? HDLC_NRM : HDLC_NDM);
    unnumbered(HDLC_C_UA);
    return true;
}

static void document(void)
{
    const uint8_t n = cmd.n <= HDLC_INFO_MAX ? hdlc_document_ind(cmd.info, cmd.n, out[0].info) : 0;

    ASSERT(n <= HDLC_INFO_MAX);
    if (n)
        send(DOCUMENT_ANSWER, out[0].info, n);
    else
        hdlc_nrm_counters.unanswered++;
}

/* Any command but SNRM: DM if it polls, XID and TEST too. */
static void state_ndm(void)
{
    if (cmd.control == DOCUMENT_COMMAND)
        document();
    else if (cmd.kind == HDLC_SNRM && mode_setting())
        return;
    else if (cmd.poll)
        unnumbered(HDLC_C_DM);
    else
        hdlc_nrm_counters.unanswered++;
}

static void state_nrm(void)
{
    uint8_t why;

    if (mode_setting())
        return;
    why = wrong();
    if (why) {
        reject(why);
        return;
    }
    if (hdlc_has_nr(cmd.kind))
        acknowledge(hdlc_nr(cmd.control));
    switch (cmd.kind) {
    case HDLC_I:
        information();
        return;
    case HDLC_RR:
    case HDLC_REJ: /* with window 1 the checkpoint repeats all that REJ asks for */
        nrm.peer_busy = false;
        break;
    case HDLC_RNR:
        nrm.peer_busy = true;
        break;
    case HDLC_UI:
        hdlc_ui_ind(cmd.info, cmd.n);
        break;
    case HDLC_TEST:
        if (cmd.poll)
            send(HDLC_C_TEST | HDLC_PF, cmd.info, cmd.n);
        return;
    case HDLC_XID:
        if (cmd.poll)
            send(HDLC_C_XID | HDLC_PF, identification, hdlc_xid_ind(identification));
        return;
    default:
        return;
    }
    if (cmd.poll)
        answer();
}

/* The FRMR is repeated whenever we are polled, until SNRM or DISC. */
static void state_frj(void)
{
    if (mode_setting())
        return;
    if (cmd.poll)
        send(HDLC_C_FRMR | HDLC_PF, frmr, FRMR_OCTETS);
    else
        hdlc_nrm_counters.unanswered++;
}

/* ---- frames and time ----------------------------------------------------------------------------------- */

/* our choice: of the commands to a group only UI is carried out; nobody may answer, so nothing that needs an answer
 * makes sense. */
static void to_group(void)
{
    if (cmd.kind == HDLC_UI && nrm.state == HDLC_NRM && cmd.n <= HDLC_INFO_MAX)
        hdlc_ui_ind(cmd.info, cmd.n);
    else
        hdlc_nrm_counters.unanswered++;
}

static void command(const struct hdlc_frame XDATA *frame)
{
    hdlc_nrm_counters.commands++;
    cmd.control = frame->octets[1];
    cmd.kind = hdlc_kind(cmd.control);
    cmd.poll = (cmd.control & HDLC_PF) != 0;
    cmd.info = frame->octets + A_C;
    cmd.n = (uint8_t)(frame->n - A_C);
    if (frame->octets[0] != nrm.address) {
        to_group();
        return;
    }
    nrm.heard = hal_ticks();
    switch (nrm.state) {
    case HDLC_NDM:
        state_ndm();
        break;
    case HDLC_NRM:
        state_nrm();
        break;
    default:
        state_frj();
        break;
    }
}

static void watch_inactivity(void)
{
    if (nrm.state == HDLC_NDM || nrm.inactive_ms == 0)
        return;
    if ((uint16_t)(hal_ticks() - nrm.heard) < nrm.inactive_ms)
        return;
    hdlc_nrm_counters.inactive++;
    set_state(HDLC_NDM);
}

void hdlc_nrm_poll(void)
{
    const struct hdlc_frame XDATA *frame;

    hdlc_8273_poll();
    if (hdlc_8273_sending())
        return;
    frame = hdlc_8273_frame();
    if (frame) {
        command(frame);
        hdlc_8273_release();
    } else {
        watch_inactivity();
    }
}

static void clear_counters(void)
{
    hdlc_nrm_counters.commands = 0;
    hdlc_nrm_counters.responses = 0;
    hdlc_nrm_counters.delivered = 0;
    hdlc_nrm_counters.sequence = 0;
    hdlc_nrm_counters.resent = 0;
    hdlc_nrm_counters.rejected = 0;
    hdlc_nrm_counters.unanswered = 0;
    hdlc_nrm_counters.inactive = 0;
}

bool hdlc_nrm_init(uint8_t address, uint8_t group, uint8_t mode)
{
    nrm.state = HDLC_NDM;
    nrm.address = address;
    nrm.vs = nrm.vr = 0;
    nrm.first = nrm.waiting = 0;
    nrm.unacked = nrm.rejected = nrm.busy = nrm.peer_busy = false;
    nrm.inactive_ms = HDLC_INACTIVE_MS;
    clear_counters();
    return hdlc_8273_open(mode, address, group);
}

uint8_t hdlc_nrm_state(void)
{
    return nrm.state;
}

void hdlc_nrm_busy(bool busy)
{
    nrm.busy = busy;
}

void hdlc_nrm_inactivity(uint16_t limit_ms)
{
    ASSERT(limit_ms <= 60000u);
    nrm.inactive_ms = limit_ms;
}
