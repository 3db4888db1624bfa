/* A serial line or pty as a program for people opens it: any rate, 8E1 by default, octets as they come. */
#ifndef SIM_PORT_H
#define SIM_PORT_H

#include <stdbool.h>
#include <stdint.h>

enum port_format { PORT_8E1, PORT_8O1, PORT_8N1, PORT_8N2, PORT_7E1, PORT_7O1, PORT_7N2, PORT_FORMATS };

/* -> descriptor, non-blocking; -1: *why says what is wrong. */
int port_open(const char *path, uint32_t rate, enum port_format format, const char **why);

/* From now on damaged octets are marked in what is read, and port_unmark() takes the marks off again. -> false: the
 * driver cannot. */
bool port_mark_errors(int fd);

/* Octets as read from such a line, n of them in place. err[i]: 0 or PORT_PARITY (parity or framing: the driver does not
 * say which). A mark may be cut in two by read(): the rest is kept for the next call. -> how many are left. */
#define PORT_PARITY 1u
struct port_marks {
    uint8_t state;
};
unsigned port_unmark(struct port_marks *m, uint8_t *octets, uint8_t *err, unsigned n);

/* Name of a format, "8E1"; its number, or PORT_FORMATS. */
enum port_format port_format_named(const char *name);

/* Nanoseconds of the clock that a person reads (CLOCK_REALTIME) and of one that never jumps. */
uint64_t port_now(void);
uint64_t port_steady(void);

#endif
