/* The part alone: all of its RAM is on the chip, and P0 is a port with switches to ground, closed = 1. */
#include "board.h"
#include "wiring.h"

/* SDCC's start-up calls this before it clears the RAM. */
unsigned char _sdcc_external_startup(void)
{
    AUXR = EXTRAM_ON_CHIP;
    return 0;
}

uint8_t board_input(uint8_t module)
{
    (void)module;
    return (uint8_t)~P0;
}
