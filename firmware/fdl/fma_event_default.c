/* Default of the optional callback: alone in its object, so that the application's own replaces it. */
#include "fdl/fma.h"

void fma_event_ind(uint8_t event, uint8_t detail)
{
    (void)event;
    (void)detail;
}
