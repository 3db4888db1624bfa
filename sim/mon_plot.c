/* --plot: the last bus cycles as a timing picture, and a histogram of T_SDR, as one SVG. */
#include "sim/mon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH     1100.0
#define LEFT      90.0
#define RIGHT     30.0
#define LANE      30.0
#define CYCLES    3u
#define SHOWN_MAX 1200u
#define BINS      48u
#define HISTOGRAM 190.0
#define LANES_MAX 24u

enum kind { OUT, IN, ACK, DIAG, OTHER, TOKEN, WRONG_, KINDS };
static const struct {
    const char *color, *name;
} kinds[KINDS] = {
    {"#2f6db3", "Data Exchange request"},
    {"#3a9d5d", "Data Exchange answer"},
    {"#8cc63f", "short acknowledge"},
    {"#e08e1b", "diagnosis"},
    {"#7d8590", "other"},
    {"#8e5bb5", "token"},
    {"#d03535", "wrong telegram"},
};

static struct shown {
    uint64_t start, end;
    uint8_t by; /* who sends; 128: nobody knows */
    enum kind kind;
    uint8_t exchange_with; /* a Data_Exchange request to this station; 255: none */
    bool asks;             /* a request or a token: a master's */
} * frames;
static size_t frames_n, frames_room;
static double *t_sdr;
static size_t t_sdr_n, t_sdr_room;

static void *room_for(void *list, size_t n, size_t *room, size_t size)
{
    if (n < *room)
        return list;
    *room = *room ? 2 * *room : 256;
    list = realloc(list, *room * size);
    if (!list)
        abort();
    return list;
}

static void classify(const struct mon_frame *f, struct shown *s)
{
    const struct tg *const t = f->answer && f->paired ? &f->asked : &f->tg;
    s->kind = OTHER;
    s->by = f->good ? f->tg.sa : 128;
    if (f->good && f->tg.sd == TG_SC)
        s->by = f->paired ? f->asked.da : 128;
    s->asks = f->good && !f->answer;
    if (!f->good) {
        s->kind = WRONG_;
    } else if (f->tg.sd == TG_SD4) {
        s->kind = TOKEN;
    } else if (f->tg.sd == TG_SC) {
        s->kind = ACK;
    } else if ((t->fc & TG_REQUEST) && (t->fc & 15) >= TG_SRD_L && (t->fc & 15) <= TG_SRD_H) {
        s->kind = t->dsap == 60 ? DIAG : t->dsap != TG_NO_SAP ? OTHER : f->answer ? IN : OUT;
        if (s->kind == OUT && !f->retry)
            s->exchange_with = f->tg.da;
    }
}

void mon_plot_frame(const struct mon_frame *f)
{
    frames = room_for(frames, frames_n, &frames_room, sizeof *frames);
    frames[frames_n] = (struct shown){f->start, f->end, 128, OTHER, 255, false};
    if (mon.protocol == MON_DP)
        classify(f, &frames[frames_n]);
    frames_n++;
    if (!f->timed)
        return;
    t_sdr = room_for(t_sdr, t_sdr_n, &t_sdr_room, sizeof *t_sdr);
    t_sdr[t_sdr_n++] = mon_tbit(f->t_sdr);
}

/* ---- what to show ---------------------------------------------------------------------------------------- */

/* The last CYCLES cycles: from one Data_Exchange with the first station to the next. All of it when there are none. */
static void window(size_t *from, size_t *to, double *cycle_ms)
{
    size_t found = 0, last = frames_n;
    uint8_t first_station = 255;
    *from = frames_n > 60 ? frames_n - 60 : 0;
    *to = frames_n;
    *cycle_ms = 0;
    for (size_t i = 0; i < frames_n && first_station == 255; i++)
        first_station = frames[i].exchange_with;
    for (size_t i = frames_n;
         i-- > 0 && first_station != 255 && found <= CYCLES && frames_n - i < SHOWN_MAX;) {
        if (frames[i].exchange_with != first_station)
            continue;
        if (found++ == 0) {
            last = i;
            continue;
        }
        *from = i;
        *to = last;
        *cycle_ms = (double)(frames[last].start - frames[i].start) / 1e6 / (double)(found - 1);
    }
}

