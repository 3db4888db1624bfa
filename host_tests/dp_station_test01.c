/* DP-TEST01 as it is, on a board that is the test's memory. */
#include "board.h"
#include "dp_fixture.h"
#include "dp_test01_app.h"

void dp_station_init(uint8_t switches, uint8_t baud)
{
    dp_test01_init(switches, baud);
}

void dp_station_poll(void)
{
    dp_test01_poll();
}

uint8_t board_input(uint8_t module)
{
    return dp_in[module == 2];
}

void board_output(uint8_t module, uint8_t value)
{
    dp_out[module == 3] = value;
    dp_outs += module == 3;
}
