/* What a reference application asks of the board it runs on; each board implements it. All main. */
#ifndef FIELDLING_BOARD_H
#define FIELDLING_BOARD_H

#include "check.h"

/* Process input octet of module 0..n-1 as it is now, and process output octet of a module. */
uint8_t board_input(uint8_t module);
void board_output(uint8_t module, uint8_t value);

#endif
