/* fieldling-segment: an RS-485 segment for processes. Makes one pseudo terminal for each PATH; what one writes, all
 * others hear, in chunks as they are written. Has no clock and judges nothing: that is what sim/segment.c does.
 *
 * The kernel keeps what is written to a pty that nobody has open; a line does not. So nothing is written where nobody
 * is, and what a station leaves unread when it goes is dropped. A pty carries no parity: an octet that a fault damages
 * beyond its value does not arrive.
 */
#include "sim/faults.h"
#include "sim/random.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <termios.h>
#include <unistd.h>

#define PORTS_MAX 16
#define LOOK_MS   20 /* how often an unused port is looked at */

struct port {
    const char *path;
    char pts[64];
    int fd;
    bool present;
};

static struct port ports[PORTS_MAX];
static int ports_n;
static volatile sig_atomic_t stop;

static struct {
    enum flt kind;
    unsigned one_in;
    uint64_t random;
} fault = {FLT_NONE, 10, 1};

static void on_signal(int signal)
{
    (void)signal;
    stop = 1;
}

/* ---- ports ----------------------------------------------------------------------------------------------- */

/* Empty the far end and leave it raw, at a rate no fieldbus has: whoever opens it then changes something, without which
 * Linux refuses parity on a pty. */
static bool put_to_rest(const struct port *p)
{
    struct termios t;
    const int fd = open(p->pts, O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (fd < 0)
        return false;
    tcflush(fd, TCIFLUSH);
    bool ok = tcgetattr(fd, &t) == 0;
    if (ok) {
        t.c_iflag = t.c_oflag = t.c_lflag = 0;
        t.c_cflag = CS8 | CREAD | CLOCAL;
        t.c_cc[VMIN] = 1;
        t.c_cc[VTIME] = 0;
        cfsetispeed(&t, B50);
        cfsetospeed(&t, B50);
        ok = tcsetattr(fd, TCSANOW, &t) == 0;
    }
    close(fd);
    return ok;
}

static bool open_port(struct port *p, const char *path)
{
    p->path = path;
    p->fd = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (p->fd < 0 || grantpt(p->fd) != 0 || unlockpt(p->fd) != 0)
        return false;
    snprintf(p->pts, sizeof p->pts, "%s", ptsname(p->fd));
    return put_to_rest(p) && symlink(p->pts, path) == 0;
}

static void look(struct port *p)
{
    struct pollfd f = {.fd = p->fd, .events = POLLIN};
    const bool present = poll(&f, 1, 0) == 0 || !(f.revents & POLLHUP);
    if (p->present && !present)
        put_to_rest(p);
    p->present = present;
}

/* ---- octets ---------------------------------------------------------------------------------------------- */

static void spread(const struct port *from, const uint8_t *octets, size_t n)
{
    if (n == 0)
        return;
    for (struct port *p = ports; p < ports + ports_n; p++)
        if (p != from && p->present && write(p->fd, octets, n) < 0)
            p->present = false; /* it went, or does not read: looked at again soon */
}

static size_t copy(const uint8_t *in, size_t n, uint8_t *out)
{
    memcpy(out, in, n);
    return n;
}

/* What becomes of a chunk that the fault strikes. -> how many octets are left. A chunk is a chunk: what would hit an
 * answer is a chunk lost. */
static size_t damage(const uint8_t *in, size_t n, uint8_t *out)
{
    struct flt_char chars[FLT_CHARS];
    size_t left = 0;
    const enum flt kind = flt_hits_answer(fault.kind) ? FLT_LOST_REQUEST : fault.kind;
    const int len = flt_request(kind, &fault.random, in, (unsigned)n, chars);
    if (len < 0)
        return copy(in, n, out);
    for (int i = 0; i < len; i++)
        if (!chars[i].err)
            out[left++] = chars[i].octet;
    return left;
}

static void carry(struct port *p)
{
    uint8_t in[1024], out[1024 + FLT_CHARS];
    const ssize_t n = read(p->fd, in, sizeof in);
    if (n <= 0)
        return;
    const bool struck = fault.kind != FLT_NONE && sim_below(&fault.random, fault.one_in) == 0;
    if (struck)
        spread(p, out, flt_stranger(fault.kind, &fault.random, out));
    spread(p, out, struck && n <= TG_MAX ? damage(in, (size_t)n, out) : copy(in, (size_t)n, out));
}

static void run(void)
{
    while (!stop) {
        struct pollfd f[PORTS_MAX];
        bool all = true;
        for (int i = 0; i < ports_n; i++) {
            look(&ports[i]);
            all = all && ports[i].present;
            f[i] = (struct pollfd){.fd = ports[i].present ? ports[i].fd : -1, .events = POLLIN};
        }
        poll(f, (nfds_t)ports_n, all ? -1 : LOOK_MS);
        for (int i = 0; i < ports_n; i++)
            if (f[i].revents & POLLIN)
                carry(&ports[i]);
    }
}

/* ---- command line ---------------------------------------------------------------------------------------- */

static int usage(FILE *to)
{
    fprintf(to,
            "usage: fieldling-segment [--fault NAME[:ONE_IN]] [--seed N] PATH PATH [PATH...]\n"
            "One pseudo terminal for each PATH (at most %d); what one writes, all others hear.\n"
            "--fault: one chunk in ONE_IN (default 10) is damaged:\n",
            PORTS_MAX);
    for (int k = 1; k < FLT_KINDS; k++)
        fprintf(to, "  %s\n", flt_reason((enum flt)k));
    return to == stdout ? 0 : 2;
}

static bool set_fault(char *text)
{
    char *const colon = strchr(text, ':');
    if (colon)
        *colon = 0;
    fault.one_in = colon ? (unsigned)strtoul(colon + 1, NULL, 10) : 10;
    for (int k = 0; k < FLT_KINDS; k++) {
        const char *const reason = flt_reason((enum flt)k);
        const size_t n = strcspn(reason, ":");
        if (strlen(text) == n && strncmp(reason, text, n) == 0) {
            fault.kind = (enum flt)k;
            return fault.one_in > 0;
        }
    }
    return false;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0)
            return usage(stdout);
        if (strcmp(argv[i], "--fault") == 0 && i + 1 < argc && set_fault(argv[i + 1]))
            i++;
        else if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc)
            fault.random = strtoull(argv[++i], NULL, 10) | 1;
        else if (argv[i][0] == '-' || ports_n == PORTS_MAX)
            return usage(stderr);
        else
            ports[ports_n++].path = argv[i];
    }
    if (ports_n < 2)
        return usage(stderr);
    signal(SIGINT, on_signal);
    signal(SIGTERM, on_signal);
    signal(SIGPIPE, SIG_IGN);
    int made = 0, status = 0;
    while (made < ports_n && open_port(&ports[made], ports[made].path))
        made++;
    if (made < ports_n) {
        perror(ports[made].path);
        status = 2;
    } else {
        printf("segment of %d\n", ports_n);
        fflush(stdout);
        run();
    }
    while (made > 0)
        unlink(ports[--made].path);
    return status;
}
