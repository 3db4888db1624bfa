/* expect: memory is allocated */
#include <stddef.h>

void *malloc(size_t n);
void *fdl_buffer(void);

void *fdl_buffer(void)
{
    return malloc(255);
}
