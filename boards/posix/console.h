/* The console of a host station, over hal_con_get() and hal_con_put(): one line in, one line of key=value
 * pairs out. All of it is main.
 *
 * A line has at most CONSOLE_LINE octets of printable text and ends with LF or CR LF. Every line is answered
 * by exactly one line. What cannot be done is answered error=REASON and changes nothing; REASON is one word
 * with hyphens: line-too-long, not-text (a control octet or one above 7E in it), empty-line, unknown-command,
 * or a command's own. */
#ifndef FIELDLING_CONSOLE_H
#define FIELDLING_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#define CONSOLE_LINE  1024u
#define CONSOLE_WORDS 128u

/* words[0] is the verb, words[1..n-1] its arguments. The handler says its answer with console_say(). */
struct console_command {
    const char *verb;
    void (*run)(char **words, uint8_t n);
};

/* The commands, the last one without a verb. */
void console_init(const struct console_command *commands);

/* Take waiting octets; carry out at most one line. */
void console_poll(void);

/* Add to the answer, like printf. Without a newline: that follows when the handler returns. */
void console_say(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Replaces what has been said by error=reason. */
void console_error(const char *reason);

/* Commands every station has, for its table. quit: console_ended() is true from now on. */
void console_quit(char **words, uint8_t n);
bool console_ended(void);

/* VERB on | off: -> true, *on says which, and the answer is given; false: anything else, and error= is the answer. */
bool console_switch(char **words, uint8_t n, bool *on);

/* A line that answers nothing (a trace). Not inside a handler. */
void console_line(const char *text);

#endif