static unsigned lanes(size_t from, size_t to, uint8_t lane_of[129], uint8_t station_of[LANES_MAX])
{
    bool seen[129] = {false};
    unsigned n = 0;
    memset(lane_of, 255, 129);
    for (size_t i = from; i < to; i++)
        seen[frames[i].by] = true;
    for (unsigned s = 0; s < 129 && n < LANES_MAX; s++)
        if (seen[s]) {
            station_of[n] = (uint8_t)s;
            lane_of[s] = (uint8_t)n++;
        }
    return n;
}

static bool is_master(size_t from, size_t to, uint8_t station)
{
    for (size_t i = from; i < to; i++)
        if (frames[i].by == station && frames[i].asks)
            return true;
    return false;
}

/* 1, 2 or 5 times a power of ten, so that about ten steps fill the span. */
static double step_of(double span)
{
    const double power = pow(10, floor(log10(span / 10)));
    const double f = span / 10 / power;
    return (f <= 1 ? 1 : f <= 2 ? 2 : f <= 5 ? 5 : 10) * power;
}

static void text(FILE *to, double x, double y, const char *anchor, const char *what)
{
    fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">%s</text>\n", x, y, anchor, what);
}

static void axis(FILE *to, double y, double span, const char *unit)
{
    char label[48];
    const double step = step_of(span), scale = (WIDTH - LEFT - RIGHT) / span;
    for (double v = 0; v <= span * 1.0001; v += step) {
        const double x = LEFT + v * scale;
        fprintf(to, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#888\"/>\n", x, y, x,
                y + 4);
        snprintf(label, sizeof label, "%g%s", v, v == 0 ? unit : "");
        text(to, x, y + 17, "middle", label);
    }
}

static void legend(FILE *to, double y, const bool used[KINDS])
{
    double x = LEFT;
    for (unsigned k = 0; k < KINDS; k++) {
        if (!used[k])
            continue;
        fprintf(to, "<rect x=\"%.1f\" y=\"%.1f\" width=\"11\" height=\"11\" fill=\"%s\"/>\n", x, y - 10,
                kinds[k].color);
        text(to, x + 16, y, "start", kinds[k].name);
        x += 32 + 6.6 * (double)strlen(kinds[k].name);
    }
}

struct picture {
    size_t from, until; /* frames */
    uint8_t lane_of[129], station_of[LANES_MAX];
    unsigned lanes;
    double y, ms; /* top of the lanes; time across */
};

static void lane_names(FILE *to, const struct picture *p)
{
    char label[32];
    for (unsigned i = 0; i < p->lanes; i++) {
        const uint8_t station = p->station_of[i];
        fprintf(to, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"/>\n", LEFT,
                p->y + i * LANE, WIDTH - LEFT - RIGHT, LANE, i % 2 ? "#ffffff" : "#f2f4f7");
        if (station == 128)
            snprintf(label, sizeof label, "unknown");
        else
            snprintf(label, sizeof label, is_master(p->from, p->until, station) ? "master %u" : "station %u",
                     station);
        text(to, LEFT - 8, p->y + i * LANE + LANE / 2 + 4, "end", label);
    }
}

static void bars(FILE *to, const struct picture *p, bool used[KINDS])
{
    const double scale = (WIDTH - LEFT - RIGHT) / p->ms;
    for (size_t i = p->from; i < p->until; i++) {
        const struct shown *const f = &frames[i];
        const double x = LEFT + (double)(f->start - frames[p->from].start) / 1e6 * scale;
        const double w = (double)(f->end - f->start) / 1e6 * scale;
        if (p->lane_of[f->by] == 255)
            continue;
        used[f->kind] = true;
        fprintf(to, "<rect x=\"%.2f\" y=\"%.1f\" width=\"%.2f\" height=\"%.1f\" fill=\"%s\"/>\n", x,
                p->y + p->lane_of[f->by] * LANE + 6, w < 0.6 ? 0.6 : w, LANE - 12, kinds[f->kind].color);
    }
}

