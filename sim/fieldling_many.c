/* fieldling-many: up to 124 stations and one master on one segment, in virtual time and one process.
 *
 * Who may speak is known: the master, then the one it asked. So a telegram is worked out at its sender first and then
 * heard by all others, and nothing is lost in exactness as long as nobody else speaks; if somebody does, that is
 * counted as a collision and the run has failed.
 */
#include "sim/dp_master.h"
#include "sim/many.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define STATIONS 124
#define MASTER   0
#define RATES    11

static struct station {
    const struct many_station *is;
    uint8_t address;
} stations[STATIONS];
static unsigned stations_n;

static struct dp_slave slaves[STATIONS];
static struct dp_master m;

static struct {
    uint64_t now, bit;
    struct station *speaker; /* who may speak now */
    uint8_t octets[TG_MAX];
    uint64_t ends[TG_MAX];
    unsigned n;
    uint64_t answer_start, request_end;
    unsigned long telegrams, collisions, early, late;
    unsigned max_t_sdr;
} line;

/* A record for fieldling-mon; NULL: none. */
static FILE *record;

static void keep(uint64_t start, const uint8_t *octets, unsigned n)
{
    if (!record)
        return;
    const uint64_t ns = start / 576 * 1000 + start % 576 * 1000 / 576;
    fprintf(record, "%llu.%09llu", (unsigned long long)(ns / 1000000000),
            (unsigned long long)(ns % 1000000000));
    for (unsigned i = 0; i < n; i++)
        fprintf(record, " %02X", octets[i]);
    fprintf(record, "\n");
}

/* ---- the line -------------------------------------------------------------------------------------------- */

static void on_says(void *of, uint8_t octet, uint64_t start, uint64_t end)
{
    if (of != line.speaker || line.n == TG_MAX) {
        line.collisions++;
        return;
    }
    if (line.n == 0)
        line.answer_start = start;
    line.octets[line.n] = octet;
    line.ends[line.n++] = end;
}

static void tell(const struct station *s, const uint8_t *octets, const uint64_t *ends, unsigned n)
{
    for (unsigned i = 0; i < n; i++)
        s->is->hears(ends[i], octets[i]);
}

static struct station *station_at(uint8_t address)
{
    for (unsigned i = 0; i < stations_n; i++)
        if (stations[i].address == address)
            return &stations[i];
    return NULL;
}

static void judge_t_sdr(void)
{
    const uint64_t idle = line.answer_start - line.request_end;
    line.early += idle < 11 * line.bit;
    line.late += idle > line.max_t_sdr * line.bit;
}

/* The asked one lives on until its answer is out, or it is too late for one. In steps shorter than a character, so
 * that it never lives beyond the end of its answer: the next request would come too late for it. */
static void speak(void)
{
    const uint64_t limit = line.request_end + (line.max_t_sdr + 2) * line.bit;
    uint64_t t = line.request_end;
    unsigned said = 0;
    while (line.n == 0 && t < limit) {
        t += 10 * line.bit;
        line.speaker->is->run_until(t);
    }
    while (line.n != said) {
        said = line.n;
        line.speaker->is->run_until(line.ends[said - 1]);
    }
}

/* The master sends; whoever it asks answers; everybody hears both. */
static void on_send(void *of, const uint8_t *octets, unsigned n)
{
    uint64_t ends[TG_MAX];
    struct tg t;
    (void)of;
    for (unsigned i = 0; i < n; i++)
        ends[i] = line.now + (i + 1) * 11 * line.bit;
    for (unsigned i = 0; i < stations_n; i++)
        tell(&stations[i], octets, ends, n);
    line.request_end = ends[n - 1];
    line.telegrams++;
    keep(line.now, octets, n);
    line.n = 0;
    line.speaker = NULL;
    if (tg_decode(octets, n, &t) == TG_GOOD && tg_wants_answer(&t))
        line.speaker = station_at(t.da);
    if (line.speaker) {
        speak();
        for (unsigned i = 0; i < stations_n; i++)
            if (&stations[i] != line.speaker)
                tell(&stations[i], line.octets, line.ends, line.n);
    }
    if (line.n) {
        line.telegrams++;
        keep(line.answer_start, line.octets, line.n);
        judge_t_sdr();
    }
}

