#include "sim/hdlc_primary.h"

#include <string.h>

/* Control octets with P/F = 1 (ISO 13239 5.3). */
#define P_SNRM 0x93u
#define P_DISC 0x53u
#define P_RR   0x11u
#define F_UA   0x73u
#define F_DM   0x1Fu
#define F_FRMR 0x97u
#define N_R    0x20u
#define P_F    0x10u
#define N_S    0x02u
#define DOC_COMMAND 0x08u
#define DOC_ANSWER  0x09u

#define BUSY_MS 100u /* our choice: a module that is not ready is asked again after so long */

#define REQUEST_DATA 0x01u
#define CONTROL      0x02u
#define NEGATIVE     0x80u

unsigned hp_first_channel(enum hp_type type)
{
    return type == HP_AI || type == HP_AO ? 1 : 0;
}

unsigned hp_channels(enum hp_type type)
{
    return type == HP_AI || type == HP_AO ? 6 : 16;
}

void hp_init(struct hp *p)
{
    memset(p, 0, sizeof *p);
    p->timeout_ms = 250;
    p->retry_ms = 1000;
    p->misses_max = 3;
}

struct hp_module *hp_add(struct hp *p, const struct hp_module *configured)
{
    if (p->modules == HP_MODULES)
        return NULL;
    for (unsigned i = 0; i < p->modules; i++)
        if (p->module[i].address == configured->address)
            return NULL;
    struct hp_module *m = &p->module[p->modules++];
    *m = *configured;
    m->state = HP_OFFLINE;
    return m;
}

uint32_t hp_ask(struct hp *p, unsigned module, const uint8_t *info, unsigned n)
{
    if (p->queued == HP_QUEUE || n > HP_INFO || module >= p->modules)
        return 0;
    struct hp_request *r = &p->queue[(p->queue_at + p->queued++) % HP_QUEUE];
    r->id = ++p->last_id;
    r->module = (uint8_t)module;
    r->n = (uint8_t)n;
    memcpy(r->info, info, n);
    return r->id;
}

static void trouble(struct hp *p, struct hp_module *m, const char *what)
{
    if (p->trouble)
        p->trouble(p, m, what);
}

/* ---- what a request comes to ----------------------------------------------------------------------------- */

static void note_value(struct hp_module *m, const struct hp_request *r, const uint8_t *answer, unsigned n)
{
    const unsigned index = r->n > 1 ? r->info[1] - hp_first_channel(m->type) : HP_CHANNELS;
    const bool analog = hp_first_channel(m->type) == 1;
    if (index >= hp_channels(m->type) || (r->info[0] != REQUEST_DATA && r->info[0] != CONTROL))
        return;
    const uint16_t bit = (uint16_t)(1u << index);
    if (answer[0] & NEGATIVE) {
        m->error |= bit;
        return;
    }
    if (n != (analog ? 4u : 3u))
        return;
    m->value[index] = analog ? (uint16_t)(answer[2] << 8 | answer[3]) : answer[2] == 0x31;
    m->valid |= bit;
    m->error &= (uint16_t)~bit;
}

static void finish(struct hp *p, struct hp_module *m, enum hp_outcome outcome, const uint8_t *answer, unsigned n)
{
    const struct hp_request r = m->request;
    if (!m->has_request)
        return;
    m->has_request = m->sent = m->acked = false;
    if (outcome == HP_DONE) {
        note_value(m, &r, answer, n);
        if (answer[0] & NEGATIVE) {
            m->count.refused++;
            outcome = HP_REFUSED;
        }
    }
    if (p->done)
        p->done(p, m, &r, outcome, answer, n);
}

/* The answer belongs to the request: same function (or its negative), same channel. */
static bool fits(const struct hp_module *m, const uint8_t *answer, unsigned n)
{
    return m->has_request && n >= 2 && (answer[0] & 0x7Fu) == m->request.info[0] && answer[1] == m->request.info[1];
}

static void lost_connection(struct hp *p, struct hp_module *m)
{
    m->valid = m->error = 0;
    m->must_poll = false;
    finish(p, m, m->sent ? HP_UNKNOWN : HP_NOT_SENT, NULL, 0);
}

/* ---- sending ----------------------------------------------------------------------------------------------- */

static void command(struct hp *p, struct hp_module *m, uint8_t control, const uint8_t *info, unsigned n)
{
    uint8_t octets[2 + HP_INFO];
    octets[0] = m->address;
    octets[1] = control;
    if (n)
        memcpy(octets + 2, info, n);
    m->count.commands++;
    p->waiting = true;
    p->deadline_ms = p->now_ms + p->timeout_ms;
    p->send(p, octets, n + 2);
}

void hp_sent(struct hp *p, uint64_t now_ms)
{
    p->now_ms = now_ms;
    p->deadline_ms = now_ms + p->timeout_ms;
}