/* -> the y below it. */
static double timing(FILE *to, double y)
{
    struct picture p;
    double cycle_ms;
    char label[120];
    bool used[KINDS] = {false};
    window(&p.from, &p.until, &cycle_ms);
    p.lanes = lanes(p.from, p.until, p.lane_of, p.station_of);
    p.y = y + 16;
    p.ms = (double)(frames[p.until - 1].end - frames[p.from].start) / 1e6;
    if (p.ms <= 0) /* one telegram that takes no time */
        p.ms = 1;
    const unsigned known = p.lanes && p.station_of[p.lanes - 1] == 128 ? p.lanes - 1 : p.lanes;
    if (cycle_ms > 0)
        snprintf(label, sizeof label, "The last bus cycles: %.3f ms each, %u stations, %g kbit/s", cycle_ms,
                 known, mon.rate / 1e3);
    else
        snprintf(label, sizeof label, "The last telegrams: %u stations, %g kbit/s", known, mon.rate / 1e3);
    fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"15\" font-weight=\"bold\">%s</text>\n", LEFT, y,
            label);
    lane_names(to, &p);
    bars(to, &p, used);
    y = p.y + p.lanes * LANE;
    axis(to, y, p.ms, " ms");
    legend(to, y + 42, used);
    return y + 42;
}

/* ---- histogram --------------------------------------------------------------------------------------------- */

static void mark(FILE *to, double x, double top, double bottom, const char *name)
{
    fprintf(to,
            "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#d03535\" stroke-dasharray=\"4 "
            "3\"/>\n",
            x, top, x, bottom);
    text(to, x + 4, top + 10, "start", name);
}

static unsigned max_t_sdr(void)
{
    const struct {
        uint32_t rate;
        unsigned tbit;
    } steps[] = {{187500, 60},   {500000, 100},  {1500000, 150},
                 {3000000, 250}, {6000000, 450}, {12000000, 800}};
    for (unsigned i = 0; i < sizeof steps / sizeof steps[0]; i++)
        if (mon.rate <= steps[i].rate)
            return steps[i].tbit;
    return 800;
}

static void histogram(FILE *to, double y)
{
    unsigned bins[BINS] = {0}, most = 1;
    char label[80];
    double span = max_t_sdr() * 1.1;
    for (size_t i = 0; i < t_sdr_n; i++)
        if (t_sdr[i] > span)
            span = t_sdr[i];
    /* whole bit times wide, with an edge at min_T_SDR: half a bit time below 11 still rounds to it */
    const double step = ceil(span / (BINS - 1)), first = fmod(11, step) - step - 0.5;
    for (size_t i = 0; i < t_sdr_n; i++) {
        unsigned *const bin = &bins[(unsigned)((t_sdr[i] - first) / step)];
        if (++*bin > most)
            most = *bin;
    }
    span = first + BINS * step;
    const double scale = (WIDTH - LEFT - RIGHT) / span, width = step * scale;
    snprintf(label, sizeof label, "T_SDR of %lu answers [T_bit]", (unsigned long)t_sdr_n);
    fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" font-size=\"15\" font-weight=\"bold\">%s</text>\n", LEFT, y,
            label);
    const double top = y + 16, bottom = top + HISTOGRAM;
    fprintf(to, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#888\"/>\n", LEFT, bottom,
            WIDTH - RIGHT, bottom);
    for (unsigned i = 0; i < BINS; i++) {
        const double h = (HISTOGRAM - 40) * bins[i] / most, x = LEFT + (first + i * step) * scale;
        if (!bins[i])
            continue;
        fprintf(to, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#3a9d5d\"/>\n", x + 1,
                bottom - h, width - 2, h);
        snprintf(label, sizeof label, "%u", bins[i]);
        text(to, x + width / 2, bottom - h - 4, "middle", label);
    }
    snprintf(label, sizeof label, "max_T_SDR %u", max_t_sdr());
    mark(to, LEFT + 10.5 * scale, top, bottom, "min_T_SDR 11");
    mark(to, LEFT + (max_t_sdr() + 0.5) * scale, top, bottom, label);
    axis(to, bottom, span, "");
}

bool mon_plot_write(const char *path)
{
    FILE *const to = fopen(path, "w");
    char body[32];
    size_t from, until;
    double unused;
    uint8_t lane_of[129], station_of[LANES_MAX];
    if (!to)
        return false;
    window(&from, &until, &unused);
    const unsigned n = frames_n ? lanes(from, until, lane_of, station_of) : 0;
    snprintf(body, sizeof body, "%.0f", 40 + 16 + n * LANE + 42 + 50 + 16 + HISTOGRAM + 34);
    fprintf(
        to,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%s\" font-family=\"sans-serif\" "
        "font-size=\"12\" fill=\"#222\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n",
        WIDTH, body);
    if (frames_n)
        histogram(to, timing(to, 30) + 46);
    else
        text(to, LEFT, 40, "start", "no telegrams");
    fprintf(to, "</svg>\n");
    return fclose(to) == 0;
}
