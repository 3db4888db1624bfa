/* expect: stack over budget
 * budget: 1000 100 60 8 9
 * By hand: four calls and the interrupt, five return addresses. */
#include <8052.h>

void serial_isr(void) __interrupt(4) __using(1);

void serial_isr(void) __interrupt(4) __using(1)
{
    RI = 0;
}

static void d(void)
{
    P1 = 4;
}

static void c(void)
{
    d();
    P1 = 3;
}

static void b(void)
{
    c();
    P1 = 2;
}

static void a(void)
{
    b();
    P1 = 1;
}

void main(void)
{
    ES = 1;
    for (;;)
        a();
}
