/* expect: recursion: half > other > half
 * budget: 1000 100 60 8 100 */
#include <8052.h>

void other(unsigned char n);

void half(unsigned char n)
{
    if (n)
        other(n >> 1);
    P1 = n;
}

void other(unsigned char n)
{
    half(n);
    P2 = n;
}

void main(void)
{
    for (;;)
        half(P1);
}
