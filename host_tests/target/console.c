/* Unity writes to the console of the port under test. */
#include "hal/hal.h"

void target_put(char c);

void target_put(char c)
{
    hal_con_put((uint8_t)c);
}
