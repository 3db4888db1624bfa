/* What fieldling-master shows on a simulated segment, because it sees both ends of it: the telegrams with
 * their T_SDR, the station's state and counters, and the judge's verdict. */
#include "ddlm/ddlm.h"
#include "dp_sim.h"
#include "dp_words.h"
#include "phy_uart/phy_uart.h"
#include "sim/segment.h"

#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define SHOWN_FIRST 3u /* exchanges shown telegram by telegram */

static const struct dp_master *m;     /* NULL: nobody looks */
static const struct dp_slave *served; /* the station as the master knows it; NULL: it does not */
static bool telegrams;
static hv_time sdr_last, sdr_min = HV_NEVER, sdr_max;

static double t_bits(hv_time ticks)
{
    return (double)ticks / (double)m->ini.bit;
}

static unsigned exchanges(void)
{
    return served ? served->exchanges : 0;
}

/* ---- telegrams --------------------------------------------------------------------------------------- */

/* A line for each telegram; on a terminal no wider than it is. */
static void say_line(char *text)
{
    struct winsize size;

    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col != 0 && size.ws_col < strlen(text))
        text[size.ws_col] = '\0';
    master_make_room();
    puts(text);
}

static void show_telegram(const struct tg *t, const uint8_t *octets, unsigned n, hv_time start, bool answer)
{
    static uint8_t asked; /* FC of the last request */
    char hex[3u * TG_MAX + 1u] = "", words[120] = "fdl=invalid", sdr[24] = "", text[sizeof hex + 220u];
    const char *service = "invalid";
    int width = -1;

    for (unsigned i = 0; i < n; i++)
        sprintf(hex + 3u * i, "%02X ", octets[i]);
    if (t) {
        dp_fdl_words(t, words, sizeof words);
        service = dp_service(t, asked);
        if (t->fc & TG_REQUEST)
            asked = t->fc;
    }
    if (strcmp(service, "none") == 0) { /* FDL's own: the word behind "fdl=" */
        service = words + 4;
        width = (int)strcspn(service, " ");
    }
    if (answer)
        snprintf(sdr, sizeof sdr, " t_sdr=%.1f", t_bits(seg_said.t_sdr));
    snprintf(text, sizeof text, "%10.6f %s %-18.*s %-51s %s%s", (double)start / HV_S, answer ? "<-" : "->", width,
             service, hex, words, sdr);
    say_line(text);
}

/* The same request to the same station again is no news: the running Global_Control, an absent slave. */
static bool repeated(const struct tg *t, const uint8_t *octets, unsigned n)
{
    static uint8_t last[128][TG_MAX];
    static unsigned last_n[128];
    uint8_t da = t->da & 127;

    if (last_n[da] == n && memcmp(last[da], octets, n) == 0)
        return true;
    memcpy(last[da], octets, n);
    last_n[da] = n;
    return false;
}

void dp_sim_telegram(bool answer, hv_time start, const uint8_t *octets, unsigned n)
{
    struct tg t;
    bool good = tg_decode(octets, n, &t) == TG_GOOD;
    bool news, cyclic = good && t.sd != TG_SC && t.dsap == TG_NO_SAP && t.n > 0;

    if (!m)
        return;
    if (answer) {
        sdr_last = seg_said.t_sdr;
        sdr_min = sdr_last < sdr_min ? sdr_last : sdr_min;
        sdr_max = sdr_last > sdr_max ? sdr_last : sdr_max;
    }
    news = !good || answer || !repeated(&t, octets, n);
    if (telegrams && news && !(cyclic && exchanges() >= SHOWN_FIRST))
        show_telegram(good ? &t : NULL, octets, n, start, answer);
}

/* ---- state ------------------------------------------------------------------------------------------- */

static const char *with_judge(void)
{
    static char text[200] = "no rule of the line broken";
    const char *verdict = seg_verdict();

    if (verdict)
        snprintf(text, sizeof text, "%s", verdict);
    return text;
}

static unsigned violations(void)
{
    unsigned n = 0;

    for (unsigned rule = 0; rule < SEG_RULES; rule++)
        n += seg_count((enum seg_rule)rule);
    return n;
}

