#include "hal/con_in.h"

#define OCTETS 64u

/* One producer, the interrupt, writes `in`; one consumer, the main loop, writes `out`: an octet each, so neither can see
 * the other half written. in == out: empty. */
static uint8_t buffer[OCTETS];
static volatile uint8_t in;
static volatile uint8_t out;

void con_in_isr(uint8_t octet)
{
    uint8_t next = (uint8_t)((in + 1u) % OCTETS);

    if (next == out)
        return;
    buffer[in] = octet;
    in = next;
}

int16_t hal_con_get(void)
{
    uint8_t octet;

    if (out == in)
        return -1;
    octet = buffer[out];
    out = (uint8_t)((out + 1u) % OCTETS);
    return octet;
}
