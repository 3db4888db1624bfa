/* expect: a unit test waits in host time */
#include <unistd.h>
void test_answer_comes(void)
{
    usleep(1000);
}
