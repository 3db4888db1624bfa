/* SDCC 4.2 computes `last == 3` and forgets to store it: f: cjne r7,#3 ... clr c, ret.
 * expect: bool in a HOT struct */
#include "check.h"

struct state {
    uint8_t octet;
    bool is_three;
};
static HOT struct state state;

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    (void)err;
    state.is_three = octet == 3u;
}
