/* fieldling-mon: the bus analyzer. */
#include "sim/mon.h"
#include "sim/port.h"

#include <errno.h>
#include <getopt.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

static const char help[] =
    "fieldling-mon: see what is said on a fieldbus.\n"
    "\n"
    "usage: fieldling-mon [OPTIONS] FILE|LINE|-\n"
    "\n"
    "  FILE is a record: lines \"SECONDS HEX HEX ...\", \"# rate 500000\", '#' comments (sim/README.md);\n"
    "  '-' is a record on standard input. LINE is a pty or serial line to listen to until Ctrl-C.\n"
    "\n"
    "  --view command|hex|both  what to print of each telegram (command)\n"
    "  -v, --verbose            and its content\n"
    "  -q, --quiet              print no telegrams\n"
    "  --rate N                 bit/s, when the record does not say it, or of LINE (500000)\n"
    "  --format 8E1|8N2|...     character format of LINE (8E1)\n"
    "  --gap US                 a telegram ends after that silence [us] (a record: T_SYN; LINE: 5000)\n"
    "  --pa | --modbus rtu|ascii | --hdlc   another protocol than PROFIBUS-DP\n"
    "  --summary                at the end, what each station did\n"
    "  --plot FILE.svg          at the end, a picture of the last bus cycles and of T_SDR\n"
    "  -w FILE.pcapng           for Wireshark with sim/wireshark/profibus_dp.lua; -w -: to standard output, "
    "for\n"
    "                           `wireshark -k -i -`, and no telegrams are printed\n"
    "  --record FILE            keep what was heard, as a record\n"
    "\n"
    "Exit status: 0; 1 a telegram was wrong; 2 wrong usage or unreadable input.\n";

enum {
    OPT_VIEW = 256,
    OPT_RATE,
    OPT_FORMAT,
    OPT_GAP,
    OPT_PA,
    OPT_MODBUS,
    OPT_HDLC,
    OPT_SUMMARY,
    OPT_PLOT,
    OPT_RECORD
};

static struct {
    bool command, hex, verbose, summary, rate_fixed;
    const char *plot, *pcapng;
    FILE *record;
    enum port_format format;
    uint64_t gap;
} o = {.command = true};
static volatile sig_atomic_t stopped;
static unsigned long wrong;

static void unusable(const char *what, const char *why)
{
    fprintf(stderr, "fieldling-mon: %s: %s\n", what, why);
    exit(2);
}

static void show(struct mon_frame *f)
{
    mon_pair(f);
    if (o.command)
        mon_command_view(stdout, f);
    if (o.hex)
        mon_hex_view(stdout, f);
    if (o.verbose)
        mon_details(stdout, f);
    if (o.summary)
        mon_stats_frame(f);
    if (o.plot)
        mon_plot_frame(f);
    if (o.pcapng)
        mon_pcapng_frame(f);
    if (o.record && f->seq == 0)
        mon_record_head(o.record);
    if (o.record)
        mon_record_frame(o.record, f);
    wrong += !f->good;
}

/* ---- a line, live -------------------------------------------------------------------------------------- */

static void on_signal(int number)
{
    (void)number;
    stopped = 1;
}

/* Octets that come in one lump ended now, one after the other. */
static void lump(const uint8_t *octets, const uint8_t *err, unsigned n, uint64_t now)
{
    static uint64_t line_free;
    uint64_t start = now > n * mon_char() ? now - n * mon_char() : 0;
    if (start < line_free)
        start = line_free;
    for (unsigned i = 0; i < n; i++) {
        const struct mon_octet octet = {start + i * mon_char(), octets[i], err[i]};
        mon_split(&octet, show);
    }
    line_free = start + n * mon_char();
}

static void listen_to(const char *path)
{
    const char *why;
    uint8_t octets[512], err[512];
    struct port_marks marks = {0};
    const int fd = port_open(path, mon.rate, o.format, &why);
    if (fd < 0)
        unusable(path, why);
    if (!port_mark_errors(fd))
        unusable(path, "its driver cannot mark parity errors");
    struct pollfd p = {fd, POLLIN, 0};
    mon.gap = mon.gap ? mon.gap : MON_LUMPS;
    while (!stopped) {
        const int ready = poll(&p, 1, 20);
        const ssize_t n = ready > 0 ? read(fd, octets, sizeof octets) : 0;
        if (n > 0)
            lump(octets, err, port_unmark(&marks, octets, err, (unsigned)n), port_now());
        else if (ready > 0 && (n == 0 || errno != EAGAIN))
            break; /* the other end has gone */
        mon_split_idle(port_now(), show);
        fflush(stdout);
    }
    mon_split_end(show);
    close(fd);
}

