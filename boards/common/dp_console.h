/* A console of DP-TEST01 for boards with a UART to spare: one line in, one line of key=value out, over hal_con_get() and
 * hal_con_put(). A small brother of the host station's: status, out, in M V. Context: main. */
#ifndef DP_CONSOLE_H
#define DP_CONSOLE_H

#include "check.h"

/* Take waiting octets, carry out at most one line. */
void dp_console_poll(void);

/* Process input octet of a module (0..3) as the console has set it. */
uint8_t dp_console_input(uint8_t module);

/* A process output octet, for `out`. */
void dp_console_output(uint8_t module, uint8_t value);

#endif
