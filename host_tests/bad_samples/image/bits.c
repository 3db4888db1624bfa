/* expect: bits over budget
 * budget: 1000 100 60 2 100 */
#include <8052.h>

static volatile __bit one, two, three;

void main(void)
{
    for (;;) {
        one = P1_0;
        two = P1_1;
        three = P1_2;
    }
}
