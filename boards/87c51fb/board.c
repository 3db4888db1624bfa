/* Memory-mapped I/O of the 87C51FB board (wiring.h). */
#include "board.h"
#include "wiring.h"

static volatile XDATA uint8_t __at(IO_ADDRESS) io[2];

uint8_t board_input(uint8_t module)
{
    return io[module >> 1];
}

void board_output(uint8_t module, uint8_t value)
{
    io[module >> 1] = value;
}
