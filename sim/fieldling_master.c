/* fieldling-master: a DP master for people, class 1 and class 2, on a pty, serial line or simulated segment. */
#include "sim/master.h"

#include <errno.h>
#include <getopt.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

static const char help[] = "fieldling-master: a PROFIBUS-DP master.\n"
                           "\n"
                           "usage: fieldling-master --line PATH [OPTIONS] COMMAND\n"
                           "\n"
                           "  cyclic [FILE]          class 1: serve the slaves of FILE (sim/master_setup.h) "
                           "or of --slave, until Ctrl-C.\n"
                           "                         Commands on standard input: out SLAVE HEX..., "
                           "sync|unsync|freeze|unfreeze [GROUP],\n"
                           "                         clear, operate, diag SLAVE, quit\n"
                           "  live-list              who answers FDL Status\n"
                           "  diag STATION           Slave_Diag in words\n"
                           "  get-cfg | rd-inp | rd-outp | ident STATION\n"
                           "  lsap STATION SAP       LSAP status\n"
                           "  set-address STATION NEW IDENT [lock]\n"
                           "\n"
                           "  --line PATH            pty or serial line\n"
                           "  --line sim:[N]         a simulated segment in this process, DP-TEST01 on it at "
                           "N (8); virtual time,\n"
                           "                         paced to real time; the slot time is the standard's\n"
                           "  --rate N               bit/s (500000)\n"
                           "  --address N            of this master (2)\n"
                           "  --slot MS              how long an answer may take to begin (30)\n"
                           "  --retries N            (1)\n"
                           "  --slave N=FILE.GSD     a slave and its GSD file, once for each; --module NAME "
                           "behind it: not the preset modules\n"
                           "  --cycle MS             shortest bus cycle (10)\n"
                           "  --seconds N, --cycles N  end after so long\n"
                           "  --clear                begin in Clear, not in Operate\n"
                           "  --count                outputs count up by themselves\n"
                           "  --json                 one JSON object a line\n"
                           "  --record FILE          keep what is said, for fieldling-mon\n"
                           "\n"
                           "Exit status: 0; 1 refused, or not all slaves exchange data; 2 wrong usage; 3 no "
                           "answer; 4 the line has gone.\n";

enum {
    OPT_LINE = 256,
    OPT_RATE,
    OPT_ADDRESS,
    OPT_SLOT,
    OPT_RETRIES,
    OPT_SLAVE,
    OPT_MODULE,
    OPT_CYCLE,
    OPT_SECONDS,
    OPT_CYCLES,
    OPT_CLEAR,
    OPT_COUNT,
    OPT_JSON,
    OPT_RECORD
};

static struct setup setup = {.address = 2, .rate = 500000};
static struct master_options o = {.cycle_ms = 10};
static const char *path, *record;
static unsigned slot_ms = 30, retries = 1;

/* A text may come from a file that is none of ours: no control characters reach the terminal. */
static int unusable(const char *what, const char *why)
{
    fprintf(stderr, "fieldling-master: %s: ", what);
    for (; *why; why++)
        fputc((unsigned char)*why < ' ' || *why == 0x7F ? '.' : *why, stderr);
    fputc('\n', stderr);
    exit(M_USAGE);
}

static unsigned number(const char *name, const char *text, unsigned long min, unsigned long max)
{
    char *end;
    char why[60];
    const unsigned long value = strtoul(text, &end, 10);
    snprintf(why, sizeof why, "a number from %lu to %lu is expected", min, max);
    if (end == text || *end || value < min || value > max)
        unusable(name, why);
    return (unsigned)value;
}

static void take_slave(char *value)
{
    char *const file = strchr(value, '=');
    if (!file)
        unusable("--slave", "N=FILE.GSD is expected");
    *file = '\0';
    const char *const bad = setup_slave(&setup, value, file + 1);
    if (bad)
        unusable("--slave", bad);
}