static void everybody_until(uint64_t t)
{
    for (unsigned i = 0; i < stations_n; i++)
        stations[i].is->run_until(t);
    line.now = t;
}

/* ---- stations and master --------------------------------------------------------------------------------- */

/* A copy of the file of its own, or the loader would hand out the same station twice. */
static const struct many_station *load(const char *image, const char *folder, unsigned i)
{
    char path[512], buffer[16384];
    size_t n;
    snprintf(path, sizeof path, "%s/station-%u.so", folder, i);
    FILE *const from = fopen(image, "rb"), *const to = fopen(path, "wb");
    while (from && to && (n = fread(buffer, 1, sizeof buffer, from)) > 0)
        fwrite(buffer, 1, n, to);
    if (from)
        fclose(from);
    if (to)
        fclose(to);
    void *const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    unlink(path);
    if (!handle) {
        fprintf(stderr, "fieldling-many: %s\n", dlerror());
        exit(2);
    }
    return dlsym(handle, MANY_SYMBOL);
}

static void load_all(const char *image, unsigned n)
{
    const char *const temporary = getenv("TMPDIR");
    char folder[256];
    snprintf(folder, sizeof folder, "%s/fieldling-XXXXXX", temporary ? temporary : P_tmpdir);
    if (!mkdtemp(folder)) {
        perror(folder);
        exit(2);
    }
    for (unsigned i = 0; i < n; i++)
        stations[i] = (struct station){load(image, folder, i), (uint8_t)(i + 1)};
    rmdir(folder);
}

/* Each slave gets other outputs in each cycle, and must send them back one higher. */
static void before(struct dp_master *master, struct dp_slave *s)
{
    (void)master;
    s->outputs[0] = (uint8_t)(s->exchanges / 4 + s->address);
    s->outputs[1] = (uint8_t)~s->outputs[0];
}

static void begin(unsigned n, uint8_t baud)
{
    memset(&line, 0, sizeof line);
    stations_n = n;
    line.bit = stations[0].is->bit(baud);
    line.max_t_sdr = stations[0].is->max_t_sdr(baud);
    for (unsigned i = 0; i < n; i++) {
        stations[i].is->power_on(stations[i].address, baud, on_says, &stations[i]);
        slaves[i] = (struct dp_slave){.address = stations[i].address,
                                      .ident = 0x1234,
                                      .station_status = 0x88,
                                      .wd1 = 255,
                                      .wd2 = 2,
                                      .min_t_sdr = 11,
                                      .cfg_n = 4,
                                      .cfg = {0x10, 0x20, 0x10, 0x20},
                                      .out_n = 2,
                                      .in_n = 2};
    }
    m = (struct dp_master){.ini = {.address = MASTER,
                                   .bit = line.bit,
                                   .slot = (line.max_t_sdr + 22) * line.bit,
                                   .gap = 33 * line.bit,
                                   .send = on_send},
                           .slaves = slaves,
                           .slaves_n = n,
                           .before = before};
    dpm_begin(&m);
    everybody_until(50 * line.bit);
}

/* The master's time goes on alone: nothing that a station does meanwhile changes what it will hear. */
static void master_until(uint64_t t)
{
    line.now = t;
    dpm_poll(&m, t);
}

/* The answer has been worked out when the request went out: now the master hears it. */
static void hear_answer(void)
{
    const unsigned n = line.n;
    uint8_t octets[TG_MAX];
    uint64_t ends[TG_MAX];
    memcpy(octets, line.octets, n);
    memcpy(ends, line.ends, n * sizeof ends[0]);
    line.n = 0;
    while (n && dpm_due(&m) < ends[0])
        master_until(dpm_due(&m));
    for (unsigned i = 0; i < n; i++) {
        line.now = ends[i];
        dpm_hear(&m, ends[i], octets[i], 0);
    }
}

static void run(unsigned cycles)
{
    while (m.cycles < cycles) {
        const uint64_t due = dpm_due(&m);
        if (due > line.now)
            everybody_until(due);
        dpm_poll(&m, line.now);
        hear_answer();
    }
}

/* ---- what is said about it ------------------------------------------------------------------------------- */