static unsigned errors(const struct fdl_counters *c)
{
    return (unsigned)c->parity + c->overrun + c->gap + c->format + c->checksum + c->sd_error_count;
}

/* Outputs as the station got them, inputs as the master got them. */
static void show_data(const struct ddlm_info *i)
{
    char inputs[40] = "not served";

    if (served)
        snprintf(inputs, sizeof inputs, "%u degrees, door %s", served->inputs[0],
                 served->inputs[1] ? "open  " : "closed");
    printf("%8.1f s  %-9s  outputs %02X %02X ->  <- %s  exchanges %-6u", (double)hv_now() / HV_S,
           dp_state_word(i->state), dp_sim.out[1], dp_sim.out[3], inputs, exchanges());
}

static void show_second(void)
{
    static struct ddlm_info i;
    static struct fdl_counters c;

    ddlm_read_info(&i);
    fdl_read_counters(&c);
    show_data(&i);
    printf(" T_SDR %.1f T_bit  errors %u\n", t_bits(sdr_last), errors(&c));
}

static void show_below(void)
{
    static struct ddlm_info i;
    static struct fdl_counters c;

    ddlm_read_info(&i);
    fdl_read_counters(&c);
    show_data(&i);
    printf("\n  slave    owner %u, groups %02X, watchdog %lu ms %s, sync %s, freeze %s, diagnosis %u octets\n",
           i.master, i.groups, (unsigned long)i.wd_ms, i.wd_on ? "on" : "off", i.sync_enabled ? "enabled" : "off",
           i.freeze_enabled ? "enabled" : "off", served ? served->diag_n : 0u);
    printf("  T_SDR    %.1f bit times (%.1f .. %.1f; allowed %u .. %u) at %lu bit/s on the virtual segment\n",
           t_bits(sdr_last), sdr_min == HV_NEVER ? 0.0 : t_bits(sdr_min), t_bits(sdr_max), i.min_t_sdr,
           seg_max_t_sdr(), (unsigned long)phy_bit_per_s(dp_sim.baud));
    printf("  errors   parity %u, gap %u, format %u, FCS %u, retries %u, lost %u; judge: %s\n", c.parity, c.gap,
           c.format, c.checksum, m->ini.resent, served ? served->lost : 0u, with_judge());
}

/* ---- begin and end ----------------------------------------------------------------------------------- */

static void begin(const struct dp_master *master, const struct master_options *o)
{
    m = master;
    telegrams = !o->json;
    for (unsigned i = 0; i < m->slaves_n; i++)
        if (m->slaves[i].address == dp_sim.address)
            served = &m->slaves[i];
    if (o->json)
        return;
    printf("DP-TEST01 (slave %u) and a DP master (%u) on a simulated RS-485 segment, %lu bit/s.\n"
           "Virtual time, paced to real time: T_SDR (in bit times) and all times are the segment's.\n\n",
           dp_sim.address, m->ini.address, (unsigned long)phy_bit_per_s(dp_sim.baud));
    fflush(stdout);
}

static bool end(bool all, bool json)
{
    static struct fdl_counters c;
    const char *verdict = with_judge(); /* and a last look at the line */
    bool good = all && violations() == 0;
    double shortest = sdr_min == HV_NEVER ? 0.0 : t_bits(sdr_min);

    fdl_read_counters(&c);
    if (json) {
        say_begin(true);
        say_text("t_sdr_min", "%.1f", shortest);
        say_text("t_sdr_max", "%.1f", t_bits(sdr_max));
        say_number("line_errors", errors(&c));
        say_number("rules_broken", violations());
        say_end();
        return good;
    }
    if (violations())
        printf("\njudge: %s\n", verdict);
    printf("\n%s: %u exchanges in %.1f s, T_SDR %.1f .. %.1f bit times, %u line errors, %u retries, %u "
           "answers lost, "
           "%u rules of the line broken%s\n",
           good ? "ok" : "FAILED", exchanges(), (double)hv_now() / HV_S, shortest, t_bits(sdr_max),
           errors(&c), m->ini.resent, served ? served->lost : 0u, violations(),
           all ? "" : "; data exchange was not reached");
    return good;
}

const struct ml_view dp_sim_view = {4, begin, show_below, show_second, end};
