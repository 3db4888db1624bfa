/* expect: serial_isr > in_main: not interrupt code
 * The main loop passes the function; interrupt code calls it through the pointer. */
#include <8052.h>

#include "check.h"

typedef void (*callback)(void);
void serial_isr(void) __interrupt(4) __using(1);
static volatile HOT callback then;
static volatile HOT uint8_t n;

static void in_main(void)
{
    n = (uint8_t)(n + P1);
}

void serial_isr(void) __interrupt(4) __using(1)
{
    RI = 0;
    then();
}

void main(void)
{
    then = in_main;
    ES = 1;
    for (;;) {
    }
}
