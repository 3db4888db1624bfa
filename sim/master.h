/* The parts of fieldling-master: what both classes share. */
#ifndef SIM_MASTER_H
#define SIM_MASTER_H

#include "sim/master_line.h"
#include "sim/master_setup.h"

/* Exit statuses. */
enum { M_OK = 0, M_REFUSED = 1, M_USAGE = 2, M_SILENT = 3, M_LINE = 4 };

struct master_options {
    bool json;
    unsigned seconds, cycles; /* 0: until a signal or "quit" */
    unsigned cycle_ms;        /* shortest bus cycle */
    bool clear;               /* start in Clear instead of Operate */
    bool count;               /* outputs count up, to have something to look at */
};

/* One class 2 command; words[0] is the verb, words[1..n-1] its arguments. -> exit status. */
int master_ask(struct master_line *l, struct ini *ini, const struct master_options *o, char **words, int n);
bool master_knows(const char *verb);

/* Class 1, until told to stop. -> exit status. */
int master_cyclic(struct master_line *l, struct setup *s, const struct ini *ini,
                  const struct master_options *o);
extern volatile bool master_stop; /* set by a signal */

/* What is said: one JSON object, or "name: value" lines. say_begin(), say_...(), say_end(). */
void say_begin(bool json);
void say_text(const char *name, const char *format, ...) __attribute__((format(printf, 2, 3)));
void say_number(const char *name, unsigned long value);
void say_octets(const char *name, const uint8_t *o, unsigned n);
void say_list(const char *name, const char *const *words, unsigned n);
void say_end(void);

#endif