/* -> all stations exchange data, each its own, and nobody broke a rule. */
static bool judge(bool aloud)
{
    unsigned in_exchange = 0, alone = 0, fewest = UINT32_MAX;
    for (unsigned i = 0; i < stations_n; i++) {
        uint8_t state;
        uint16_t exchanges, foreign;
        stations[i].is->look(&state, &exchanges, &foreign);
        in_exchange += state == 3 && slaves[i].state == DP_EXCHANGE && slaves[i].starts == 1;
        alone += exchanges == (uint16_t)slaves[i].exchanges &&
                 slaves[i].lost + slaves[i].wrong + slaves[i].refusals == 0;
        fewest = slaves[i].exchanges < fewest ? slaves[i].exchanges : fewest;
    }
    if (aloud)
        printf("stations %u in_exchange %u exact %u fewest_exchanges %u cycle_ms %.3f retries %u collisions "
               "%lu early %lu "
               "late %lu\n",
               stations_n, in_exchange, alone, fewest, (double)m.cycle_time / 576000, m.ini.resent,
               line.collisions, line.early, line.late);
    return in_exchange == stations_n && alone == stations_n && m.ini.resent == 0 &&
           line.collisions + line.early + line.late == 0;
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec / 1e9;
}

static double measure(unsigned n, unsigned telegrams)
{
    begin(n, 4);
    run(8);
    const unsigned long before_ = line.telegrams;
    const double start = seconds();
    run(8 + telegrams / 2 / n);
    return (seconds() - start) / (double)(line.telegrams - before_);
}

static int bench(void)
{
    static const unsigned sizes[] = {1, 2, 4, 8, 16, 32, 64, 124};
    double first = 0, per = 0;
    printf(
        "Many stations on one segment in virtual time, 500 kbit/s, telegrams of 11 octets (processor time):\n"
        "  stations   us/telegram   ns/telegram and further station\n");
    for (unsigned i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        per = measure(sizes[i], 200000 / sizes[i] + 8 * sizes[i]);
        first = i ? first : per;
        printf("  %8u %13.2f", sizes[i], per * 1e6);
        if (i)
            printf(" %17.0f", (per - first) / (sizes[i] - 1) * 1e9);
        printf("\n");
    }
    printf("(the virtual port included; the station's own instructions are under \"to another station\" of "
           "bench-dp)\n");
    return judge(false) ? 0 : 1;
}

/* Two stations with the same address: what must be noticed. */
static int twins(void)
{
    stations[1].address = stations[0].address;
    begin(2, 4);
    m.slaves_n = 1;
    run(10);
    return judge(true) ? 0 : 1;
}

/* argv: STATIONS [CYCLES [BAUD_RATE_CODE [RECORD]]]; -> exit status, 2: no such numbers. */
static int bring_up(int argc, char **argv, const char *image)
{
    const unsigned n = (unsigned)strtoul(argv[0], NULL, 10);
    const unsigned cycles = argc > 1 ? (unsigned)strtoul(argv[1], NULL, 10) : 20;
    const unsigned baud = argc > 2 ? (unsigned)strtoul(argv[2], NULL, 10) : 4;
    if (n < 1 || n > STATIONS || cycles < 1 || baud >= RATES)
        return 2;
    load_all(image, n);
    begin(n, (uint8_t)baud);
    record = argc > 3 ? fopen(argv[3], "w") : NULL;
    if (record)
        fprintf(record, "# rate %llu\n", 576000000ULL / line.bit);
    run(cycles);
    if (argc > 3 && (!record || fclose(record) != 0)) {
        perror(argv[3]);
        return 2;
    }
    return judge(true) ? 0 : 1;
}

int main(int argc, char **argv)
{
    int status = 2;
    if (argc > 2 && strcmp(argv[2], "bench") == 0) {
        load_all(argv[1], STATIONS);
        return bench();
    }
    if (argc > 2 && strcmp(argv[2], "twins") == 0) {
        load_all(argv[1], 2);
        return twins();
    }
    if (argc > 2)
        status = bring_up(argc - 2, argv + 2, argv[1]);
    if (status == 2)
        fprintf(stderr,
                "usage: fieldling-many IMAGE STATIONS [CYCLES [BAUD_RATE_CODE [RECORD]]]   1 to %d stations\n"
                "       fieldling-many IMAGE bench | twins\n"
                "IMAGE is fieldling-station.so beside this program; RECORD is written for fieldling-mon.\n"
                "Exit status 1: not all exchange data, or a rule of the line was broken (as by two twins).\n",
                STATIONS);
    return status;
}
