/* The echo on a line in virtual time. */
#include "contract_machine.h"

#define ECHO_AFTER (30u * HV_MS)
#define CHAR       (11u * hv_bit())

static struct {
    uint8_t octet[256];
    unsigned n, given;
    hv_time quiet_since;
} heard;

/* All that was heard since, when the line has been silent long enough. */
static void echo(void *arg, uint32_t value)
{
    (void)arg;
    (void)value;
    if (hv_now() < heard.quiet_since + ECHO_AFTER || hv_driver())
        return;
    for (unsigned i = 0; i < heard.n; i++)
        hv_inject(hv_now() + (i + 1u) * CHAR, heard.octet[i], 0);
    heard.n = 0;
}

static void hear(uint8_t octet, hv_time start, hv_time end)
{
    (void)start;
    if (heard.n < sizeof heard.octet)
        heard.octet[heard.n++] = octet;
    heard.quiet_since = end;
    hv_at(end + ECHO_AFTER, echo, NULL, 0);
}

static void driver(bool on)
{
    (void)on;
}

void contract_begin(void)
{
    static const struct hv_wire wire = {hear, driver};
    hv_begin();
    hv_set_wire(&wire);
    hal_init();
    hal_irq_restore(HAL_IRQ_ON);
}
