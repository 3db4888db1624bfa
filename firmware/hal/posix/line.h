/* The two kinds of serial line a host has: a fresh pseudo terminal, and a real serial port. Internal to the
 * real-time port. */
#ifndef FIELDLING_LINE_H
#define FIELDLING_LINE_H

#include <stdbool.h>
#include <stdint.h>

struct line {
    int fd;        /* octets in and out; non-blocking                                             */
    int event_fd;  /* readable: call event(); -1 = there is none                                  */
    bool present;  /* someone is at the other end; if not, do not read or poll, and what is sent is lost */
    bool bit_time; /* sending takes time                                                          */
    bool marked;   /* input is coded by PARMRK: line_unmark()                                     */

    /* Rate [bit/s], format (enum hal_format); empties the receiver. False: the driver refused, all is as
     * before. */
    bool (*set)(struct line *line, uint32_t bit_per_s, uint8_t format);
    void (*event)(struct line *line);  /* event_fd is readable                          */
    void (*hangup)(struct line *line); /* read() or write() says that the other end is gone */
    void (*close)(struct line *line);  /* put back and remove what was made             */
};

/* Open the line. -> NULL, or what is wrong, for a person (valid until the next call).
 * pty: a fresh pseudo terminal in raw mode and a symbolic link to it at path. A link to a terminal that is
 * there already is replaced, anything else is left alone and is an error. tty: a serial port; also an end of
 * somebody else's pseudo terminal pair, which then has no bit time or parity. */
const char *line_pty_open(struct line *line, const char *path);
const char *line_tty_open(struct line *line, const char *device);

/* Decode one octet of PARMRK input; *state starts as 0. True: *octet with *err (HAL_ERR_*) is complete. */
bool line_unmark(uint8_t *state, uint8_t in, uint8_t *octet, uint8_t *err);

/* "path: what: reason of errno". Returns a static string. */
const char *line_error(const char *path, const char *what);

#endif