static void exchange(struct hp *p, struct hp_module *m, enum hp_exchange x)
{
    const struct hp_request *r = &m->request;
    p->exchange = x;
    switch (x) {
    case HP_X_SNRM:
        command(p, m, P_SNRM, NULL, 0);
        break;
    case HP_X_DISC:
        command(p, m, P_DISC, NULL, 0);
        break;
    case HP_X_RR:
        command(p, m, (uint8_t)(m->vr * N_R + P_RR), NULL, 0);
        break;
    case HP_X_I:
        m->count.repeats += m->sent;
        m->sent = true;
        command(p, m, (uint8_t)(m->vr * N_R + P_F + m->vs * N_S), r->info, r->n);
        break;
    case HP_X_DOCUMENT:
        m->sent = true;
        command(p, m, DOC_COMMAND, r->info, r->n);
        break;
    }
}

/* The module has the line: what is to be done next with it? */
static void take_turn(struct hp *p, struct hp_module *m)
{
    m->must_poll = m->leaving = false;
    if (m->document) {
        if (m->has_request)
            exchange(p, m, HP_X_DOCUMENT);
    } else if (m->state == HP_DISABLED) {
        exchange(p, m, HP_X_DISC);
    } else if (m->state == HP_OFFLINE) {
        exchange(p, m, HP_X_SNRM);
    } else {
        exchange(p, m, m->has_request && !m->acked ? HP_X_I : HP_X_RR);
    }
}

/* ---- receiving --------------------------------------------------------------------------------------------- */

static void answered(struct hp *p, struct hp_module *m)
{
    p->waiting = false;
    m->misses = 0;
    m->count.answers++;
    m->answered_ms = p->now_ms;
}

static void connected(struct hp_module *m)
{
    m->state = HP_ONLINE;
    m->vs = m->vr = 0;
    m->sent = m->acked = false;
    m->count.connects++;
}

static void disconnected(struct hp *p, struct hp_module *m, const char *why)
{
    trouble(p, m, why);
    if (m->state == HP_ONLINE)
        m->state = HP_OFFLINE;
    lost_connection(p, m);
    m->must_poll = m->state == HP_OFFLINE; /* connect again at once */
}

/* N(R) of an answer. V(S) counts when the acknowledgement comes. False: not a number we could have sent. */
static bool acknowledge(struct hp_module *m, uint8_t nr)
{
    if (m->has_request && m->sent && !m->acked && nr == ((m->vs + 1u) & 7u)) {
        m->acked = true;
        m->vs = nr;
    }
    return nr == m->vs;
}

static void information(struct hp *p, struct hp_module *m, uint8_t control, const uint8_t *info, unsigned n)
{
    if (((control >> 1) & 7u) != m->vr) { /* an old answer, late or doubled: the right one may still come */
        m->count.duplicates++;
        return;
    }
    answered(p, m);
    if (!acknowledge(m, control >> 5)) {
        disconnected(p, m, "N(R) out of range");
        return;
    }
    m->vr = (m->vr + 1u) & 7u;
    if (m->acked && fits(m, info, n))
        finish(p, m, HP_DONE, info, n);
    else
        m->count.strange++;
    m->must_poll = m->has_request;
}

static void supervisory(struct hp *p, struct hp_module *m, uint8_t control)
{
    const bool was_acked = m->acked;
    answered(p, m);
    m->count.rnr += (control & 0x0Cu) == 0x04u;
    m->count.rej += (control & 0x0Cu) == 0x08u;
    if (!acknowledge(m, control >> 5)) {
        disconnected(p, m, "N(R) out of range");
    } else if (m->has_request && m->acked && was_acked) {
        m->count.strange++; /* acknowledged, polled again, and still no answer: there is none */
        finish(p, m, HP_UNKNOWN, NULL, 0);
    } else {
        m->must_poll = m->has_request;
        if ((control & 0x0Cu) == 0x04u)
            m->again_ms = p->now_ms + BUSY_MS;
    }
}

static void unnumbered(struct hp *p, struct hp_module *m, uint8_t control)
{
    if (control == F_UA && p->exchange == HP_X_SNRM) {
        answered(p, m);
        connected(m);
        m->must_poll = m->has_request;
    } else if (control == F_UA && p->exchange == HP_X_DISC) {
        answered(p, m);
    } else if (control == F_DM) {
        answered(p, m);
        m->count.dm++;
        if (m->state == HP_ONLINE)
            disconnected(p, m, "has restarted (DM)");
    } else if (control == F_FRMR) {
        answered(p, m);
        m->count.frmr++;
        disconnected(p, m, "rejects a frame (FRMR)");
    } else {
        m->count.strange++; /* a late UA: the right answer may still come */
    }
}

static void document(struct hp *p, struct hp_module *m, const uint8_t *octets, unsigned n)
{
    if (octets[1] != DOC_ANSWER || !fits(m, octets + 2, n - 2)) {
        m->count.strange++;
        return;
    }
    answered(p, m);
    m->state = HP_ONLINE;
    finish(p, m, HP_DONE, octets + 2, n - 2);
}

