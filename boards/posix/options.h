/* The command line of a host program: `--name VALUE` or `--name=VALUE`, one row per option. All of it is
 * main. */
#ifndef FIELDLING_OPTIONS_H
#define FIELDLING_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

struct option_row {
    const char *name;  /* without the dashes                                                        */
    const char *value; /* what the help calls its value; NULL = the option has none                 */
    const char *help;  /* one line                                                                  */
    /* Take value ("" where there is none). -> NULL, or what it should be, for "--name VALUE: ...". */
    const char *(*take)(const char *value);
};

/* Read the command line by the rows, the last one without a name. --help prints title, rows and `more`, and
 * ends with status 0. What cannot be used ends the program with one line on stderr and status 2. */
void options_read(int argc, char **argv, const char *title, const struct option_row *rows, const char *more);

/* For what shows only when all options are known: "program: text" on stderr, exit 2. */
void options_unusable(const char *text);

/* text is one number, decimal or 0x..., min..max: *number is set. False: it is not. */
bool option_number(const char *text, uint32_t min, uint32_t max, uint32_t *number);

#endif
