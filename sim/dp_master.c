#include "sim/dp_master.h"

#include <string.h>

#define PATIENCE 1000u /* diagnoses until a slave is ready, before the master starts over */

/* Slave_Diag octets 1 and 2 */
#define NOT_READY 0x02
#define FAULTS    0x54 /* Cfg_Fault, Prm_Fault, Not_Supported */
#define PRM_REQ   0x01

void dpm_begin(struct dp_master *m)
{
    ini_begin(&m->ini);
    m->has_token = true;
    m->doing = DP_NOTHING;
    m->at = 0;
    m->gap = m->gap_from;
    m->cycles = 0;
    m->cycle_start = m->cycle_time = 0;
    m->job = 0;
    memset(m->live, 0, sizeof m->live);
    for (unsigned i = 0; i < m->slaves_n; i++) {
        struct dp_slave *const s = &m->slaves[i];
        s->state = DP_ABSENT;
        s->want_diag = false;
        s->exchanges = s->diags = s->refusals = s->lost = s->starts = s->wrong = 0;
    }
}

void dpm_hear(struct dp_master *m, uint64_t now, uint8_t octet, uint8_t err)
{
    ini_hear(&m->ini, now, octet, err);
}

/* Waiting for the time of the next cycle, if a shortest one is asked for. */
static bool between_cycles(const struct dp_master *m)
{
    return m->shortest_cycle && m->cycles && m->at == 0 && m->part == 0;
}

uint64_t dpm_due(const struct dp_master *m)
{
    if (m->doing != DP_NOTHING)
        return ini_due(&m->ini);
    if (!m->has_token)
        return INI_NEVER;
    return between_cycles(m) ? m->cycle_start + m->shortest_cycle : 0;
}

void dpm_ask(struct dp_master *m, struct dp_job *job)
{
    job->state = DP_JOB_WAITS;
    m->job = job;
}

bool dpm_asking(const struct dp_master *m)
{
    return m->job != 0;
}

/* ---- one slave ---------------------------------------------------------------------------------------- */

static void ask_slave(struct dp_master *m, uint64_t now, struct dp_slave *s)
{
    struct tg t;
    m->turn = s;
    m->diag_turn = s->state == DP_DIAG1 || s->state == DP_DIAG2 || s->want_diag;
    if (m->diag_turn) {
        dpq_diag(&t, s->address);
    } else if (s->state == DP_ABSENT) {
        dpq_status(&t, s->address);
    } else if (s->state == DP_PRM) {
        dpq_set_prm(&t, s);
    } else if (s->state == DP_CFG) {
        dpq_chk_cfg(&t, s);
    } else {
        if (m->before)
            m->before(m, s);
        dpq_sap(&t, s->address, TG_NO_SAP, s->outputs, s->out_n);
        t.ssap = TG_NO_SAP;
    }
    ini_ask(&m->ini, now, &t);
}

static void judge_diag(struct dp_slave *s, const struct tg *a)
{
    if (a->dsap != 62 || a->ssap != 60 || a->n < 6) {
        s->wrong++;
        return;
    }
    memcpy(s->diag, a->data, a->n);
    s->diag_n = a->n;
    s->diags++;
    s->want_diag = false;
    const bool start_over = (s->diag[0] & FAULTS) || (s->diag[1] & PRM_REQ) || s->diag[3] == 255;
    if (s->state == DP_DIAG1) {
        s->state = DP_PRM;
    } else if (start_over) {
        s->state = DP_DIAG1;
    } else if (s->state == DP_DIAG2 && !(s->diag[0] & NOT_READY)) {
        s->state = DP_EXCHANGE;
        s->starts++;
    } else if (s->state == DP_DIAG2 && s->patience-- == 0) {
        s->state = DP_DIAG1;
    }
}

static void judge_exchange(struct dp_master *m, struct dp_slave *s, const struct tg *a)
{
    const uint8_t function = a->fc & 0x0F;
    const bool short_ack = a->sd == TG_SC;
    s->want_diag = !short_ack && function == TG_DH;
    if ((short_ack || (s->want_diag && a->n == 0)) && s->in_n == 0) {
        s->exchanges++;
    } else if (!short_ack && (function == TG_DL || function == TG_DH) && a->n == s->in_n) {
        memcpy(s->inputs, a->data, a->n);
        s->exchanges++;
    } else {
        s->wrong++;
        return;
    }
    if (m->after)
        m->after(m, s);
}

