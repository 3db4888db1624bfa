/* A pseudo terminal as a serial line. It stays while masters come and go.
 *
 * The kernel keeps what is written to a pty nobody has open, and gives it to whoever opens it next. A line
 * does not: so nothing is written while nobody is there, and what the last one left unread is dropped.
 * Whether someone is there the kernel says by POLLHUP on our end, but as a level: polling it would spin.
 * inotify on the other end tells when to look again. */
#define _GNU_SOURCE /* ptsname_r() */
#include "line.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#define PTS_DIR "/dev/pts/"

static char link_path[PATH_MAX];
static char pts[64];
static int watch = -1;
static bool opened_before;

const char *line_error(const char *path, const char *what)
{
    static char text[PATH_MAX + 128];

    if (errno)
        snprintf(text, sizeof text, "%s: %s: %s", path, what, strerror(errno));
    else
        snprintf(text, sizeof text, "%s: %s", path, what);
    return text;
}

static bool nobody_there(const struct line *line)
{
    struct pollfd p = {.fd = line->fd};

    return poll(&p, 1, 0) > 0 && (p.revents & POLLHUP);
}

static void drain_events(const struct line *line)
{
    char events[1024];

    while (read(line->event_fd, events, sizeof events) > 0) {
    }
}

/* Drop what the other end has not read. With `rest`, also put its settings back to raw at a rate no one uses:
 * each new client then has something to change, without which tcsetattr() with parity fails on a pty
 * (EINVAL). */
static bool empty_other_end(bool rest)
{
    int fd = open(pts, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    struct termios t;
    bool ok;

    if (fd < 0)
        return false;
    ok = tcflush(fd, TCIFLUSH) == 0;
    if (rest && tcgetattr(fd, &t) == 0) {
        t.c_iflag = 0;
        t.c_oflag = 0;
        t.c_lflag = 0;
        t.c_cflag = CS8 | CREAD | CLOCAL;
        t.c_cc[VMIN] = 1;
        t.c_cc[VTIME] = 0;
        cfsetispeed(&t, B50);
        cfsetospeed(&t, B50);
        ok = tcsetattr(fd, TCSANOW, &t) == 0 && ok;
    }
    close(fd);
    return ok;
}

static void pty_event(struct line *line)
{
    drain_events(line);
    if (nobody_there(line))
        return; /* if that is news, read() says so after the last octet */
    if (!line->present) {
        line->present = true;
        return;
    }
    /* Someone came or went, perhaps one for another: what is unread may be for the one who went. Our own
     * opening must not be an event. */
    inotify_rm_watch(line->event_fd, watch);
    empty_other_end(false);
    watch = inotify_add_watch(line->event_fd, pts, IN_OPEN | IN_CLOSE);
    drain_events(line);
}

static void pty_hangup(struct line *line)
{
    line->present = false;
    empty_other_end(true);
}

static bool pty_set(struct line *line, uint32_t bit_per_s, uint8_t format)
{
    (void)format; /* a pty has neither rate nor format: any will do */
    if (bit_per_s == 0)
        return false;
    if (opened_before)
        tcflush(line->fd, TCIFLUSH);
    opened_before = true;
    return true;
}

static void pty_close(struct line *line)
{
    char target[sizeof pts];
    ssize_t n = readlink(link_path, target, sizeof target);

    /* Another station may have taken the path over: then the link is not ours any more. */
    if (n == (ssize_t)strlen(pts) && memcmp(target, pts, (size_t)n) == 0)
        unlink(link_path);
    close(line->fd);
}

/* Free the path of what a station that was killed has left. */
static const char *make_room(const char *path)
{
    struct stat st;
    char target[PATH_MAX];
    ssize_t n;

    errno = 0;
    if (*path == '\0' || strlen(path) >= sizeof link_path)
        return line_error("pty:", "a path is missing or too long");
    if (lstat(path, &st) != 0)
        return errno == ENOENT ? NULL : line_error(path, "cannot make a link there");
    n = readlink(path, target, sizeof target);
    errno = 0;
    if (!S_ISLNK(st.st_mode) || n < 0 || strncmp(target, PTS_DIR, strlen(PTS_DIR)) != 0)
        return line_error(
            path, "exists and is not the link of an earlier station; remove it or choose another path");
    return unlink(path) == 0 ? NULL : line_error(path, "cannot replace the link");
}

const char *line_pty_open(struct line *line, const char *path)
{
    const char *wrong = make_room(path);

    if (wrong)
        return wrong;
    *line = (struct line){.set = pty_set, .event = pty_event, .hangup = pty_hangup, .close = pty_close};
    line->fd = posix_openpt(O_RDWR | O_NOCTTY);
    if (line->fd < 0 || grantpt(line->fd) != 0 || unlockpt(line->fd) != 0 ||
        ptsname_r(line->fd, pts, sizeof pts) != 0)
        return line_error(path, "cannot make a pseudo terminal");
    fcntl(line->fd, F_SETFD, FD_CLOEXEC);
    fcntl(line->fd, F_SETFL, O_RDWR | O_NONBLOCK);
    line->event_fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    watch = inotify_add_watch(line->event_fd, pts, IN_OPEN | IN_CLOSE);
    if (line->event_fd < 0 || watch < 0)
        return line_error(path, "cannot watch the pseudo terminal");
    if (!empty_other_end(true))
        return line_error(path, "cannot make the pseudo terminal raw");
    if (symlink(pts, path) != 0)
        return line_error(path, "cannot make a link there");
    strcpy(link_path, path);
    return NULL;
}