void hp_frame(struct hp *p, const uint8_t *octets, unsigned n, uint64_t now_ms)
{
    struct hp_module *m = &p->module[p->turn];
    p->now_ms = now_ms;
    if (n < 2 || !p->waiting || octets[0] != m->address) { /* nobody was asked, or somebody else */
        for (unsigned i = 0; i < p->modules; i++)
            if (n >= 2 && p->module[i].address == octets[0])
                p->module[i].count.strange++;
        return;
    }
    const uint8_t control = octets[1];
    if (p->exchange == HP_X_DOCUMENT)
        document(p, m, octets, n);
    else if (!(control & P_F))
        m->count.strange++;
    else if ((control & 3u) == 3u)
        unnumbered(p, m, control);
    else if (p->exchange == HP_X_SNRM || p->exchange == HP_X_DISC)
        m->count.strange++; /* an answer to what was asked before the connection was reset */
    else if ((control & 1u) == 0)
        information(p, m, control, octets + 2, n - 2);
    else
        supervisory(p, m, control);
}

/* ---- whose turn it is ---------------------------------------------------------------------------------------- */

static void timed_out(struct hp *p)
{
    struct hp_module *m = &p->module[p->turn];
    p->waiting = false;
    m->count.timeouts++;
    if (m->state == HP_DISABLED)
        return;
    m->misses = (uint8_t)(m->misses + (m->misses < 255));
    trouble(p, m, "does not answer");
    if (m->document || m->misses >= p->misses_max) {
        m->state = HP_OFFLINE;
        lost_connection(p, m);
        m->next_channel = 0;
        m->due_ms = p->now_ms + p->retry_ms;
    } else {
        m->must_poll = true;
    }
}

static bool scans(const struct hp_module *m)
{
    return m->type == HP_DI || m->type == HP_AI;
}

/* The next channel of a scan becomes the module's request. False: the scan is over. */
static bool next_channel(struct hp_module *m)
{
    while (m->next_channel < hp_channels(m->type)) {
        const unsigned index = m->next_channel++;
        if (!(m->channels & (1u << index)))
            continue;
        m->request = (struct hp_request){.n = 2, .info = {REQUEST_DATA, (uint8_t)(index + hp_first_channel(m->type))}};
        m->has_request = true;
        m->sent = m->acked = false;
        return true;
    }
    return false;
}

/* Is the module due at p->now_ms, by itself? Prepares what it would be asked. */
static bool due(struct hp *p, struct hp_module *m)
{
    if (m->state == HP_DISABLED)
        return false;
    if (m->must_poll)
        return p->now_ms >= m->again_ms;
    if (m->next_channel == 0) {
        if (m->scan_ms == 0 || p->now_ms < m->due_ms || (m->document && !scans(m)))
            return false;
        m->due_ms = p->now_ms + m->scan_ms;
    }
    if (m->has_request || (m->state == HP_OFFLINE && !m->document))
        return true;
    if (scans(m) && next_channel(m))
        return true;
    if (!scans(m)) /* outputs are polled with RR: are they still there? */
        return true;
    m->next_channel = 0;
    return false;
}

/* The operator's oldest request goes to its module, if that has none. -> the module */
static struct hp_module *operators_turn(struct hp *p)
{
    if (p->queued == 0)
        return NULL;
    const struct hp_request *r = &p->queue[p->queue_at];
    struct hp_module *m = &p->module[r->module];
    if (m->has_request) /* one exchange after the other */
        return m->must_poll && p->now_ms >= m->again_ms ? m : NULL;
    m->request = *r;
    m->has_request = true;
    m->sent = m->acked = false;
    p->queue_at = (p->queue_at + 1u) % HP_QUEUE;
    p->queued--;
    if (m->state == HP_DISABLED) {
        finish(p, m, HP_NOT_SENT, NULL, 0);
        return NULL;
    }
    return m;
}

void hp_enable(struct hp *p, unsigned module, bool on)
{
    struct hp_module *m = &p->module[module];
    if (on == (m->state != HP_DISABLED))
        return;
    lost_connection(p, m);
    m->leaving = !on && m->state == HP_ONLINE && !m->document; /* DISC */
    m->state = on ? HP_OFFLINE : HP_DISABLED;
    m->next_channel = 0;
    m->due_ms = p->now_ms;
    m->misses = 0;
}

void hp_poll(struct hp *p, uint64_t now_ms)
{
    p->now_ms = now_ms;
    if (p->waiting && now_ms >= p->deadline_ms)
        timed_out(p);
    if (p->waiting || p->modules == 0)
        return;
    struct hp_module *m = operators_turn(p);
    for (unsigned i = 0; !m && i < p->modules; i++) {
        struct hp_module *next = &p->module[(p->turn + 1u + i) % p->modules];
        if (due(p, next) || next->leaving)
            m = next;
    }
    if (!m)
        return;
    p->turn = (unsigned)(m - p->module);
    take_turn(p, m);
}
