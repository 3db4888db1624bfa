/* Full-screen display of the HDLC master station. With ncurses at build time (master_screen.c), or without
 * (master_screen_none.c). */
#ifndef FIELDLING_MASTER_SCREEN_H
#define FIELDLING_MASTER_SCREEN_H

#include "sim/hdlc_primary.h"

/* Take the terminal. -> NULL, or why not, for a person. Given back at exit(). */
const char *screen_open(void);

/* Draw all, at most some times a second; load in percent of the line's capacity. */
void screen_draw(const struct hp *p, double load, uint64_t now_ms);

/* A line for the log at the bottom. */
void screen_log(const char *line);

/* A key of the keyboard -> a whole command line when it was Enter, else NULL. *quit: the operator wants to leave. */
const char *screen_key(int key, bool *quit);

#endif