static void read_record(const char *path)
{
    char why[48];
    FILE *const from = strcmp(path, "-") == 0 ? stdin : fopen(path, "r");
    if (!from)
        unusable(path, strerror(errno));
    const unsigned line = mon_record_read(from, o.rate_fixed, show);
    if (line) {
        fflush(stdout);
        snprintf(why, sizeof why, "line %u is no record line", line);
        unusable(path, why);
    }
}

/* ---- command line -------------------------------------------------------------------------------------- */

static unsigned long number(const char *name, const char *text, unsigned long max)
{
    char *end;
    const unsigned long value = strtoul(text, &end, 10);
    if (end == text || *end || value == 0 || value > max)
        unusable(name, "a number is expected");
    return value;
}

static void choose(const char *name, const char *value, const char *a, const char *b, const char *c)
{
    if (strcmp(value, a) != 0 && strcmp(value, b) != 0 && strcmp(value, c) != 0)
        unusable(name, "no such choice, see --help");
}

static void take(int option, const char *value)
{
    switch (option) {
    case OPT_VIEW:
        choose("--view", value, "command", "hex", "both");
        o.command = value[0] != 'h';
        o.hex = value[0] != 'c';
        break;
    case 'q':
        o.command = o.hex = o.verbose = false;
        break;
    case 'v':
        o.verbose = true;
        break;
    case OPT_RATE:
        mon.rate = (uint32_t)number("--rate", value, 12000000);
        o.rate_fixed = true;
        break;
    case OPT_FORMAT:
        o.format = port_format_named(value);
        if (o.format == PORT_FORMATS)
            unusable("--format", "no such format, see --help");
        break;
    case OPT_GAP:
        mon.gap = number("--gap", value, 100000000) * 1000;
        break;
    case OPT_PA:
        mon.protocol = MON_PA;
        mon.rate = o.rate_fixed ? mon.rate : 31250;
        break;
    case OPT_MODBUS:
        choose("--modbus", value, "rtu", "ascii", "ascii");
        mon.protocol = value[0] == 'r' ? MON_MODBUS_RTU : MON_MODBUS_ASCII;
        break;
    case OPT_HDLC:
        mon.protocol = MON_HDLC;
        break;
    case OPT_SUMMARY:
        o.summary = true;
        break;
    case OPT_PLOT:
        o.plot = value;
        break;
    case 'w':
        o.pcapng = value;
        if (strcmp(value, "-") == 0)
            o.command = o.hex = o.verbose = false;
        break;
    case OPT_RECORD:
        o.record = fopen(value, "w");
        if (!o.record)
            unusable(value, strerror(errno));
        break;
    case 'h':
        fputs(help, stdout);
        exit(0);
    default:
        exit(2);
    }
}

static void read_options(int argc, char **argv)
{
    static const struct option options[] = {{"view", 1, 0, OPT_VIEW},     {"verbose", 0, 0, 'v'},
                                            {"quiet", 0, 0, 'q'},         {"rate", 1, 0, OPT_RATE},
                                            {"format", 1, 0, OPT_FORMAT}, {"gap", 1, 0, OPT_GAP},
                                            {"pa", 0, 0, OPT_PA},         {"modbus", 1, 0, OPT_MODBUS},
                                            {"hdlc", 0, 0, OPT_HDLC},     {"summary", 0, 0, OPT_SUMMARY},
                                            {"plot", 1, 0, OPT_PLOT},     {"record", 1, 0, OPT_RECORD},
                                            {"help", 0, 0, 'h'},          {0}};
    int option;
    while ((option = getopt_long(argc, argv, "vqw:h", options, NULL)) != -1)
        take(option, optarg);
    if (optind + 1 != argc)
        unusable("usage", "one FILE, LINE or - is expected, see --help");
}

static bool is_line(const char *path)
{
    struct stat s;
    const bool line = stat(path, &s) == 0 && S_ISCHR(s.st_mode);
    mon.untimed = line && major(s.st_rdev) >= 136 && major(s.st_rdev) <= 143; /* Unix98 ptys */
    return line;
}

static void at_the_end(void)
{
    if (o.summary)
        mon_stats_print(stdout);
    if (o.plot && !mon_plot_write(o.plot))
        unusable(o.plot, strerror(errno));
    if (o.pcapng && !mon_pcapng_close())
        unusable(o.pcapng, strerror(errno));
    if (o.record && fclose(o.record))
        unusable("--record", strerror(errno));
}

int main(int argc, char **argv)
{
    const struct sigaction stop = {.sa_handler = on_signal};
    read_options(argc, argv);
    const char *const source = argv[optind];
    if (o.pcapng && !mon_pcapng_open(o.pcapng))
        unusable(o.pcapng, strerror(errno));
    sigaction(SIGINT, &stop, NULL);
    sigaction(SIGTERM, &stop, NULL);
    if (is_line(source))
        listen_to(source);
    else
        read_record(source);
    at_the_end();
    return wrong ? 1 : 0;
}
