#include "report.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define LINE_MAX_OCTETS 16384u

static bool as_json;
static void (*to)(const char *line);
static char line[LINE_MAX_OCTETS];
static size_t at;

void report_to(bool json, void (*sink)(const char *line))
{
    as_json = json;
    to = sink;
}

static void say(const char *format, ...)
{
    va_list arguments;
    int n;

    va_start(arguments, format);
    n = vsnprintf(line + at, sizeof line - at, format, arguments);
    va_end(arguments);
    if (n > 0)
        at += (size_t)n < sizeof line - at ? (size_t)n : sizeof line - at - 1u;
}

static void say_key(const char *key)
{
    say(as_json ? ",\"%s\":" : " %s=", key);
}

/* JSON strings escape quote and backslash; no text of ours holds control characters. Plain text with blanks is
 * quoted. */
static void say_string(const char *text)
{
    const bool quoted = as_json || strpbrk(text, " \"") || !*text;

    if (quoted)
        say("\"");
    for (; *text; text++) {
        if (quoted && (*text == '"' || *text == '\\'))
            say("\\");
        say("%c", *text);
    }
    if (quoted)
        say("\"");
}

void report_begin(const char *event)
{
    at = 0;
    say(as_json ? "{\"event\":\"%s\"" : "event=%s", event);
}

void report_text(const char *key, const char *text)
{
    say_key(key);
    say_string(text);
}

void report_number(const char *key, double number)
{
    say_key(key);
    say("%.10g", number);
}

void report_flag(const char *key, bool flag)
{
    say_key(key);
    say(as_json ? (flag ? "true" : "false") : (flag ? "1" : "0"));
}

void report_values(const char *key, const uint16_t *values, unsigned n, uint32_t valid)
{
    say_key(key);
    if (as_json)
        say("[");
    for (unsigned i = 0; i < n; i++) {
        say(i ? "," : "");
        if ((valid >> i) & 1u)
            say("%u", values[i]);
        else
            say(as_json ? "null" : "-");
    }
    if (as_json)
        say("]");
}

void report_list(const char *key, const uint16_t *values, unsigned n)
{
    say_key(key);
    if (as_json)
        say("[");
    for (unsigned i = 0; i < n; i++)
        say(i ? ",%u" : "%u", values[i]);
    if (as_json)
        say("]");
}

void report_end(void)
{
    if (as_json)
        say("}");
    if (to) {
        to(line);
        return;
    }
    puts(line);
    fflush(stdout);
}
