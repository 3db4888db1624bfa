/* Exchanges per second over a pseudo terminal: Data_Exchange with fieldling-dp, and beside it a bare loop of read() and
 * write() that sends the same answer to the same octets without looking at them. What is between the two is the station.
 *
 * usage: bench-pty PROGRAM [EXCHANGES] */
#define _GNU_SOURCE
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define ROUNDS 7

/* Slave 8, master 2, DP-TEST01; formats: EN 50170-2 part 4, 4.7. FCB 1, FCB 0, and the answer to both. */
#define N 11
static const uint8_t request[2][N] = {{0x68, 5, 5, 0x68, 8, 2, 0x7D, 1, 2, 0x8A, 0x16},
                                      {0x68, 5, 5, 0x68, 8, 2, 0x5D, 1, 2, 0x6A, 0x16}};
static const uint8_t answer[N] = {0x68, 5, 5, 0x68, 2, 8, 8, 0x1F, 0, 0x31, 0x16};

static pid_t child;

static void end_child(void)
{
    if (child > 0) {
        kill(child, SIGTERM);
        waitpid(child, NULL, 0);
        child = 0;
    }
}

static void die(const char *what)
{
    perror(what);
    end_child();
    exit(1);
}

static void make_raw(int fd)
{
    struct termios t;

    if (tcgetattr(fd, &t) != 0)
        die("tcgetattr");
    cfmakeraw(&t);
    if (tcsetattr(fd, TCSANOW, &t) != 0)
        die("tcsetattr");
}

/* Ask until octets come; true: they are `expected`. */
static int ask(int fd, const uint8_t *octets, size_t n, const uint8_t *expected, size_t expected_n)
{
    uint8_t got[256];
    size_t at = 0;

    if (write(fd, octets, n) != (ssize_t)n)
        die("write");
    while (at < expected_n) {
        ssize_t k = read(fd, got + at, sizeof got - at);

        if (k <= 0)
            die("read");
        at += (size_t)k;
    }
    return memcmp(got, expected, expected_n) == 0;
}

static double exchanges_per_s(int fd, unsigned count)
{
    struct timespec start, end;
    unsigned wrong = 0;

    clock_gettime(CLOCK_MONOTONIC, &start);
    for (unsigned i = 0; i < count; i++)
        wrong += !ask(fd, request[i & 1], N, answer, N);
    clock_gettime(CLOCK_MONOTONIC, &end);
    if (wrong) {
        fprintf(stderr, "%u wrong answers\n", wrong);
        end_child();
        exit(1);
    }
    return count / ((double)(end.tv_sec - start.tv_sec) + (double)(end.tv_nsec - start.tv_nsec) * 1e-9);
}

static void bare_loop(int fd)
{
    uint8_t octets[4096];

    while (read(fd, octets, sizeof octets) > 0)
        if (write(fd, answer, N) != N)
            break;
    _exit(0);
}

static double bare(unsigned count)
{
    int there = posix_openpt(O_RDWR | O_NOCTTY);
    double result;
    int here;

    if (there < 0 || grantpt(there) != 0 || unlockpt(there) != 0)
        die("pty");
    here = open(ptsname(there), O_RDWR | O_NOCTTY);
    if (here < 0)
        die("pty");
    make_raw(here);
    child = fork();
    if (child == 0)
        bare_loop(there);
    result = exchanges_per_s(here, count);
    end_child();
    close(here);
    close(there);
    return result;
}

static void start_station(const char *program, const char *path)
{
    char line[128];

    snprintf(line, sizeof line, "pty:%s", path);
    child = fork();
    if (child == 0) {
        int none = open("/dev/null", O_RDONLY);

        dup2(none, STDIN_FILENO);
        execl(program, program, "--line", line, "--address", "8", (char *)NULL);
        _exit(127);
    }
}

/* Patient to the opening of the line and deaf to the first request, as a master is. */
static int open_line(const char *path)
{
    const struct timespec ms = {.tv_nsec = 1000000};
    int fd = -1;

    for (int i = 0; i < 5000 && fd < 0; i++) {
        nanosleep(&ms, NULL);
        fd = open(path, O_RDWR | O_NOCTTY);
    }
    if (fd < 0)
        die(path);
    make_raw(fd);
    for (int i = 0; i < 50; i++)
        nanosleep(&ms, NULL);
    return fd;
}

static double station(const char *program, const char *path, unsigned count)
{
    static const uint8_t prm[] = {0x68, 0x0C, 0x0C, 0x68, 0x88, 0x82, 0x7D, 0x3D, 0x3E,
                                  0x80, 0,    0,    11,   0x12, 0x34, 0,    0xD3, 0x16};
    static const uint8_t cfg[] = {0x68, 9,    9,    0x68, 0x88, 0x82, 0x5D, 0x3E,
                                  0x3E, 0x10, 0x20, 0x10, 0x20, 0x43, 0x16};
    static const uint8_t diag[] = {0x68, 5, 5, 0x68, 0x88, 0x82, 0x7D, 0x3C, 0x3E, 0x01, 0x16};
    static const uint8_t ready[] = {0x68, 11, 11, 0x68, 0x82, 0x88, 8,    0x3E, 0x3C,
                                    0x00, 4,  0,  2,    0x12, 0x34, 0xD8, 0x16};
    static const uint8_t sc[] = {0xE5};
    double result;
    int fd;

    start_station(program, path);
    fd = open_line(path);
    if (!ask(fd, prm, sizeof prm, sc, 1) || !ask(fd, cfg, sizeof cfg, sc, 1))
        die("the station does not take its parameters");
    while (!ask(fd, diag, sizeof diag, ready, sizeof ready)) {
    }
    ask(fd, request[1], N, answer, N);
    result = exchanges_per_s(fd, count);
    close(fd);
    end_child();
    return result;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

int main(int argc, char **argv)
{
    char folder[] = P_tmpdir "/fieldling-XXXXXX", path[64];
    double with[ROUNDS], without[ROUNDS];
    unsigned count;

    if (argc < 2 || !mkdtemp(folder))
        return 2;
    count = argc > 2 ? (unsigned)atoi(argv[2]) : 20000u;
    snprintf(path, sizeof path, "%s/line", folder);
    alarm(300);
    for (int i = 0; i < ROUNDS; i++) {
        without[i] = bare(count);
        with[i] = station(argv[1], path, count);
    }
    rmdir(folder);
    qsort(with, ROUNDS, sizeof *with, by_size);
    qsort(without, ROUNDS, sizeof *without, by_size);
    printf("pty, Data_Exchange of 2 octets each way, median of %d rounds of %u:\n"
           "  bare pty loop  %8.0f exchanges/s\n"
           "  fieldling-dp   %8.0f exchanges/s = %.0f %%\n",
           ROUNDS, count, without[ROUNDS / 2], with[ROUNDS / 2],
           100.0 * with[ROUNDS / 2] / without[ROUNDS / 2]);
    return 0;
}
