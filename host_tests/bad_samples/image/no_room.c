/* expect: stack runs out of internal RAM
 * budget: 1000 100 256 8 100
 * The linker is content: one octet of stack is enough for it. */
#include <8052.h>

static volatile __idata unsigned char table[244];

static void b(void)
{
    table[P1] = 2;
    P1 = table[P2];
}

static void a(void)
{
    b();
    b();
}

static void c(void)
{
    a();
    a();
}

static void e(void)
{
    c();
    c();
}

void main(void)
{
    for (;;) {
        e();
        P1 = 0;
    }
}
