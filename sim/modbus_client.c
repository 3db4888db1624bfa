/* A Modbus client on the virtual line (modbus_client.h). */
#include "sim/modbus_client.h"
#include "hal_virtual.h"

#include <string.h>

static struct mbc *client;
static hv_time request_end, answer_start, answer_end;

/* ---- line ---------------------------------------------------------------------------------------------- */

static void hear(uint8_t octet, hv_time start, hv_time end)
{
    if (client->heard_n == 0)
        answer_start = start;
    if (client->heard_n < MBC_FRAME_MAX)
        client->heard[client->heard_n++] = octet;
    answer_end = end;
    client->answer_delay = (uint32_t)((answer_start - request_end) / hv_bit());
    client->answer_time = (uint32_t)((answer_end - answer_start) / hv_bit());
}

static void driver(bool on)
{
    (void)on;
}

void mbc_begin(struct mbc *c)
{
    static const struct hv_wire wire = {hear, driver};
    memset(c, 0, sizeof *c);
    c->coding.delimiter = '\n';
    c->time_out = 1000;
    client = c;
    hv_begin();
    hv_set_wire(&wire);
}

void mbc_power_on(void (*loop)(void))
{
    hal_init();
    hv_set_loop(loop, NULL);
    hal_irq_restore(HAL_IRQ_ON);
}

/* The virtual port stops at the first misuse. */
void mbc_end(void)
{
}

static void (*interrupt)(void);

static void interrupts(void *arg, uint32_t value)
{
    (void)arg, (void)value;
    interrupt();
    hv_at(hv_now() + 7 * HV_US, interrupts, NULL, 0);
}

void mbc_interrupt(void (*isr)(void))
{
    interrupt = isr;
    hv_at(hv_now(), interrupts, NULL, 0);
}

void mbc_idle(uint32_t tbit)
{
    hv_run_for(tbit * hv_bit());
}

void mbc_idle_ms(uint32_t ms)
{
    hv_run_for(ms * (hv_time)HV_MS);
}

uint32_t mbc_tbit_of_ms(uint32_t ms)
{
    return (uint32_t)(ms * (hv_time)HV_MS / hv_bit());
}

uint8_t mbc_format(void)
{
    return hv_format();
}

/* -> end of the last one */
static hv_time put_run(const struct mbc_wrong *w, hv_time t, const uint8_t *octets, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        if (w && w->gap && i == w->gap_at)
            t += w->gap * hv_bit();
        t += hv_char_bits() * hv_bit();
        hv_inject(t, octets[i], w && w->err && i == w->err_at ? w->err : 0);
    }
    return t;
}

void mbc_put(struct mbc *c, const uint8_t *octets, unsigned n)
{
    const struct mbc_wrong *const w = &c->wrong;
    hv_time t = hv_now();
    c->heard_n = 0;
    if (w->noise_n)
        t = put_run(NULL, t, w->noise, w->noise_n) + w->noise_gap * hv_bit();
    request_end = put_run(w, t, octets, n);
    hv_run_until(request_end);
}

void mbc_send(struct mbc *c, const uint8_t *body, unsigned n)
{
    uint8_t frame[MBC_FRAME_MAX];
    unsigned len = mbc_frame(&c->coding, body, n, c->wrong.check_xor, frame);
    for (unsigned i = 0; i < c->wrong.extra; i++)
        frame[len++] = c->coding.mode == MBC_RTU ? 0x55 : '0';
    mbc_put(c, frame, len > c->wrong.cut ? len - c->wrong.cut : 0);
}

unsigned mbc_wait(struct mbc *c, uint8_t *body)
{
    const hv_time end = hv_now() + c->time_out * (hv_time)HV_MS;
    const hv_time quiet = 40 * hv_bit();
    while (c->heard_n == 0 ? hv_now() < end : hv_now() < answer_end + quiet)
        hv_run_for(10 * hv_bit());
    return c->heard_n ? mbc_unframe(&c->coding, c->heard, c->heard_n, body) : 0;
}
