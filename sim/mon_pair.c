/* Which answer belongs to which request, and how long it took. */
#include "sim/mon.h"

#include <string.h>

/* The last request that wants an answer, and per station the last one that counted (FCV). */
static struct {
    bool open;
    struct tg tg;
    uint64_t end;
} request;
static struct {
    unsigned n;
    uint8_t octets[TG_MAX];
} last_to[128];

static bool is_answer(const struct tg *t)
{
    return t->sd == TG_SC || (t->sd != TG_SD4 && !(t->fc & TG_REQUEST));
}

/* Octet-identical to the last one to that station, with FCV set, or right after no answer came. */
static bool is_retry(const struct mon_frame *f, bool unanswered)
{
    const unsigned to = f->tg.da & 127;
    const bool same = last_to[to].n == f->n && memcmp(last_to[to].octets, f->octets, f->n) == 0;
    const bool same_fcb_counts = (f->tg.fc & TG_FCV) != 0;
    return same && (same_fcb_counts || (unanswered && request.tg.da == f->tg.da));
}

static void pair_request(struct mon_frame *f)
{
    const unsigned to = f->tg.da & 127;
    f->retry = is_retry(f, request.open);
    request.open = tg_wants_answer(&f->tg);
    request.tg = f->tg;
    request.end = f->end;
    if (request.open) {
        last_to[to].n = f->n;
        memcpy(last_to[to].octets, f->octets, f->n);
    }
}

static void pair_answer(struct mon_frame *f)
{
    f->answer = true;
    f->paired =
        request.open && (f->tg.sd == TG_SC || (f->tg.sa == request.tg.da && f->tg.da == request.tg.sa));
    if (!f->paired)
        return;
    f->asked = request.tg;
    f->timed = f->start >= request.end;
    f->t_sdr = f->timed ? f->start - request.end : 0;
    request.open = false;
}

void mon_pair(struct mon_frame *f)
{
    if (f->good && (mon.protocol == MON_MODBUS_RTU || mon.protocol == MON_MODBUS_ASCII))
        mon_modbus_pair(f);
    if ((mon.protocol != MON_DP && mon.protocol != MON_PA) || !f->good)
        return; /* a damaged answer leaves the request open: it counts as unanswered */
    if (is_answer(&f->tg))
        pair_answer(f);
    else if (f->tg.sd == TG_SD4)
        request.open = false;
    else
        pair_request(f);
}
