/* In place of fma_watch.c, for a device that takes no events of FMA and is short of memory. */
#include "fdl/fdl_priv.h"
#include "fdl/fma.h"

void fma_poll(uint16_t elapsed_ms)
{
    (void)elapsed_ms;
}

void fma_watch_t_sl(uint16_t t_sl)
{
    (void)t_sl;
}

void fma_watch_reset(void)
{
}

void fma_watch_cleared(const uint16_t XDATA *count)
{
    (void)count;
}
