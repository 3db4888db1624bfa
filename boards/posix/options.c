#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *program;

void options_unusable(const char *text)
{
    fprintf(stderr, "%s: %s\n", program, text);
    exit(2);
}

bool option_number(const char *text, uint32_t min, uint32_t max, uint32_t *number)
{
    bool hex = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    char *end;
    unsigned long long value;

    if (!isdigit((unsigned char)text[0]))
        return false;
    errno = 0;
    value = strtoull(text, &end, hex ? 16 : 10);
    if (errno || *end || (hex && !text[2]) || value < min || value > max)
        return false;
    *number = (uint32_t)value;
    return true;
}

static void help(const char *title, const struct option_row *rows, const char *more)
{
    char left[64];

    printf("%s\nusage: %s", title, program);
    for (const struct option_row *r = rows; r->name; r++)
        printf(r->value ? " [--%s %s]" : " [--%s]", r->name, r->value);
    printf(" [--help]\n\n");
    for (const struct option_row *r = rows; r->name; r++) {
        snprintf(left, sizeof left, "--%s %s", r->name, r->value ? r->value : "");
        printf("  %-22s %s\n", left, r->help);
    }
    printf("%s", more);
    exit(0);
}

static const struct option_row *find(const struct option_row *rows, const char *name, size_t len)
{
    for (; rows->name; rows++)
        if (strlen(rows->name) == len && memcmp(rows->name, name, len) == 0)
            return rows;
    return NULL;
}

/* One option at argv[i]; -> the index of the next one. */
static int read_one(int i, int argc, char **argv, const struct option_row *rows)
{
    const char *name = argv[i] + 2;
    size_t len = strcspn(name, "=");
    const struct option_row *row = strncmp(argv[i], "--", 2) == 0 ? find(rows, name, len) : NULL;
    const char *value = name[len] ? name + len + 1 : NULL;
    const char *wrong;
    char text[512];

    if (!row) {
        snprintf(text, sizeof text, "%s: unknown argument, see --help", argv[i]);
        options_unusable(text);
    }
    if (row->value && !value)
        value = argv[++i]; /* argv[argc] is NULL */
    if (!row->value == !!value) {
        snprintf(text, sizeof text, row->value ? "--%s needs a value: %s" : "--%s takes no value", row->name,
                 row->help);
        options_unusable(text);
    }
    wrong = row->take(value ? value : "");
    if (wrong) {
        snprintf(text, sizeof text, "--%s %s: %s", row->name, value ? value : "", wrong);
        options_unusable(text);
    }
    return i < argc ? i + 1 : i;
}

void options_read(int argc, char **argv, const char *title, const struct option_row *rows, const char *more)
{
    int i = 1;

    program = strrchr(argv[0], '/') ? strrchr(argv[0], '/') + 1 : argv[0];
    for (int k = 1; k < argc; k++)
        if (strcmp(argv[k], "--help") == 0)
            help(title, rows, more);
    while (i < argc)
        i = read_one(i, argc, argv, rows);
}
