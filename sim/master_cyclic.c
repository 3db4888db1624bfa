/* Class 1: brings slaves up, exchanges data in cycles, shows a table, takes commands. */
#include "sim/master.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define REFRESH (200u * (uint64_t)ML_MS)
#define SECOND  (1000u * (uint64_t)ML_MS)
#define REPEAT                                                                                               \
    (500u * (uint64_t)ML_MS) /* the running command (Operate, Clear) is sent again, as masters do */

volatile bool master_stop;

static struct master_line *line;
static const struct ml_view *view; /* NULL: the line shows nothing of its own */
static struct setup *setup;
static struct dp_master m;
static const struct master_options *opt;
static bool live, clear, input_ended;
static unsigned rows;

static uint64_t cycle_max; /* the longest bus cycle */

/* Global_Controls that wait for their turn. */
static struct dp_job jobs[8];
static unsigned jobs_first, jobs_n;

static const char *const state_words[] = {"absent",        "diagnosis",     "parameters",
                                          "configuration", "getting ready", "exchange"};

static void control(uint8_t command, uint8_t group)
{
    if (jobs_n == sizeof jobs / sizeof jobs[0])
        return;
    struct dp_job *const job = &jobs[(jobs_first + jobs_n++) % (sizeof jobs / sizeof jobs[0])];
    dpq_global_control(&job->request, 127, command, group);
}

static void next_job(void)
{
    if (jobs_n == 0 || dpm_asking(&m))
        return;
    dpm_ask(&m, &jobs[jobs_first]);
    jobs_first = (jobs_first + 1) % (sizeof jobs / sizeof jobs[0]);
    jobs_n--;
}

/* In Clear all outputs are 0 (spec A6); the set ones come back with Operate. */
static uint8_t kept[SETUP_SLAVES][DP_DATA_MAX];

static void set_outputs(struct dp_master *master, struct dp_slave *s)
{
    const size_t i = (size_t)(s - master->slaves);
    if (clear)
        memset(s->outputs, 0, sizeof s->outputs);
    else
        memcpy(s->outputs, kept[i], sizeof s->outputs);
    for (unsigned k = 0; opt->count && !clear && k < s->out_n; k++)
        s->outputs[k] = (uint8_t)(s->exchanges / 16 + k);
}

/* ---- commands on standard input ------------------------------------------------------------------------- */

static struct dp_slave *slave_named(const char *text, size_t *index)
{
    char *end;
    const unsigned long address = text ? strtoul(text, &end, 0) : 999;
    for (*index = 0; text && *end == '\0' && *index < m.slaves_n; ++*index)
        if (m.slaves[*index].address == address)
            return &m.slaves[*index];
    return NULL;
}

static void say(const char *text)
{
    fprintf(stderr, "fieldling-master: %s\n", text);
}

static void command_out(char **rest)
{
    size_t index;
    const struct dp_slave *const s = slave_named(strtok_r(NULL, " ", rest), &index);
    if (!s) {
        say("out SLAVE HEX...: no such slave");
        return;
    }
    const char *word;
    for (unsigned i = 0; (word = strtok_r(NULL, " ", rest)) != NULL && i < s->out_n; i++)
        kept[index][i] = (uint8_t)strtoul(word, NULL, 16);
}

static void command_diag(char **rest)
{
    size_t index;
    struct dp_slave *const s = slave_named(strtok_r(NULL, " ", rest), &index);
    if (s)
        s->want_diag = true;
    else
        say("diag SLAVE: no such slave");
}

static void command(char *text)
{
    static const struct {
        const char *word;
        uint8_t command;
    } controls[] = {{"sync", 0x20}, {"unsync", 0x10}, {"freeze", 0x08}, {"unfreeze", 0x04}};
    char *rest;
    const char *const word = strtok_r(text, " \t\r\n", &rest);
    if (!word)
        return;
    for (size_t i = 0; i < sizeof controls / sizeof controls[0]; i++)
        if (strcmp(word, controls[i].word) == 0) {
            const char *const group = strtok_r(NULL, " ", &rest);
            control((uint8_t)(controls[i].command | (clear ? 0x02 : 0)),
                    group ? (uint8_t)strtoul(group, NULL, 16) : 0);
            return;
        }
    if (strcmp(word, "quit") == 0)
        master_stop = true;
    else if (strcmp(word, "out") == 0)
        command_out(&rest);
    else if (strcmp(word, "diag") == 0)
        command_diag(&rest);
    else if (strcmp(word, "clear") == 0 || strcmp(word, "operate") == 0)
        clear = word[0] == 'c', control(clear ? 0x02 : 0, 0);
    else
        say("commands: out SLAVE HEX..., sync|unsync|freeze|unfreeze [GROUP], clear, operate, diag SLAVE, "
            "quit");
}

