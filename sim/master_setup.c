#include "sim/master_setup.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOCK   0x80u
#define SYNC   0x20u
#define FREEZE 0x10u
#define WD_ON  0x08u

static const char *wrong(struct setup *s, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(s->wrong, sizeof s->wrong, format, args);
    va_end(args);
    return s->wrong;
}

static bool number(const char *text, unsigned long max, unsigned long *to)
{
    char *end;
    *to = strtoul(text, &end, 0);
    return isdigit((unsigned char)text[0]) && *end == '\0' && *to <= max;
}

static bool octets(const char *at, uint8_t *to, uint8_t *n, unsigned room)
{
    *n = 0;
    while (*(at += strspn(at, " \t")) != '\0') {
        char *end;
        const unsigned long value = strtoul(at, &end, 16);
        if (end == at || value > 255 || *n == room || (*end && !isspace((unsigned char)*end)))
            return false;
        to[(*n)++] = (uint8_t)value;
        at = end;
    }
    return true;
}

/* ---- lengths from identifier bytes (facts 3.8) ----------------------------------------------------------- */

static unsigned length(uint8_t coded, uint8_t mask)
{
    return ((coded & mask) + 1u) * (coded & 0x40 ? 2 : 1);
}

/* -> false: an identifier is cut short, or there is more than fits a telegram. */
static bool lengths(struct dp_slave *s)
{
    unsigned in = 0, out = 0;
    for (unsigned at = 0; at < s->cfg_n;) {
        const uint8_t id = s->cfg[at++];
        const unsigned maker = (id & 15) == 15 ? 0 : id & 15;
        if (id & 0x30) {
            in += id & 0x10 ? length(id, 15) : 0;
            out += id & 0x20 ? length(id, 15) : 0;
            continue;
        }
        if (at + (id >> 7) + (id >> 6 & 1u) + maker > s->cfg_n)
            return false;
        out += id & 0x80 ? length(s->cfg[at++], 63) : 0;
        in += id & 0x40 ? length(s->cfg[at++], 63) : 0;
        at += maker;
    }
    s->in_n = (uint8_t)in;
    s->out_n = (uint8_t)out;
    return in <= DP_DATA_MAX && out <= DP_DATA_MAX;
}

/* ---- a slave ------------------------------------------------------------------------------------------- */

static struct dp_slave *last(struct setup *s)
{
    return &s->slaves[s->slaves_n - 1];
}

static const char *add_module(struct setup *s, const struct gsd_module *m)
{
    struct dp_slave *const slave = last(s);
    if (slave->cfg_n + m->cfg_n > (int)sizeof slave->cfg)
        return wrong(s, "slave %u: more than %zu identifier bytes", slave->address, sizeof slave->cfg);
    memcpy(slave->cfg + slave->cfg_n, m->cfg, m->cfg_n);
    slave->cfg_n = (uint8_t)(slave->cfg_n + m->cfg_n);
    return NULL;
}

/* The preset modules; of a compact station its one module. */
static const char *preset(struct setup *s)
{
    const char *bad = NULL;
    for (unsigned i = 0; i < s->gsd.modules_n && !bad; i++)
        if (s->gsd.modules[i].preset || !s->gsd.modular)
            bad = add_module(s, &s->gsd.modules[i]);
    return bad;
}

static const char *begin(struct setup *s, const char *address)
{
    unsigned long value;
    if (!number(address, 125, &value))
        return wrong(s, "slave %s: an address is 0 to 125", address);
    for (unsigned i = 0; i < s->slaves_n; i++)
        if (s->slaves[i].address == value)
            return wrong(s, "slave %lu again", value);
    if (s->slaves_n == SETUP_SLAVES)
        return wrong(s, "more than %u slaves", SETUP_SLAVES);
    struct dp_slave *const slave = &s->slaves[s->slaves_n++];
    *slave = (struct dp_slave){
        .address = (uint8_t)value, .station_status = LOCK | WD_ON, .wd1 = 50, .wd2 = 1, .min_t_sdr = 11};
    s->has_gsd = false;
    return NULL;
}

static const char *load_gsd(struct setup *s, const char *path)
{
    unsigned line;
    const char *const bad = gsd_read(path, &s->gsd, &line);
    if (bad && line)
        return wrong(s, "%s, line %u: %s", path, line, bad);
    if (bad)
        return wrong(s, "%s: %s", path, bad);
    struct dp_slave *const slave = last(s);
    s->has_gsd = true;
    slave->ident = s->gsd.ident;
    slave->user_prm_n = s->gsd.user_prm_n;
    memcpy(slave->user_prm, s->gsd.user_prm, s->gsd.user_prm_n);
    snprintf(s->model[s->slaves_n - 1], sizeof s->model[0], "%s", s->gsd.model);
    slave->cfg_n = 0;
    return preset(s);
}

const char *setup_module(struct setup *s, const char *name)
{
    static unsigned chosen_for; /* slaves_n: its presets are gone */
    if (s->slaves_n == 0 || !s->has_gsd)
        return wrong(s, "module \"%s\": the slave has no GSD file yet", name);
    const struct gsd_module *const m = gsd_module(&s->gsd, name);
    if (!m)
        return wrong(s, "the GSD file of slave %u has no module \"%s\"", last(s)->address, name);
    if (chosen_for != s->slaves_n)
        last(s)->cfg_n = 0;
    chosen_for = s->slaves_n;
    return add_module(s, m);
}

