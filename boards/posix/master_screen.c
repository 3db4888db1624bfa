#define NCURSES_NOMACROS
#include "master_screen.h"
#include "master_commands.h"
#include "master_config.h"

#include <ncurses.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define DRAW_MS   100u
#define LOG_LINES 64u
#define LOG_WIDTH 240u
#define KEY_ESC   27
#define KEY_EOT   4 /* Ctrl-D */

enum { COLOUR_GOOD = 1, COLOUR_BAD, COLOUR_DIM, COLOUR_HEAD };

static char log_lines[LOG_LINES][LOG_WIDTH];
static unsigned logged;
static char input[120];
static size_t input_n;

static void give_back(void)
{
    endwin();
}

const char *screen_open(void)
{
    if (!isatty(STDOUT_FILENO) || !isatty(STDIN_FILENO))
        return "standard input and output are no terminal: use --batch SECONDS";
    if (!newterm(NULL, stdout, stdin))
        return "the terminal is unknown (TERM): use --batch SECONDS";
    atexit(give_back);
    cbreak();
    noecho();
    start_color();
    use_default_colors();
    init_pair(COLOUR_GOOD, COLOR_GREEN, -1);
    init_pair(COLOUR_BAD, COLOR_RED, -1);
    init_pair(COLOUR_DIM, COLOR_CYAN, -1);
    init_pair(COLOUR_HEAD, COLOR_BLACK, COLOR_WHITE);
    return NULL;
}

void screen_log(const char *line)
{
    snprintf(log_lines[logged++ % LOG_LINES], LOG_WIDTH, "%s", line);
}

static void colour(int pair)
{
    attrset(COLOR_PAIR(pair));
}

static void draw_values(const struct hp_module *m)
{
    const bool analog = hp_first_channel(m->type) == 1;

    for (unsigned i = 0; i < hp_channels(m->type); i++) {
        const bool known = (m->valid >> i) & 1u, wrong = (m->error >> i) & 1u;
        if (wrong)
            colour(COLOUR_BAD);
        else if (!known)
            colour(COLOUR_DIM);
        else if (analog || m->value[i])
            attrset(A_BOLD);
        else
            attrset(A_NORMAL);
        if (analog)
            printw(wrong ? " !!!!" : known ? " %4u" : " ----", m->value[i]);
        else
            printw("%s%c", i == 8 ? " " : "", wrong ? '!' : !known ? '-' : m->value[i] ? '1' : '0');
    }
    attrset(A_NORMAL);
}

static void draw_module(int row, const struct hp_module *m, uint64_t now_ms)
{
    const struct hp_counters *c = &m->count;

    mvprintw(row, 0, "%-12.12s %3u  %s %s %6u ", m->name, m->address, master_type_word(m->type),
             m->document ? "doc" : "nrm", m->scan_ms);
    colour(m->state == HP_ONLINE ? COLOUR_GOOD : m->state == HP_OFFLINE ? COLOUR_BAD : COLOUR_DIM);
    printw("%-8s ", state_word(m));
    attrset(A_NORMAL);
    printw("%6u %4u %4u %4u ", c->answers, c->timeouts, c->repeats, c->frmr + c->dm + c->refused);
    if (m->answered_ms)
        printw("%5.1f ", (double)(now_ms - m->answered_ms) / 1000.0);
    else
        printw("    - ");
    draw_values(m);
    clrtoeol();
}

static void draw_head(const struct hp *p, double load)
{
    unsigned online = 0;

    for (unsigned i = 0; i < p->modules; i++)
        online += p->module[i].state == HP_ONLINE;
    colour(COLOUR_HEAD);
    mvprintw(0, 0, " Fieldling HDLC master   %u of %u modules online   line load %5.1f %%", online, p->modules, load);
    clrtoeol();
    colour(COLOUR_DIM);
    mvprintw(1, 0, "module      addr ty pro scan ms state     answ. t-out  rep  err age s  values");
    clrtoeol();
    attrset(A_NORMAL);
}

static void draw_log(int from, int to)
{
    const unsigned rows = to > from ? (unsigned)(to - from) : 0;

    for (unsigned i = 0; i < rows; i++) {
        move(from + (int)i, 0);
        clrtoeol();
        if (logged + i >= rows && logged + i - rows < logged && rows - i <= LOG_LINES)
            addnstr(log_lines[(logged + i - rows) % LOG_LINES], COLS - 1);
    }
}

void screen_draw(const struct hp *p, double load, uint64_t now_ms)
{
    static uint64_t last_ms;
    const int below = 2 + (int)p->modules;

    if (now_ms - last_ms < DRAW_MS)
        return;
    last_ms = now_ms;
    draw_head(p, load);
    for (unsigned i = 0; i < p->modules; i++)
        draw_module(2 + (int)i, &p->module[i], now_ms);
    colour(COLOUR_DIM);
    mvprintw(below, 0, "set M CH V | get M CH | samples M CH | diag M | on M | off M | status | quit");
    clrtoeol();
    attrset(A_NORMAL);
    draw_log(below + 1, LINES - 1);
    mvprintw(LINES - 1, 0, "> %s", input);
    clrtoeol();
    refresh();
}

const char *screen_key(int key, bool *quit)
{
    static char line[sizeof input];

    if (key == KEY_EOT || key == KEY_ESC) {
        *quit = key == KEY_EOT;
        input_n = 0;
    } else if (key == '\n' || key == '\r') {
        memcpy(line, input, sizeof line);
        input_n = 0;
        input[0] = '\0';
        return line;
    } else if ((key == 127 || key == 8) && input_n) {
        input_n--;
    } else if (key >= ' ' && key <= '~' && input_n < sizeof input - 1u) {
        input[input_n++] = (char)key;
    }
    input[input_n] = '\0';
    return NULL;
}
