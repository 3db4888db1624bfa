/* Background checks of a remote module: RAM, program memory, converter, outputs (spec C3). Main. */
#ifndef REMOTE_CHECK_H
#define REMOTE_CHECK_H

#include "check.h"

/* Start over; type as rm_init(). */
void rm_check_init(uint8_t type);

/* One step: one octet of RAM, a few of the program, the converter, one output. Bounded. */
void rm_check_poll(void);

/* Outputs whose read-back is wrong, bit i = channel index i. */
uint16_t rm_check_stuck(void);

#endif