static void take(int option, char *value)
{
    const char *bad;
    switch (option) {
    case OPT_LINE:
        path = value;
        break;
    case OPT_RATE:
        setup.rate = number("--rate", value, 300, 12000000);
        break;
    case OPT_ADDRESS:
        setup.address = (uint8_t)number("--address", value, 0, 125);
        break;
    case OPT_SLOT:
        slot_ms = number("--slot", value, 1, 10000);
        break;
    case OPT_RETRIES:
        retries = number("--retries", value, 0, 15);
        break;
    case OPT_SLAVE:
        take_slave(value);
        break;
    case OPT_MODULE:
        bad = setup_module(&setup, value);
        if (bad)
            unusable("--module", bad);
        break;
    case OPT_CYCLE:
        o.cycle_ms = number("--cycle", value, 0, 60000);
        break;
    case OPT_SECONDS:
        o.seconds = number("--seconds", value, 1, 1000000);
        break;
    case OPT_CYCLES:
        o.cycles = number("--cycles", value, 1, 1000000000);
        break;
    case OPT_CLEAR:
        o.clear = true;
        break;
    case OPT_COUNT:
        o.count = true;
        break;
    case OPT_JSON:
        o.json = true;
        break;
    case OPT_RECORD:
        record = value;
        break;
    case 'h':
        fputs(help, stdout);
        exit(M_OK);
    default:
        exit(M_USAGE);
    }
}

static void read_options(int argc, char **argv)
{
    static const struct option options[] = {{"line", 1, 0, OPT_LINE},
                                            {"rate", 1, 0, OPT_RATE},
                                            {"address", 1, 0, OPT_ADDRESS},
                                            {"slot", 1, 0, OPT_SLOT},
                                            {"retries", 1, 0, OPT_RETRIES},
                                            {"slave", 1, 0, OPT_SLAVE},
                                            {"module", 1, 0, OPT_MODULE},
                                            {"cycle", 1, 0, OPT_CYCLE},
                                            {"seconds", 1, 0, OPT_SECONDS},
                                            {"cycles", 1, 0, OPT_CYCLES},
                                            {"clear", 0, 0, OPT_CLEAR},
                                            {"count", 0, 0, OPT_COUNT},
                                            {"json", 0, 0, OPT_JSON},
                                            {"record", 1, 0, OPT_RECORD},
                                            {"help", 0, 0, 'h'},
                                            {0}};
    int option;
    while ((option = getopt_long(argc, argv, "h", options, NULL)) != -1)
        take(option, optarg);
    if (!path)
        unusable("--line", "the line is missing, see --help");
    if (optind == argc)
        unusable("usage", "a command is missing, see --help");
}

static void on_signal(int number_)
{
    (void)number_;
    master_stop = true;
}

/* The slaves to serve are known before the line is touched. */
static void prepare(const char *verb, int n, char **words)
{
    const char *bad = NULL;
    if (strcmp(verb, "cyclic") != 0) {
        if (!master_knows(verb))
            unusable(verb, "no such command, see --help");
        return;
    }
    if (n > 2)
        unusable("usage", "cyclic [FILE]");
    bad = n == 2 ? setup_read(&setup, words[1]) : setup_end(&setup);
    if (bad)
        unusable("cyclic", bad);
}

int main(int argc, char **argv)
{
    const struct sigaction stop = {.sa_handler = on_signal};
    struct master_line line;
    struct ini ini = {0};
    read_options(argc, argv);
    char **const words = argv + optind;
    const int n = argc - optind;
    prepare(words[0], n, words);
    ini.address = setup.address;
    ini.retries = retries;
    const char *const bad = ml_open(&line, path, setup.rate, slot_ms, &ini);
    if (bad) {
        fprintf(stderr, "fieldling-master: %s: %s\n", path, bad);
        return M_LINE;
    }
    if (record && !ml_record(&line, record))
        unusable(record, strerror(errno));
    sigaction(SIGINT, &stop, NULL);
    sigaction(SIGTERM, &stop, NULL);
    const int status = strcmp(words[0], "cyclic") == 0 ? master_cyclic(&line, &setup, &ini, &o)
                                                       : master_ask(&line, &ini, &o, words, n);
    ml_close(&line);
    return status;
}
