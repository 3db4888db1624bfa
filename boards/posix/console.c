#include "console.h"
#include "hal/hal.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const struct console_command *commands;

/* Invariant: line_len <= CONSOLE_LINE. wrong: why the line being read will not be carried out, NULL = it
 * will. */
static char line[CONSOLE_LINE + 1u];
static size_t line_len;
static const char *wrong;

static char answer[2u * CONSOLE_LINE];
static size_t answer_len;

void console_init(const struct console_command *table)
{
    commands = table;
}

void console_say(const char *format, ...)
{
    va_list arguments;
    int n;

    va_start(arguments, format);
    n = vsnprintf(answer + answer_len, sizeof answer - answer_len, format, arguments);
    va_end(arguments);
    if (n > 0)
        answer_len += (size_t)n < sizeof answer - answer_len ? (size_t)n : sizeof answer - answer_len - 1u;
}

void console_error(const char *reason)
{
    answer_len = 0;
    console_say("error=%s", reason);
}

void console_line(const char *text)
{
    while (*text)
        hal_con_put((uint8_t)*text++);
    hal_con_put('\n');
}

static bool ended;

void console_quit(char **words, uint8_t n)
{
    (void)words;
    if (n != 1) {
        console_error("no-argument-expected");
        return;
    }
    ended = true;
    console_say("quit=ok");
}

bool console_ended(void)
{
    return ended;
}

bool console_switch(char **words, uint8_t n, bool *on)
{
    *on = n == 2 && strcmp(words[1], "on") == 0;
    if (!*on && !(n == 2 && strcmp(words[1], "off") == 0)) {
        console_error("usage-");
        console_say("%s-on-or-off", words[0]);
        return false;
    }
    console_say("%s=%s", words[0], words[1]);
    return true;
}

static void run_command(char **words, uint8_t n)
{
    for (const struct console_command *c = commands; c->verb; c++) {
        if (strcmp(c->verb, words[0]) == 0) {
            c->run(words, n);
            return;
        }
    }
    console_error("unknown-command known=");
    for (const struct console_command *c = commands; c->verb; c++)
        console_say("%s%s", c == commands ? "" : ",", c->verb);
}

static void carry_out(void)
{
    char *words[CONSOLE_WORDS];
    uint8_t n = 0;
    char *at = line;

    answer_len = 0;
    line[line_len] = '\0';
    if (!wrong && strchr(line, '\r'))
        wrong = "not-text";
    while (!wrong && *(at += strspn(at, " \t")) != '\0') {
        if (n == CONSOLE_WORDS) {
            wrong = "too-many-words";
            break;
        }
        words[n++] = at;
        at += strcspn(at, " \t");
        if (*at)
            *at++ = '\0';
    }
    if (wrong)
        console_error(wrong);
    else if (n == 0)
        console_error("empty-line");
    else
        run_command(words, n);
    console_line(answer);
}

static void take(uint8_t octet)
{
    if (octet < ' ' || octet > '~')
        if (octet != '\t' && octet != '\r')
            wrong = "not-text";
    if (line_len < CONSOLE_LINE)
        line[line_len++] = (char)octet;
    else if (!wrong)
        wrong = "line-too-long";
}

void console_poll(void)
{
    int16_t octet;

    while ((octet = hal_con_get()) >= 0) {
        if (octet != '\n') {
            take((uint8_t)octet);
            continue;
        }
        if (line_len && line[line_len - 1u] == '\r') /* CR LF */
            line_len--;
        carry_out();
        line_len = 0;
        wrong = NULL;
        return;
    }
}
