/* A real serial port. <asm/termbits.h> instead of <termios.h>: only struct termios2 sets any bit rate. */
#include "line.h"
#include "hal/hal.h"

#include <asm/termbits.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#define FORMAT_BITS (CSIZE | PARENB | PARODD | CSTOPB)

/* our choice: a rate that is off by more than 2 % is refused; over 11 bits two ends may differ by about 4 %. */
#define RATE_TOLERANCE 50u

static const char *device_name;
static struct termios2 before; /* settings we found, put back at the end */
static bool is_pty;

static const tcflag_t format_bits[HAL_FORMATS] = {
    [HAL_8E1] = CS8 | PARENB, [HAL_8O1] = CS8 | PARENB | PARODD, [HAL_8N2] = CS8 | CSTOPB, [HAL_8N1] = CS8,
    [HAL_7E1] = CS7 | PARENB, [HAL_7O1] = CS7 | PARENB | PARODD, [HAL_7N2] = CS7 | CSTOPB,
};

/* PARMRK: FF FF is the octet FF, FF 00 x is x with a parity or framing error (termios does not say which), FF
 * 00 00 may be a break as well. */
bool line_unmark(uint8_t *state, uint8_t in, uint8_t *octet, uint8_t *err)
{
    enum { PLAIN, AFTER_FF, AFTER_FF_00 };

    if (*state == PLAIN && in == 0xFF) {
        *state = AFTER_FF;
        return false;
    }
    if (*state == AFTER_FF && in == 0) {
        *state = AFTER_FF_00;
        return false;
    }
    *octet = in;
    *err = *state != AFTER_FF_00 ? 0 : in == 0 ? HAL_ERR_FRAMING | HAL_ERR_BREAK : HAL_ERR_PARITY;
    *state = PLAIN;
    return true;
}

static bool as_asked(const struct termios2 *got, const struct termios2 *asked)
{
    tcflag_t rate = asked->c_ospeed;
    tcflag_t off = got->c_ospeed > rate ? got->c_ospeed - rate : rate - got->c_ospeed;

    return (got->c_cflag & FORMAT_BITS) == (asked->c_cflag & FORMAT_BITS) && off <= rate / RATE_TOLERANCE;
}

static bool tty_set(struct line *line, uint32_t bit_per_s, uint8_t format)
{
    struct termios2 old, t, got;

    if (bit_per_s == 0 || format >= HAL_FORMATS || ioctl(line->fd, TCGETS2, &old) != 0)
        return false;
    t = old;
    t.c_iflag = INPCK | PARMRK;
    t.c_oflag = 0;
    t.c_lflag = 0;
    t.c_cflag = CREAD | CLOCAL | HUPCL | BOTHER | format_bits[format];
    t.c_ispeed = bit_per_s;
    t.c_ospeed = bit_per_s;
    t.c_cc[VMIN] = 1;
    t.c_cc[VTIME] = 0;
    if (ioctl(line->fd, TCSETS2, &t) != 0)
        return false;
    if (!is_pty && (ioctl(line->fd, TCGETS2, &got) != 0 || !as_asked(&got, &t))) {
        ioctl(line->fd, TCSETS2, &old);
        return false;
    }
    ioctl(line->fd, TCFLSH, TCIOFLUSH);
    return true;
}

static void tty_hangup(struct line *line)
{
    (void)line;
    fprintf(stderr, "%s: the serial port is gone\n", device_name);
    exit(1);
}

static void tty_close(struct line *line)
{
    ioctl(line->fd, TCSETS2, &before);
    close(line->fd);
}

/* Driver enable by the kernel where the driver offers it; an adapter that switches by itself does not. Low
 * latency makes USB adapters hand octets over after 1 ms instead of 16. Neither is there on every port:
 * errors are no faults. */
static void ask_for_rs485(int fd)
{
    struct serial_rs485 rs485 = {.flags = SER_RS485_ENABLED | SER_RS485_RTS_ON_SEND};
    struct serial_struct serial;

    ioctl(fd, TIOCSRS485, &rs485);
    if (ioctl(fd, TIOCGSERIAL, &serial) == 0) {
        serial.flags |= (int)ASYNC_LOW_LATENCY;
        ioctl(fd, TIOCSSERIAL, &serial);
    }
}

const char *line_tty_open(struct line *line, const char *device)
{
    struct stat st;

    *line = (struct line){.event_fd = -1, .present = true, .marked = true};
    line->set = tty_set;
    line->hangup = tty_hangup;
    line->close = tty_close;
    device_name = device;
    line->fd = open(device, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (line->fd < 0 || fstat(line->fd, &st) != 0)
        return line_error(device, "cannot open");
    if (ioctl(line->fd, TCGETS2, &before) != 0) {
        errno = 0;
        return line_error(device, "is not a serial port");
    }
    is_pty = major(st.st_rdev) >= 136 &&
             major(st.st_rdev) <= 143; /* Unix98 pty: Documentation/admin-guide/devices */
    line->bit_time = !is_pty;
    if (!is_pty) {
        if (ioctl(line->fd, TIOCEXCL) != 0)
            return line_error(device, "cannot have it alone");
        ask_for_rs485(line->fd);
    }
    return NULL;
}
