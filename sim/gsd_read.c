#include "sim/gsd_read.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define LINE 1024u

/* The statement being read: continued lines joined, comment gone. */
struct reader {
    FILE *file;
    unsigned number;
    char text[LINE];
    struct gsd *to;
    struct gsd_module *module; /* inside Module ... EndModule */
};

/* ';' outside of quotation marks ends the line. */
static void strip(char *text)
{
    bool quoted = false;
    char *at = text;
    for (; *at; at++) {
        quoted ^= *at == '"';
        if (*at == ';' && !quoted)
            break;
    }
    *at = '\0';
    while (at > text && isspace((unsigned char)at[-1]))
        *--at = '\0';
}

static bool next_line(struct reader *r)
{
    size_t n = 0;
    r->text[0] = '\0';
    while (n < LINE - 1 && fgets(r->text + n, (int)(LINE - n), r->file)) {
        r->number++;
        strip(r->text + n);
        n = strlen(r->text);
        if (n == 0 || r->text[n - 1] != '\\')
            return true;
        r->text[n - 1] = ' ';
    }
    return n > 0;
}

/* Does the statement begin with this keyword? Then *value is behind its '=', or "". */
static bool is(const struct reader *r, const char *keyword, const char **value)
{
    const char *at = r->text + strspn(r->text, " \t");
    const size_t n = strlen(keyword);
    if (strncasecmp(at, keyword, n) != 0 || isalnum((unsigned char)at[n]) || at[n] == '_' || at[n] == '.')
        return false;
    at += n;
    *value = strchr(at, '=');
    *value = *value ? *value + 1 + strspn(*value + 1, " \t") : at + strlen(at);
    return true;
}

static void take_text(const char *value, char *to, size_t size)
{
    const char *const end = *value == '"' ? strchr(value + 1, '"') : NULL;
    const size_t n = end ? (size_t)(end - value - 1) : 0;
    snprintf(to, size, "%.*s", (int)n, value + 1);
}

/* Octets separated by commas or blanks. -> false: one is none, or there are too many. */
static bool take_octets(const char *at, uint8_t *to, uint8_t *n)
{
    while (*(at += strspn(at, ", \t\r")) != '\0') {
        char *end;
        const unsigned long value = strtoul(at, &end, 0);
        if (end == at || value > 255 || *n == GSD_OCTETS)
            return false;
        to[(*n)++] = (uint8_t)value;
        at = end;
    }
    return true;
}

static const char *take_module(struct reader *r, const char *value)
{
    const char *const end = *value == '"' ? strchr(value + 1, '"') : NULL;
    if (!end)
        return "Module: a name in quotation marks is expected";
    if (r->to->modules_n == GSD_MODULES)
        return "more modules than this program holds (64)";
    r->module = &r->to->modules[r->to->modules_n++];
    take_text(value, r->module->name, sizeof r->module->name);
    return take_octets(end + 1, r->module->cfg, &r->module->cfg_n) ? NULL
                                                                   : "Module: octets 0 to 255 are expected";
}

/* Ext_User_Prm_Data_Const(first)=octets */
static const char *take_constants(struct reader *r, const char *value)
{
    const char *const bracket = strchr(r->text, '(');
    const unsigned long first = bracket ? strtoul(bracket + 1, NULL, 0) : GSD_OCTETS;
    uint8_t octets[GSD_OCTETS], n = 0;
    if (!take_octets(value, octets, &n) || first + n > GSD_OCTETS)
        return "user parameters: up to 64 octets 0 to 255 are expected";
    memcpy(r->to->user_prm + first, octets, n);
    if (first + n > r->to->user_prm_n)
        r->to->user_prm_n = (uint8_t)(first + n);
    return NULL;
}

static const char *take_data(struct reader *r, const char *value)
{
    r->to->user_prm_n = 0;
    return take_octets(value, r->to->user_prm, &r->to->user_prm_n) ? NULL
                                                                   : "User_Prm_Data: octets are expected";
}

static bool yes(const char *value)
{
    return strtoul(value, NULL, 0) != 0;
}

static void take_number(struct reader *r, const char *value)
{
    struct gsd *const g = r->to;
    const unsigned long n = strtoul(value, NULL, 0);
    const char *unused;
    if (is(r, "Ident_Number", &unused))
        g->ident = (uint16_t)n;
    else if (is(r, "Max_Module", &unused))
        g->max_module = (unsigned)n;
    else if (is(r, "Min_Slave_Intervall", &unused))
        g->min_slave_interval = (unsigned)n;
    else if (is(r, "Modular_Station", &unused))
        g->modular = yes(value);
    else if (is(r, "Sync_Mode_supp", &unused))
        g->sync = yes(value);
    else if (is(r, "Freeze_Mode_supp", &unused))
        g->freeze = yes(value);
    else if (is(r, "Fail_Safe", &unused))
        g->fail_safe = yes(value);
}

static const char *take(struct reader *r)
{
    const char *value;
    if (is(r, "EndModule", &value))
        r->module = NULL;
    else if (r->module && is(r, "Preset", &value))
        r->module->preset = yes(value);
    else if (r->module)
        return NULL;
    else if (is(r, "Module", &value))
        return take_module(r, value);
    else if (is(r, "Ext_User_Prm_Data_Const", &value))
        return take_constants(r, value);
    else if (is(r, "User_Prm_Data", &value))
        return take_data(r, value);
    else if (is(r, "Vendor_Name", &value))
        take_text(value, r->to->vendor, sizeof r->to->vendor);
    else if (is(r, "Model_Name", &value))
        take_text(value, r->to->model, sizeof r->to->model);
    else if ((value = strchr(r->text, '=')) != NULL)
        take_number(r, value + 1);
    return NULL;
}

static const char *read_all(struct reader *r)
{
    const char *wrong = NULL, *unused;
    bool begun = false;
    while (!wrong && next_line(r)) {
        if (!begun)
            begun = is(r, "#Profibus_DP", &unused);
        else
            wrong = take(r);
    }
    if (!begun)
        return "no line #Profibus_DP: this is no GSD file";
    if (!wrong && r->to->modules_n == 0)
        return "the file has no Module";
    return wrong;
}

const char *gsd_read(const char *path, struct gsd *to, unsigned *line)
{
    struct reader r = {.file = fopen(path, "r"), .to = to};
    *line = 0;
    if (!r.file)
        return strerror(errno);
    memset(to, 0, sizeof *to);
    const char *const wrong = read_all(&r);
    if (wrong)
        *line = r.number;
    fclose(r.file);
    return wrong;
}

const struct gsd_module *gsd_module(const struct gsd *g, const char *name)
{
    for (unsigned i = 0; i < g->modules_n; i++)
        if (strcmp(g->modules[i].name, name) == 0)
            return &g->modules[i];
    return NULL;
}
