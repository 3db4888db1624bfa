/* expect: conditional compilation inside a function */
#include "check.h"

uint8_t fdl_feature(void);

uint8_t fdl_feature(void)
{
#if DEV_SYNC
    return 1;
#else
    return 0;
#endif
}