const char *setup_slave(struct setup *s, const char *address, const char *gsd_path)
{
    const char *const bad = begin(s, address);
    return bad ? bad : load_gsd(s, gsd_path);
}

/* 10 ms times two factors; the smallest product that is not less. */
static const char *watchdog(struct setup *s, const char *value)
{
    struct dp_slave *const slave = last(s);
    unsigned long ms;
    if (strcmp(value, "off") == 0) {
        slave->station_status &= (uint8_t)~WD_ON;
        return NULL;
    }
    if (!number(value, 650250, &ms) || ms < 10)
        return wrong(s, "watchdog %s: 10 to 650250 ms, or off", value);
    const unsigned long steps = (ms + 9) / 10, f2 = (steps + 254) / 255;
    slave->wd2 = (uint8_t)f2;
    slave->wd1 = (uint8_t)((steps + f2 - 1) / f2);
    slave->station_status |= WD_ON;
    return NULL;
}

const char *setup_end(struct setup *s)
{
    for (unsigned i = 0; i < s->slaves_n; i++) {
        struct dp_slave *const slave = &s->slaves[i];
        if (slave->cfg_n == 0)
            return wrong(s, "slave %u has no configuration: gsd, module or cfg is missing", slave->address);
        if (!lengths(slave))
            return wrong(s, "slave %u: its identifier bytes are cut short or ask for more than 244 octets",
                         slave->address);
        if (slave->address == s->address)
            return wrong(s, "slave %u has the master's address", slave->address);
    }
    return s->slaves_n ? NULL : wrong(s, "no slave");
}

/* ---- the text file ------------------------------------------------------------------------------------- */

static const char *of_slave(struct setup *s, const char *key, char *value, const char *folder)
{
    struct dp_slave *const slave = last(s);
    unsigned long n = 0;
    uint8_t count = 0;
    char path[512];
    bool good = true;
    if (strcmp(key, "gsd") == 0) {
        snprintf(path, sizeof path, "%s%s", value[0] == '/' ? "" : folder, value);
        return load_gsd(s, path);
    }
    if (strcmp(key, "module") == 0)
        return setup_module(s, value);
    if (strcmp(key, "watchdog") == 0)
        return watchdog(s, value);
    if (strcmp(key, "ident") == 0)
        good = number(value, 65535, &n), slave->ident = (uint16_t)n;
    else if (strcmp(key, "min-tsdr") == 0)
        good = number(value, 255, &n), slave->min_t_sdr = (uint8_t)n;
    else if (strcmp(key, "group") == 0)
        good = octets(value, &slave->group, &count, 1) && count == 1;
    else if (strcmp(key, "cfg") == 0)
        good = octets(value, slave->cfg, &slave->cfg_n, sizeof slave->cfg);
    else if (strcmp(key, "prm") == 0)
        good = octets(value, slave->user_prm, &slave->user_prm_n, sizeof slave->user_prm);
    else if (strcmp(key, "outputs") == 0)
        good = octets(value, slave->outputs, &count, sizeof slave->outputs);
    else if (strcmp(key, "sync") == 0)
        slave->station_status |= SYNC;
    else if (strcmp(key, "freeze") == 0)
        slave->station_status |= FREEZE;
    else
        return wrong(s, "\"%s\" is not known", key);
    return good ? NULL : wrong(s, "%s %s: not a value for that", key, value);
}

static const char *statement(struct setup *s, char *text, const char *folder)
{
    unsigned long n;
    char *const key = text + strspn(text, " \t");
    char *value = key + strcspn(key, " \t");
    if (*value)
        *value++ = '\0';
    value += strspn(value, " \t\"");
    for (char *end = value + strlen(value); end > value && strchr(" \t\r\"", end[-1]);)
        *--end = '\0';
    if (strcmp(key, "slave") == 0)
        return begin(s, value);
    if (strcmp(key, "address") == 0) {
        if (!number(value, 125, &n))
            return wrong(s, "address %s: 0 to 125", value);
        s->address = (uint8_t)n;
        return NULL;
    }
    if (strcmp(key, "rate") == 0) {
        if (!number(value, 12000000, &n) || n < 300)
            return wrong(s, "rate %s: 300 to 12000000 bit/s", value);
        s->rate = (uint32_t)n;
        return NULL;
    }
    if (s->slaves_n == 0)
        return wrong(s, "\"%s\" before the first slave", key);
    return of_slave(s, key, value, folder);
}

const char *setup_read(struct setup *s, const char *path)
{
    char text[512], folder[256] = "";
    const char *const slash = strrchr(path, '/');
    const char *bad = NULL;
    unsigned line = 0;
    FILE *const file = fopen(path, "r");
    if (!file)
        return wrong(s, "%s: %s", path, strerror(errno));
    if (slash)
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path + 1), path);
    while (!bad && fgets(text, sizeof text, file)) {
        line++;
        text[strcspn(text, "#\r\n")] = '\0';
        if (text[strspn(text, " \t")] != '\0')
            bad = statement(s, text, folder);
    }
    fclose(file);
    if (bad) {
        char what[sizeof s->wrong];
        snprintf(what, sizeof what, "%s", bad);
        return wrong(s, "%.60s, line %u: %.90s", path, line, what);
    }
    return setup_end(s);
}
