/* The inverter live, `make run PROTOCOL=modbus`: starts a station on a pseudo terminal and polls it with
 * libmodbus, a client nobody here wrote. On a terminal until Ctrl-C; else about ten seconds, then one summary
 * line and status 0, or 1 if requests failed.
 *
 *   modbus-live STATION   the program to start; it is given --line pty:... */
#include "boards/common/inverter_map.h"

#include <errno.h>
#include <modbus.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define PERIOD_MS 200
#define SECONDS   10 /* when the output is no terminal */

static const struct {
    const char *name, *unit;
} values[] = {
#define ROW(name, unit, text) {#name, unit},
    INV_VALUES(ROW)};

static const char *const inputs[] = {
#define INPUT_ROW(name, text) #name,
    INV_INPUTS(INPUT_ROW)};

/* What the operator does, again and again. */
static const struct {
    int at_s;
    const char *says;
    int coil, on; /* coil -1: none */
    int param;    /* -1: none */
    uint16_t value;
} script[] = {
    {0, "set point 30 Hz", -1, 0, INV_P_SET_POINT, 3000},
    {0, "run", INV_COIL_RUN, 1, -1, 0},
    {3, "set point 50 Hz", -1, 0, INV_P_SET_POINT, 5000},
    {5, "load 130 %", -1, 0, INV_P_LOAD, 130},
    {6, "load 60 %", -1, 0, INV_P_LOAD, 60},
    {7, "stop", INV_COIL_RUN, 0, -1, 0},
};
#define PERIOD_S 11

static volatile sig_atomic_t stopping;
static char folder[64], line[80];
static unsigned requests, failed;
static double slowest_ms;

static void note_signal(int number)
{
    (void)number;
    stopping = 1;
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static void sleep_ms(long ms)
{
    const struct timespec t = {ms / 1000, ms % 1000 * 1000000};
    nanosleep(&t, NULL);
}

/* -> process id, -1: it did not start */
static pid_t start_station(const char *program)
{
    char option[100];
    struct stat s;
    const char *const tmp = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/fieldling-XXXXXX", tmp && strlen(tmp) < 40 ? tmp : P_tmpdir);
    if (!mkdtemp(folder))
        return -1;
    snprintf(line, sizeof line, "%s/line", folder);
    snprintf(option, sizeof option, "pty:%s", line);
    const pid_t child = fork();
    if (child == 0) {
        if (!freopen("/dev/null", "r", stdin) || !freopen("/dev/null", "w", stdout))
            _exit(127);
        execl(program, program, "--line", option, (char *)NULL);
        _exit(127);
    }
    for (int i = 0; i < 500 && lstat(line, &s) != 0; i++) {
        if (waitpid(child, NULL, WNOHANG) == child)
            return -1;
        sleep_ms(10);
    }
    return child;
}

static bool done(int result, double since)
{
    const double took = now_ms() - since;
    requests++;
    failed += result < 0;
    if (took > slowest_ms)
        slowest_ms = took;
    return result >= 0;
}

static void operate(modbus_t *m, int second, const char **says)
{
    for (unsigned i = 0; i < sizeof script / sizeof *script; i++) {
        if (script[i].at_s != second)
            continue;
        const double t = now_ms();
        *says = script[i].says;
        if (script[i].coil >= 0)
            done(modbus_write_bit(m, script[i].coil, script[i].on), t);
        else
            done(modbus_write_register(m, script[i].param, script[i].value), t);
    }
}

static void show(bool live, double s, const uint16_t *v, const uint8_t *in, const char *says)
{
    if (!live) {
        printf("%4.1f s  %5.2f Hz  %5.1f V  %5.2f A  bus %5.1f V  %4.1f degC  trip %u  requests %u  failed "
               "%u  %s\n",
               s, v[INV_V_OUTPUT_FREQ] / 100.0, v[INV_V_OUTPUT_VOLTAGE] / 10.0,
               v[INV_V_OUTPUT_CURRENT] / 100.0, v[INV_V_DC_BUS] / 10.0, v[INV_V_TEMPERATURE] / 10.0,
               v[INV_V_TRIP_CODE], requests, failed, says);
        fflush(stdout);
        return;
    }
    printf("\033[H\033[JInverter at address 1, Modbus RTU on %s, polled by libmodbus          %.1f s\n\n",
           line, s);
    for (unsigned i = 0; i < INV_V_COUNT; i++)
        printf("  3%04u  %-18s %7u  %s\n", i + 1, values[i].name, v[i], values[i].unit);
    printf("\n ");
    for (unsigned i = 0; i < INV_IN_COUNT; i++)
        printf(" %s%s\033[0m", in[i] ? "\033[7m" : "\033[2m", inputs[i]);
    printf("\n\n  %.*s\n", v[INV_V_OUTPUT_FREQ] / 100, "##################################################");
    printf("\n  operator: %s\n  %u requests, %u failed, slowest %.1f ms          Ctrl-C ends\n", says,
           requests, failed, slowest_ms);
    fflush(stdout);
}

static void poll_it(modbus_t *m, bool live)
{
    static const uint16_t ramps[2] = {30, 30};
    uint16_t v[INV_V_COUNT] = {0};
    uint8_t in[INV_IN_COUNT] = {0};
    const char *says = "";
    const double start = now_ms();
    int second = -1;
    done(modbus_write_registers(m, INV_P_ACCEL_TIME, 2, ramps), now_ms());
    while (!stopping) {
        const double s = (now_ms() - start) / 1e3;
        const bool new_second = (int)s != second;
        if (!live && s >= SECONDS)
            return;
        second = (int)s;
        if (new_second)
            operate(m, second % PERIOD_S, &says);
        double t = now_ms();
        if (!done(modbus_read_input_registers(m, 0, INV_V_COUNT, v), t))
            says = modbus_strerror(errno);
        t = now_ms();
        done(modbus_read_input_bits(m, 0, INV_IN_COUNT, in), t);
        if (live || new_second)
            show(live, s, v, in, says);
        sleep_ms(PERIOD_MS);
    }
}

int main(int argc, char **argv)
{
    const bool live = isatty(STDOUT_FILENO);
    const struct sigaction note = {.sa_handler = note_signal};
    sigaction(SIGINT, &note, NULL);
    sigaction(SIGTERM, &note, NULL);
    const pid_t station = argc == 2 ? start_station(argv[1]) : -1;
    if (station < 0) {
        fprintf(stderr, "usage: modbus-live STATION (which must start)\n");
        return 2;
    }
    modbus_t *const m = modbus_new_rtu(line, 19200, 'N', 8, 1);
    if (m && modbus_set_slave(m, 1) == 0 && modbus_connect(m) == 0)
        poll_it(m, live);
    modbus_close(m);
    modbus_free(m);
    kill(station, SIGTERM);
    waitpid(station, NULL, 0);
    rmdir(folder);
    printf("%smodbus: %u requests, %u failed, slowest answer %.1f ms\n", live ? "\n" : "", requests, failed,
           slowest_ms);
    return requests > 1 && failed == 0 ? 0 : 1;
}