static void read_commands(void)
{
    static char text[1024];
    static size_t n;
    const ssize_t got = read(STDIN_FILENO, text + n, sizeof text - 1 - n);
    if (got <= 0) {
        input_ended = true;
        return;
    }
    if (master_interrupted(text + n, (size_t)got)) {
        putchar('\n'); /* behind the echo */
        master_stop = true;
        return;
    }
    n += (size_t)got;
    text[n] = '\0';
    char *end, *at = text;
    while ((end = strchr(at, '\n')) != NULL) {
        *end = '\0';
        rows += live && rows; /* the terminal echoed it */
        command(at);
        at = end + 1;
    }
    n = (size_t)(text + n - at) < sizeof text - 1 ? (size_t)(text + n - at) : 0;
    memmove(text, at, n);
}

/* ---- what is shown ---------------------------------------------------------------------------------------- */

static void hex(char *text, size_t size, const uint8_t *o, unsigned n)
{
    text[0] = '\0';
    for (unsigned i = 0; i < n && 3 * i + 6 < size; i++)
        snprintf(text + 3 * i, size - 3 * i, "%02X ", o[i]);
    if (3 * n + 6 >= size)
        snprintf(text + size - 6, 6, "...");
}

static double ms(uint64_t ticks)
{
    return (double)ticks / ML_MS;
}

#define WRAP_OFF "\033[?7l" /* the live table is as many lines as it has, on a narrow terminal, too */
#define WRAP_ON  "\033[?7h"

/* The live table is drawn over itself, so it must not be longer than the terminal. */
static unsigned rows_that_fit(void)
{
    struct winsize w;
    const unsigned others = 4u + (view ? view->lines : 0);
    if (!live || ioctl(STDOUT_FILENO, TIOCGWINSZ, &w) != 0 || w.ws_row < others + 2u)
        return m.slaves_n;
    return m.slaves_n < w.ws_row - others ? m.slaves_n : w.ws_row - others;
}

void master_make_room(void)
{
    if (rows)
        printf("\033[%uF\033[J", rows);
    rows = 0;
}

static void table(void)
{
    char outputs[26], inputs[26];
    printf("station %-16s state          exchanges   lost refused diags  outputs                   inputs\n",
           "model");
    const unsigned fit = rows_that_fit();
    for (unsigned i = 0; i < fit; i++) {
        const struct dp_slave *const s = &m.slaves[i];
        hex(outputs, sizeof outputs, s->outputs, s->out_n);
        hex(inputs, sizeof inputs, s->inputs, s->in_n);
        printf("%7u %-16.16s %-14s %9u %6u %7u %5u  %-25s %s\n", s->address, setup->model[i],
               state_words[s->state], s->exchanges, s->lost, s->refusals, s->diags, outputs, inputs);
    }
    if (fit < m.slaves_n)
        printf("(%u more) ", m.slaves_n - fit);
    printf("%s, cycle %.1f ms (longest %.1f), %u requests, %u retries; \"quit\" or Ctrl-C ends, \"help\" "
           "helps\n",
           clear ? "Clear" : "Operate", ms(m.cycle_time), ms(cycle_max), m.ini.sent, m.ini.resent);
    rows = fit + 2;
}

static void show_live(void)
{
    master_make_room();
    printf(WRAP_OFF);
    table();
    if (view) {
        view->below();
        rows += view->lines;
    }
    printf(WRAP_ON);
    fflush(stdout);
}

/* Without a terminal: a line when a slave changes its state, and when its inputs or its diagnosis change. */
static void show_changes(void)
{
    static enum dp_slave_state shown[SETUP_SLAVES];
    static uint8_t inputs[SETUP_SLAVES][DP_DATA_MAX], diag[SETUP_SLAVES][DP_DATA_MAX];
    for (unsigned i = 0; i < m.slaves_n; i++) {
        const struct dp_slave *const s = &m.slaves[i];
        char text[80];
        if (s->state != shown[i] && (s->state == DP_EXCHANGE || s->state == DP_ABSENT)) {
            printf("%10.3f station %u: %s\n", ms(ml_now(line)) / 1000, s->address, state_words[s->state]);
            shown[i] = s->state;
        }
        if (memcmp(s->inputs, inputs[i], s->in_n) != 0) {
            hex(text, sizeof text, s->inputs, s->in_n);
            printf("%10.3f station %u: inputs %s\n", ms(ml_now(line)) / 1000, s->address, text);
            memcpy(inputs[i], s->inputs, s->in_n);
        }
        if (memcmp(s->diag, diag[i], sizeof diag[i]) != 0) {
            hex(text, sizeof text, s->diag, s->diag_n);
            printf("%10.3f station %u: diagnosis %s\n", ms(ml_now(line)) / 1000, s->address, text);
            memcpy(diag[i], s->diag, sizeof diag[i]);
        }
    }
    fflush(stdout);
}

