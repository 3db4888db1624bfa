/* On the 8051 simulator each mark is a write to port 1, where the simulator stops and says the time. */
#include "modbus_figures/request.h"
#include <8052.h>

void figure_mark(uint8_t mark)
{
    P1 = mark;
}

void main(void)
{
    figure_open();
    figure_request();
    if (figure_ok())
        figure_mark(MARK_OK);
    for (;;) {
    }
}
