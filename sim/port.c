#include "sim/port.h"

#include <asm/termbits.h> /* struct termios2: any rate */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static const struct {
    const char *name;
    tcflag_t flags;
} formats[PORT_FORMATS] = {
    {"8E1", CS8 | PARENB}, {"8O1", CS8 | PARENB | PARODD}, {"8N1", CS8},          {"8N2", CS8 | CSTOPB},
    {"7E1", CS7 | PARENB}, {"7O1", CS7 | PARENB | PARODD}, {"7N2", CS7 | CSTOPB},
};

enum port_format port_format_named(const char *name)
{
    unsigned i = 0;
    while (i < PORT_FORMATS && strcmp(name, formats[i].name) != 0)
        i++;
    return (enum port_format)i;
}

/* A pty has neither rate nor parity, and may refuse both: that is no fault. A real line must take them. */
static bool set_up(int fd, uint32_t rate, enum port_format format)
{
    struct termios2 t, got;
    if (ioctl(fd, TCGETS2, &t) < 0)
        return false;
    t.c_iflag = IGNBRK;
    t.c_oflag = 0;
    t.c_lflag = 0;
    t.c_cflag = formats[format].flags | CREAD | CLOCAL | BOTHER;
    t.c_ispeed = t.c_ospeed = rate;
    t.c_cc[VMIN] = 0;
    t.c_cc[VTIME] = 0;
    if (ioctl(fd, TCSETS2, &t) < 0)
        return false;
    ioctl(fd, TCFLSH, TCIFLUSH); /* what came before it was set up may have been changed on its way */
    return ioctl(fd, TCGETS2, &got) == 0;
}

int port_open(const char *path, uint32_t rate, enum port_format format, const char **why)
{
    const int fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (fd < 0) {
        *why = strerror(errno);
        return -1;
    }
    if (!isatty(fd) || !set_up(fd, rate, format)) {
        *why = isatty(fd) ? strerror(errno) : "not a serial line or pty";
        close(fd);
        return -1;
    }
    return fd;
}

bool port_mark_errors(int fd)
{
    struct termios2 t;
    if (ioctl(fd, TCGETS2, &t) < 0)
        return false;
    t.c_iflag = (t.c_iflag & ~(tcflag_t)(IGNBRK | IGNPAR | ISTRIP)) | INPCK | PARMRK;
    return ioctl(fd, TCSETS2, &t) == 0;
}

/* PARMRK (termios): a damaged octet X is read as FF 00 X, a good FF as FF FF. */
unsigned port_unmark(struct port_marks *m, uint8_t *octets, uint8_t *err, unsigned n)
{
    enum { PLAIN, AFTER_FF, DAMAGED };
    unsigned left = 0;
    for (unsigned i = 0; i < n; i++) {
        const uint8_t octet = octets[i];
        if (m->state == PLAIN && octet == 0xFF) {
            m->state = AFTER_FF;
        } else if (m->state == AFTER_FF && octet == 0) {
            m->state = DAMAGED;
        } else {
            err[left] = m->state == DAMAGED ? PORT_PARITY : 0;
            octets[left++] = octet;
            m->state = PLAIN;
        }
    }
    return left;
}

static uint64_t clock_ns(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (uint64_t)t.tv_sec * 1000000000u + (uint64_t)t.tv_nsec;
}

uint64_t port_now(void)
{
    return clock_ns(CLOCK_REALTIME);
}

uint64_t port_steady(void)
{
    return clock_ns(CLOCK_MONOTONIC);
}
