/* --summary: what each station did. */
#include "sim/mon.h"

#include <stdlib.h>
#include <string.h>

struct span_list {
    uint64_t *ns;
    size_t n, room;
};

static struct {
    unsigned long requests, answers, retries, unanswered, refused, acknowledged;
    struct span_list t_sdr, cycle;
    uint64_t last_exchange;
    bool exchanged;
} stations[128];
static unsigned long telegrams, wrong, tokens, no_syn;
static uint64_t first, last, busy;

static void add(struct span_list *l, uint64_t ns)
{
    if (l->n == l->room) {
        l->room = l->room ? 2 * l->room : 64;
        l->ns = realloc(l->ns, l->room * sizeof l->ns[0]);
        if (!l->ns)
            abort();
    }
    l->ns[l->n++] = ns;
}

/* Asked and not answered: told by the next request, or the end. */
static int waiting_for = -1;

static void request(const struct mon_frame *f)
{
    const unsigned to = f->tg.da & 127;
    const uint8_t function = f->tg.fc & 15;
    if (waiting_for >= 0)
        stations[waiting_for].unanswered++;
    waiting_for = tg_wants_answer(&f->tg) ? (int)to : -1;
    if (f->seq && !mon.untimed && mon.protocol == MON_DP && mon_tbit(f->idle) < 33 - 0.5)
        no_syn++;
    stations[to].requests++;
    stations[to].retries += f->retry;
    if ((function != TG_SRD_H && function != TG_SRD_L) || f->tg.dsap != TG_NO_SAP || f->retry)
        return;
    if (stations[to].exchanged)
        add(&stations[to].cycle, f->start - stations[to].last_exchange);
    stations[to].exchanged = true;
    stations[to].last_exchange = f->start;
}

static void answer(const struct mon_frame *f)
{
    const uint8_t function = f->tg.fc & 15;
    if (!f->paired)
        return;
    const unsigned from = f->asked.da & 127;
    waiting_for = -1;
    stations[from].answers++;
    stations[from].acknowledged += f->tg.sd == TG_SC;
    stations[from].refused +=
        f->tg.sd != TG_SC && (function == TG_UE || function == TG_RR || function == TG_RS);
    if (f->timed)
        add(&stations[from].t_sdr, f->t_sdr);
}

void mon_stats_frame(const struct mon_frame *f)
{
    if (telegrams++ == 0)
        first = f->start;
    last = f->end;
    busy += f->end - f->start;
    wrong += !f->good;
    if (!f->good || (mon.protocol != MON_DP && mon.protocol != MON_PA))
        return;
    if (f->tg.sd == TG_SD4)
        tokens++;
    else if (f->answer)
        answer(f);
    else
        request(f);
}

static int by_size(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* min / median / max; the list gets sorted. */
static void spread(FILE *to, struct span_list *l, double unit)
{
    if (l->n == 0) {
        fprintf(to, " %23s", "-");
        return;
    }
    qsort(l->ns, l->n, sizeof l->ns[0], by_size);
    fprintf(to, " %7.*f/%7.*f/%7.*f", unit > 1 ? 2 : 0, (double)l->ns[0] / unit, unit > 1 ? 2 : 0,
            (double)l->ns[l->n / 2] / unit, unit > 1 ? 2 : 0, (double)l->ns[l->n - 1] / unit);
}

void mon_stats_print(FILE *to)
{
    const double bit = 1e9 / mon.rate;
    if (waiting_for >= 0)
        stations[waiting_for].unanswered++, waiting_for = -1;
    const double seconds = (double)(last - first) / 1e9;
    fprintf(to, "%lu telegrams in %.6f s at %u bit/s", telegrams, seconds, mon.rate);
    if (mon.untimed)
        fprintf(to, " (times are a computer's)");
    else
        fprintf(to, ", line busy %.1f %%, %lu requests without T_SYN",
                seconds > 0 ? (double)busy / seconds / 1e7 : 0, no_syn);
    fprintf(to, "; %lu wrong, %lu tokens\n", wrong, tokens);
    if (mon.protocol != MON_DP && mon.protocol != MON_PA)
        return;
    fprintf(to, "station requests answers   E5 refused retries no-answer  T_SDR min/median/max [T_bit]  "
                "cycle min/median/max [ms]\n");
    for (unsigned i = 0; i < 128; i++) {
        if (!stations[i].requests)
            continue;
        if (i == 127)
            fprintf(to, "    all");
        else
            fprintf(to, "%7u", i);
        fprintf(to, " %8lu %7lu %4lu %7lu %7lu %9lu     ", stations[i].requests, stations[i].answers,
                stations[i].acknowledged, stations[i].refused, stations[i].retries, stations[i].unanswered);
        spread(to, &stations[i].t_sdr, bit);
        fprintf(to, "  ");
        spread(to, &stations[i].cycle, 1e6);
        fprintf(to, "\n");
    }
}
