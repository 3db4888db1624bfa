/* fieldling-hdlc-cable: the pair of wires between the pseudo terminals of HDLC stations: what one says all others
 * hear, as late as it would be at the line's rate. A station may go away and come back under its path.
 *
 * Octets are eight bits of the line each (fieldling-hdlc --help, coding bits). */
#include "boards/posix/options.h"
#include "sim/hdlc_bits.h"
#include "sim/hdlc_pcap.h"
#include "sim/random.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define ENDS_MAX  32u
#define CHUNK     1024u
#define CHUNKS    64u
#define AGAIN_US  200000u

static struct {
    const char *path;
    int fd;
    uint64_t again_us;
    struct hb_decoder decoder;
} ends[ENDS_MAX];
static unsigned ends_n;

/* What is on its way, oldest first. */
static struct {
    unsigned from, n;
    uint64_t at_us;
    uint8_t octets[CHUNK];
} wire[CHUNKS];
static unsigned wire_at, wire_n;
static uint64_t free_us;

static uint32_t rate = 7200, one_in;
static uint64_t random_state = 1;
static FILE *capture;
static volatile sig_atomic_t stopping;

static uint64_t now_us(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

static void stop(int number)
{
    (void)number;
    stopping = 1;
}

/* ---- command line -------------------------------------------------------------------------------- */

static char list[4096];

static const char *take_ends(const char *value)
{
    if (strlen(value) >= sizeof list)
        return "list too long";
    strcpy(list, value);
    for (char *p = strtok(list, ","); p; p = strtok(NULL, ",")) {
        if (ends_n == ENDS_MAX)
            return "at most 32 stations";
        ends[ends_n].fd = -1;
        ends[ends_n++].path = p;
    }
    return ends_n >= 2 ? NULL : "needs two at least";
}

static const char *take_rate(const char *value)
{
    return option_number(value, 0, 10000000, &rate) ? NULL : "must be bit/s, 0: as fast as it goes";
}

static const char *take_errors(const char *value)
{
    return option_number(value, 1, 1000000000, &one_in) ? NULL : "must be 1..1000000000";
}

static const char *take_seed(const char *value)
{
    uint32_t seed;

    if (!option_number(value, 1, UINT32_MAX, &seed))
        return "must be 1..4294967295";
    random_state = seed;
    return NULL;
}

static const char *take_capture(const char *value)
{
    capture = hdlc_pcap_open(value);
    return capture ? NULL : strerror(errno);
}

static const struct option_row options[] = {
    {"ends", "PATH,PATH...", "the pseudo terminals to connect", take_ends},
    {"rate", "R", "bit/s; 7200 when not given, 0: no waiting", take_rate},
    {"bit-errors", "N", "one bit in N, at random, is turned", take_errors},
    {"seed", "S", "of the random errors", take_seed},
    {"capture", "FILE", "write the frames on the line (pcap, link type SDLC; read it with Wireshark)", take_capture},
    {0}};

/* ---- ends ---------------------------------------------------------------------------------------- */

static void open_end(unsigned i, uint64_t now)
{
    struct termios t;

    if (ends[i].fd >= 0 || now < ends[i].again_us)
        return;
    ends[i].again_us = now + AGAIN_US;
    ends[i].fd = open(ends[i].path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (ends[i].fd < 0)
        return;
    if (tcgetattr(ends[i].fd, &t) == 0) {
        cfmakeraw(&t);
        tcsetattr(ends[i].fd, TCSANOW, &t);
    }
    tcflush(ends[i].fd, TCIOFLUSH);
}

static void close_end(unsigned i)
{
    close(ends[i].fd);
    ends[i].fd = -1;
}

/* ---- the wire ------------------------------------------------------------------------------------ */

static void watch(unsigned from, const uint8_t *octets, unsigned n, uint64_t us)
{
    struct hb_decoder *d = &ends[from].decoder;

    for (unsigned i = 0; i < 8u * n; i++)
        if (hb_decode(d, (octets[i / 8u] >> (i % 8u)) & 1u) == HB_FRAME && capture)
            hdlc_pcap_frame(capture, d->octets, d->n, us);
}

static void spoil(uint8_t *octets, unsigned n)
{
    for (unsigned i = 0; i < 8u * n; i++)
        if (one_in && sim_below(&random_state, one_in) == 0)
            octets[i / 8u] ^= (uint8_t)(1u << (i % 8u));
}

static void take(unsigned from, uint64_t now)
{
    uint8_t octets[CHUNK];
    const ssize_t got = read(ends[from].fd, octets, sizeof octets);
    unsigned at;

    if (got <= 0) {
        if (got == 0 || (errno != EAGAIN && errno != EINTR))
            close_end(from);
        return;
    }
    if (wire_n == CHUNKS)
        return; /* nobody keeps up: lost */
    at = (wire_at + wire_n++) % CHUNKS;
    memcpy(wire[at].octets, octets, (size_t)got);
    wire[at].from = from;
    wire[at].n = (unsigned)got;
    free_us = (free_us > now ? free_us : now) + (rate ? (uint64_t)got * 8000000u / rate : 0);
    wire[at].at_us = free_us;
    spoil(wire[at].octets, wire[at].n);
    watch(from, wire[at].octets, wire[at].n, now);
}

static void deliver(uint64_t now)
{
    while (wire_n && wire[wire_at].at_us <= now) {
        for (unsigned i = 0; i < ends_n; i++)
            if (i != wire[wire_at].from && ends[i].fd >= 0 &&
                write(ends[i].fd, wire[wire_at].octets, wire[wire_at].n) < 0 && errno != EAGAIN)
                close_end(i);
        wire_at = (wire_at + 1u) % CHUNKS;
        wire_n--;
    }
}

static int wait_ms(uint64_t now)
{
    if (!wire_n)
        return 50;
    return wire[wire_at].at_us <= now ? 0 : (int)((wire[wire_at].at_us - now) / 1000u + 1u);
}

int main(int argc, char **argv)
{
    struct sigaction action = {.sa_handler = stop};
    struct pollfd p[ENDS_MAX];

    options_read(argc, argv, "fieldling-hdlc-cable: the line between HDLC stations on pseudo terminals", options,
                 "\nEnds with SIGTERM or SIGINT, status 0.\n");
    if (!ends_n)
        options_unusable("--ends is missing, see --help");
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGINT, &action, NULL);
    signal(SIGPIPE, SIG_IGN);
    while (!stopping) {
        uint64_t now = now_us();
        for (unsigned i = 0; i < ends_n; i++) {
            open_end(i, now);
            p[i] = (struct pollfd){.fd = ends[i].fd, .events = POLLIN};
        }
        poll(p, ends_n, wait_ms(now));
        now = now_us();
        for (unsigned i = 0; i < ends_n; i++)
            if (p[i].fd >= 0 && p[i].revents)
                take(i, now);
        deliver(now);
    }
    return 0;
}
