#include "master_config.h"
#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

#define WORDS_MAX 12u

static const struct {
    const char *word;
    enum hp_type type;
} types[] = {{"di", HP_DI}, {"do", HP_DO}, {"ai", HP_AI}, {"ao", HP_AO}};

const char *master_type_word(enum hp_type type)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (types[i].type == type)
            return types[i].word;
    return "?";
}

/* "0-3,7" -> bits of channel indices. */
static const char *read_channels(const char *text, struct hp_module *m)
{
    const unsigned first = hp_first_channel(m->type), count = hp_channels(m->type);
    unsigned from, to;
    int used;

    m->channels = 0;
    for (; *text; text += *text == ',') {
        if (!isdigit((unsigned char)*text))
            return "channels: a list like 0-3,7";
        if (sscanf(text, "%u-%u%n", &from, &to, &used) != 2) {
            sscanf(text, "%u%n", &from, &used);
            to = from;
        }
        text += used;
        if (from < first || to < from || to >= first + count || (*text && *text != ','))
            return "channels: 0..15 for digital, 1..6 for analog modules, a list like 1-3,5";
        for (unsigned i = from; i <= to; i++)
            m->channels |= (uint16_t)(1u << (i - first));
    }
    return m->channels ? NULL : "channels: a list like 0-3,7";
}

static bool name_is_taken(const struct hp *p, const char *name)
{
    for (unsigned i = 0; i < p->modules; i++)
        if (strcmp(p->module[i].name, name) == 0)
            return true;
    return false;
}

/* module NAME ADDRESS TYPE SCAN_MS ... */
static const char *read_module(char **words, unsigned n, struct hp *p)
{
    struct hp_module m = {.channels = 0xFFFF};
    uint32_t number;
    const char *wrong;

    if (n < 5)
        return "module NAME ADDRESS TYPE SCAN_MS [document] [channels LIST]";
    if (strlen(words[1]) >= sizeof m.name || isdigit((unsigned char)words[1][0]) || name_is_taken(p, words[1]))
        return "NAME: at most 23 characters, not a number, each one once";
    strcpy(m.name, words[1]);
    if (!option_number(words[2], 0, 30, &number))
        return "ADDRESS is 0..30";
    m.address = (uint8_t)number;
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i].word, words[3]) == 0)
            m.type = types[i].type;
    if (!m.type)
        return "TYPE is di, do, ai or ao";
    if (!option_number(words[4], 0, 3600000, &m.scan_ms))
        return "SCAN_MS is 0..3600000";
    for (unsigned i = 5; i < n; i++) {
        if (strcmp(words[i], "document") == 0) {
            m.document = true;
        } else if (strcmp(words[i], "channels") == 0 && i + 1 < n) {
            wrong = read_channels(words[++i], &m);
            if (wrong)
                return wrong;
        } else {
            return "after SCAN_MS: document, or channels LIST";
        }
    }
    return hp_add(p, &m) ? NULL : "address already taken, or more than 31 modules";
}

static const char *read_item(char **words, unsigned n, struct hp *p)
{
    uint32_t number;

    if (strcmp(words[0], "module") == 0)
        return read_module(words, n, p);
    if (n != 2)
        return "module, timeout MS, retry MS or misses N";
    if (strcmp(words[0], "timeout") == 0) {
        if (!option_number(words[1], 10, 60000, &number))
            return "timeout is 10..60000 ms";
        p->timeout_ms = number;
    } else if (strcmp(words[0], "retry") == 0) {
        if (!option_number(words[1], 10, 3600000, &number))
            return "retry is 10..3600000 ms";
        p->retry_ms = number;
    } else if (strcmp(words[0], "misses") == 0) {
        if (!option_number(words[1], 1, 100, &number))
            return "misses is 1..100";
        p->misses_max = (uint8_t)number;
    } else {
        return "module, timeout MS, retry MS or misses N";
    }
    return NULL;
}

const char *master_config_read(const char *path, struct hp *p)
{
    static char text[600];
    char line[300];
    unsigned number = 0;
    FILE *file = fopen(path, "r");
    const char *wrong = NULL;

    if (!file) {
        snprintf(text, sizeof text, "%s: %s", path, strerror(errno));
        return text;
    }
    while (!wrong && fgets(line, sizeof line, file)) {
        char *words[WORDS_MAX];
        unsigned n = 0;
        number++;
        if (!strchr(line, '\n') && !feof(file))
            wrong = "line too long";
        line[strcspn(line, "#\r\n")] = '\0';
        for (char *w = strtok(line, " \t"); w && n < WORDS_MAX; w = strtok(NULL, " \t"))
            words[n++] = w;
        if (!wrong && n)
            wrong = read_item(words, n, p);
    }
    fclose(file);
    if (!wrong && p->modules == 0)
        wrong = "no module";
    if (!wrong)
        return NULL;
    snprintf(text, sizeof text, "%s:%u: %s", path, number, wrong);
    return text;
}
