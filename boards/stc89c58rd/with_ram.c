/* 32 kB of RAM and memory-mapped I/O on the bus; the RAM on the chip is switched off. */
#include "board.h"
#include "wiring.h"

static volatile XDATA uint8_t __at(IO_ADDRESS) io[2];

/* SDCC's start-up calls this before it clears the RAM. */
unsigned char _sdcc_external_startup(void)
{
    AUXR = EXTRAM_OUTSIDE;
    return 0;
}

uint8_t board_input(uint8_t module)
{
    return io[module >> 1];
}

void board_output(uint8_t module, uint8_t value)
{
    io[module >> 1] = value;
}
