#include "sim/master.h"

#include <ctype.h>
#include <stdarg.h>

static bool json;
static unsigned said;

void say_begin(bool as_json)
{
    json = as_json;
    said = 0;
    if (json)
        printf("{");
}

static void name_(const char *name)
{
    if (json)
        printf("%s\"%s\": ", said ? ", " : "", name);
    else
        printf("%-18s ", name);
    said++;
}

/* Text from the wire may hold anything. */
static void quoted(const char *text)
{
    putchar('"');
    for (; *text; text++)
        if (*text == '"' || *text == '\\')
            printf("\\%c", *text);
        else if (isprint((unsigned char)*text))
            putchar(*text);
        else
            printf("\\u%04x", (unsigned char)*text);
    putchar('"');
}

void say_text(const char *name, const char *format, ...)
{
    char text[300];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    name_(name);
    if (json) {
        quoted(text);
        return;
    }
    for (const char *c = text; *c; c++)
        putchar(isprint((unsigned char)*c) ? *c : '.');
    putchar('\n');
}

void say_number(const char *name, unsigned long value)
{
    name_(name);
    printf(json ? "%lu" : "%lu\n", value);
}

void say_octets(const char *name, const uint8_t *o, unsigned n)
{
    name_(name);
    printf(json ? "\"" : "");
    for (unsigned i = 0; i < n; i++)
        printf("%s%02X", i ? " " : "", o[i]);
    printf(json ? "\"" : "\n");
}

void say_list(const char *name, const char *const *words, unsigned n)
{
    name_(name);
    printf(json ? "[" : "");
    for (unsigned i = 0; i < n; i++) {
        printf("%s", i ? ", " : "");
        if (json)
            quoted(words[i]);
        else
            printf("%s", words[i]);
    }
    printf(json ? "]" : n ? "\n" : "-\n");
}

void say_end(void)
{
    if (json)
        printf("}\n");
    fflush(stdout);
}
