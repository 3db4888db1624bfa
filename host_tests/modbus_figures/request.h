/* One request, for whoever counts what it costs. */
#ifndef MODBUS_FIGURES_REQUEST_H
#define MODBUS_FIGURES_REQUEST_H

#include "check.h"

enum {
    MARK_OCTET = 1,
    MARK_OCTET_DONE,
    MARK_SILENCE, /* t3.5 is over */
    MARK_FIRST_OCTET_OUT,
    MARK_POLL_DONE,
    MARK_OK,
};

/* Implemented by the target. */
void figure_mark(uint8_t mark);

void figure_open(void);
void figure_request(void);
uint8_t figure_ok(void); /* the answer was right, octet for octet */

#endif
