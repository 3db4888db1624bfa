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

/* From now on Ctrl-C comes as a key that ends a line of commands, if standard input is a terminal and ours: a signal
 * would go to make, too, which then ends with an error. Is it in what was read? */
void master_keys(void);
bool master_interrupted(const char *text, size_t n);

/* Call before printing while a class 1 master runs: its live table makes room and is drawn again below. */
void master_make_room(void);

/* What a line that knows its other end shows beside what the master shows. With --json only begin and end are
 * called. */
struct ml_view {
    unsigned lines; /* of below() */
    void (*begin)(const struct dp_master *m, const struct master_options *o);
    void (*below)(void);  /* live: print the lines below the master's table */
    void (*second)(void); /* without a terminal, in the place of the master's changes and table: a line, once
                             a second */
    bool (*end)(bool all, bool json); /* print the end; all: every slave exchanges data. -> all is well */
};

/* What is said: one JSON object, or "name: value" lines. say_begin(), say_...(), say_end(). */
void say_begin(bool json);
void say_text(const char *name, const char *format, ...) __attribute__((format(printf, 2, 3)));
void say_number(const char *name, unsigned long value);
void say_octets(const char *name, const uint8_t *o, unsigned n);
void say_list(const char *name, const char *const *words, unsigned n);
void say_end(void);

#endif