static void slave_answered(struct dp_master *m)
{
    struct dp_slave *const s = m->turn;
    const struct tg *const a = &m->ini.answer;
    const uint8_t function = a->fc & 0x0F;
    if (a->sd != TG_SC && (function == TG_RS || function == TG_RR || function == TG_UE)) {
        s->refusals++;
        s->want_diag = true;
        if (s->state == DP_PRM || s->state == DP_CFG)
            s->state = DP_DIAG1;
        return;
    }
    if (m->diag_turn) {
        judge_diag(s, a);
    } else if (s->state == DP_ABSENT) {
        s->state = DP_DIAG1;
    } else if (s->state == DP_PRM) {
        s->state = a->sd == TG_SC ? DP_CFG : DP_DIAG1;
    } else if (s->state == DP_CFG) {
        s->state = a->sd == TG_SC ? DP_DIAG2 : DP_DIAG1;
        s->patience = PATIENCE;
    } else {
        judge_exchange(m, s, a);
    }
}

/* ---- the cycle ---------------------------------------------------------------------------------------- */

static void settle(struct dp_master *m, bool answered)
{
    switch (m->doing) {
    case DP_SLAVE:
        if (answered) {
            slave_answered(m);
        } else {
            m->turn->lost++;
            m->turn->state = DP_ABSENT;
            m->turn->want_diag = false;
        }
        break;
    case DP_JOB:
        m->job->answer = m->ini.answer;
        m->job->state = answered ? DP_JOB_DONE : DP_JOB_LOST;
        m->job = 0;
        break;
    case DP_GAP:
        m->live[m->gap] = answered ? (uint8_t)(1 + (m->ini.answer.fc >> 4 & 3)) : 0;
        m->gap = m->gap >= m->gap_to ? m->gap_from : (uint8_t)(m->gap + 1);
        break;
    default: /* the ring passes the token by hand: a lost token is not what is tested here */
        m->has_token = m->ring == 0;
        if (m->ring)
            m->ring->has_token = true;
        break;
    }
    m->doing = DP_NOTHING;
}

/* After the slaves: a question, one address of the gap, the token. */
static void end_of_cycle(struct dp_master *m, uint64_t now)
{
    const uint8_t token[3] = {TG_SD4, m->ring ? m->ring->ini.address : m->ini.address, m->ini.address};
    struct tg t;
    switch (m->part++) {
    case 0:
        if (m->job) {
            m->doing = DP_JOB;
            ini_ask(&m->ini, now, &m->job->request);
        }
        break;
    case 1:
        if (m->gap_to) {
            m->doing = DP_GAP;
            dpq_status(&t, m->gap);
            ini_ask(&m->ini, now, &t);
        }
        break;
    default:
        m->at = m->part = 0;
        m->cycles++;
        if (m->ring || m->token_to_itself) {
            m->doing = DP_TOKEN;
            ini_tell(&m->ini, now, token, sizeof token);
        }
        break;
    }
}

void dpm_poll(struct dp_master *m, uint64_t now)
{
    if (m->doing != DP_NOTHING) {
        const enum ini_event e = ini_poll(&m->ini, now);
        if (e == INI_BUSY)
            return;
        settle(m, e == INI_DONE);
    }
    for (unsigned i = 0; i < 4 && m->doing == DP_NOTHING && m->has_token; i++) {
        if (between_cycles(m) && now < m->cycle_start + m->shortest_cycle)
            return;
        if (m->at == 0 && m->part == 0) {
            m->cycle_time = now - m->cycle_start;
            m->cycle_start = now;
        }
        if (m->at < m->slaves_n) {
            m->doing = DP_SLAVE;
            ask_slave(m, now, &m->slaves[m->at++]);
        } else {
            end_of_cycle(m, now);
        }
    }
}
