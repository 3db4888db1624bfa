/* What a host program says to the real-time port beyond hal.h. All of it is main.
 *
 * main(): options -> hal_host_open() -> hal_init() -> stack -> loop { stack; console; hal_idle(); } */
#ifndef FIELDLING_HAL_HOST_H
#define FIELDLING_HAL_HOST_H

#include <stdbool.h>
#include <stdint.h>

struct hal_host {
    const char *line; /* "pty:PATH", or the device of a real serial line                         */
    const char *nv;   /* file that keeps the non-volatile octets; NULL = forgotten at the end    */
    uint8_t switches; /* what the address switches say, 0..127                                   */
};

/* Open line and non-volatile memory, set up signals and the removal of the symbolic link at exit(). SIGTERM,
 * SIGINT and SIGHUP are noted; SIGPIPE and SIGTTIN are ignored. -> NULL, or what is wrong, for a person. */
const char *hal_host_open(const struct hal_host *host);

/* A signal asked the program to end: leave the main loop and exit(0). */
bool hal_host_stopping(void);

/* For a trace; NULL = nobody listens. Called for every run of octets heard or sent, in the order of the line,
 * before the stack sees them; octets are valid until return; err[i] = HAL_ERR_*, NULL for a run sent. isr. */
extern void (*hal_host_tap)(const uint8_t *octets, const uint8_t *err, uint16_t n);

/* Parts of the port in files of their own. nv_file.c: -> NULL, or what is wrong. */
const char *nv_file_open(const char *path);

/* con_stdio.c: what to poll for console input, -1 while there is no room or no more input; and: it is
 * readable. */
int con_input(void);
void con_read(void);

#endif
