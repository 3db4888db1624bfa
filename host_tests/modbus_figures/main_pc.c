/* Under callgrind: figure_request() is collected. The argument says how often. */
#include "modbus_figures/request.h"

#include <stdlib.h>

void figure_mark(uint8_t mark)
{
    (void)mark;
}

int main(int argc, char **argv)
{
    figure_open();
    for (long n = argc > 1 ? strtol(argv[1], NULL, 10) : 1; n > 0; n--) {
        figure_request();
        if (!figure_ok())
            return 1;
    }
    return 0;
}
