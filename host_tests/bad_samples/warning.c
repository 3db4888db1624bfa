/* expect: error */
#include "check.h"

uint8_t narrow(uint16_t n);

uint8_t narrow(uint16_t n)
{
    uint8_t never_used;
    return n > 70000ul ? 1u : 0u;
}
