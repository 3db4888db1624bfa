#include "sim/mon.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/* Seconds with up to nine decimals. */
static bool read_time(const char **at, uint64_t *ns)
{
    char *end;
    if (!isdigit((unsigned char)**at))
        return false;
    *ns = strtoull(*at, &end, 10) * 1000000000ULL;
    if (*end == '.') {
        uint64_t unit = 100000000;
        for (end++; isdigit((unsigned char)*end); end++, unit /= 10)
            *ns += (uint64_t)(*end - '0') * unit;
    }
    *at = end;
    return *end == ' ' || *end == '\t';
}

static int digit(char c)
{
    return isdigit((unsigned char)c)    ? c - '0'
           : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10
                                        : -1;
}

static bool read_line(const char *at, mon_sink *sink)
{
    struct mon_octet o;
    if (!read_time(&at, &o.start))
        return false;
    for (uint64_t i = 0, first = o.start;; i++) {
        at += strspn(at, " \t\r");
        if (*at == '\0')
            return i > 0;
        if (digit(at[0]) < 0 || digit(at[1]) < 0)
            return false;
        o.octet = (uint8_t)(digit(at[0]) << 4 | digit(at[1]));
        o.err = 0;
        for (at += 2; *at == '!' || *at == '?'; at++)
            o.err |= *at == '!' ? MON_PARITY : MON_FRAMING;
        o.start = first + i * mon_char();
        mon_split(&o, sink);
    }
}

unsigned mon_record_read(FILE *from, bool rate_fixed, mon_sink *sink)
{
    char *line = NULL;
    size_t room = 0;
    unsigned number = 0;
    bool good = true;
    uint32_t rate;
    while (good && getline(&line, &room, from) >= 0) {
        number++;
        if (!rate_fixed && sscanf(line, "# rate %u", &rate) == 1 && rate)
            mon.rate = rate;
        if (strncmp(line, "# untimed", 9) == 0) {
            mon.untimed = true;
            mon.gap = mon.gap ? mon.gap : MON_LUMPS;
        }
        line[strcspn(line, "#\n")] = '\0';
        good = line[strspn(line, " \t\r")] == '\0' || read_line(line, sink);
    }
    free(line);
    mon_split_end(sink);
    return good ? 0 : number;
}

void mon_record_head(FILE *to)
{
    fprintf(to, "%s# rate %u\n", mon.untimed ? "# untimed\n" : "", mon.rate);
}

void mon_record_frame(FILE *to, const struct mon_frame *f)
{
    fprintf(to, "%llu.%09llu", (unsigned long long)(f->start / 1000000000),
            (unsigned long long)(f->start % 1000000000));
    for (unsigned i = 0; i < f->n; i++)
        fprintf(to, " %02X", f->octets[i]);
    fprintf(to, "\n");
}