static void show(uint64_t now)
{
    static uint64_t shown;
    if (opt->json)
        return;
    if (!live && !view)
        show_changes();
    else if (now >= shown + (live ? REFRESH : SECOND))
        shown = now, live ? show_live() : view->second();
}

static int summary(void)
{
    bool all = true;
    char text[3 * DP_DATA_MAX + 8];
    for (unsigned i = 0; i < m.slaves_n; i++) {
        const struct dp_slave *const s = &m.slaves[i];
        all = all && s->exchanges > 0 && s->state == DP_EXCHANGE;
        if (!opt->json)
            continue;
        say_begin(true);
        say_number("station", s->address);
        say_text("model", "%s", setup->model[i]);
        say_text("ident", "0x%04X", s->ident);
        say_text("state", "%s", state_words[s->state]);
        say_number("exchanges", s->exchanges);
        say_number("starts", s->starts);
        say_number("lost", s->lost);
        say_number("refused", s->refusals);
        say_number("wrong", s->wrong);
        hex(text, sizeof text, s->inputs, s->in_n);
        say_octets("inputs", s->inputs, s->in_n);
        say_octets("outputs", s->outputs, s->out_n);
        say_octets("diagnosis", s->diag, s->diag_n);
        say_end();
    }
    if (opt->json) {
        say_begin(true);
        say_number("cycles", m.cycles);
        say_number("requests", m.ini.sent);
        say_number("retries", m.ini.resent);
        say_number("strange", m.ini.strange);
        say_text("longest_cycle_ms", "%.3f", ms(cycle_max));
        say_end();
    } else if (!live && !view) {
        table();
    }
    if (view)
        all = view->end(all, opt->json);
    return all ? M_OK : M_REFUSED;
}

/* ---- the cycle ---------------------------------------------------------------------------------------------- */

static void hear(void *of, uint64_t now, uint8_t octet)
{
    dpm_hear(of, now, octet, 0);
}

static void note_cycle(void)
{
    static unsigned seen;
    if (m.cycles == seen)
        return;
    seen = m.cycles;
    if (m.cycles > 1 && m.cycle_time > cycle_max)
        cycle_max = m.cycle_time;
}

static bool over(uint64_t now)
{
    return master_stop || (opt->cycles && m.cycles >= opt->cycles) ||
           (opt->seconds && now >= opt->seconds * SECOND);
}

int master_cyclic(struct master_line *l, struct setup *s, const struct ini *ini,
                  const struct master_options *o)
{
    uint64_t next_control = 0;
    line = l;
    view = l->kind->view;
    setup = s;
    opt = o;
    clear = o->clear;
    live = !o->json && isatty(STDOUT_FILENO);
    if (live)
        master_keys();
    m = (struct dp_master){.ini = *ini,
                           .slaves = s->slaves,
                           .slaves_n = s->slaves_n,
                           .before = set_outputs,
                           .shortest_cycle = o->cycle_ms * (uint64_t)ML_MS};
    for (unsigned i = 0; i < s->slaves_n; i++)
        memcpy(kept[i], s->slaves[i].outputs, sizeof kept[i]);
    dpm_begin(&m);
    if (view)
        view->begin(&m, o);
    for (uint64_t now = ml_now(l); !over(now); now = ml_now(l)) {
        if (now >= next_control) {
            next_control = now + REPEAT;
            control(clear ? 0x02 : 0x00, 0);
        }
        next_job();
        dpm_poll(&m, now);
        note_cycle();
        const int got = ml_wait(l, dpm_due(&m), input_ended ? -1 : STDIN_FILENO, hear, &m);
        if (got < 0) {
            say("the line has gone");
            summary();
            return M_LINE;
        }
        if (got == 2)
            read_commands();
        show(now);
    }
    return summary();
}
