/* The operator's commands of the HDLC master station, and what is reported about them (report.h).
 *
 *   set M CH V      control now: digital V 0 or 1, analog V 0..4095     get M CH    request data now
 *   samples M CH    fetch the whole sample log of a channel             diag M      diagnosis and counters
 *   on M, off M     poll a module, or no longer                         status      everything known
 *   wait MS         (scripts) nothing for so long                       quit        end
 *
 * M is a module's name or address.
 */
#ifndef FIELDLING_MASTER_COMMANDS_H
#define FIELDLING_MASTER_COMMANDS_H

#include "sim/hdlc_primary.h"

/* Hooks into p (done, trouble). */
void commands_init(struct hp *p);

/* Carry out one line. -> NULL, or what is wrong with it, for a person. */
const char *commands_line(const char *text, uint64_t now_ms);

/* A command is under way (its answer is not reported yet, or it waits): a script's next line waits. */
bool commands_busy(uint64_t now_ms);

bool commands_quit(void);

/* Report all modules, as `status` does. */
void commands_status(void);

const char *state_word(const struct hp_module *m);

#endif
