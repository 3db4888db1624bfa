/* Octets one by one to line_octet_isr(): for stacks that look at each. */
#include "hal/mcs51/mcs51.h"

void take_isr(void) __using(2)
{
    line_octet_isr(octet, octet_err);
}

void serve_octets_isr(void) __using(2)
{
    while (held_octet_isr())
        take_isr();
}

void burst_isr(void) __using(2)
{
}

void look_isr(void) __using(2)
{
}
