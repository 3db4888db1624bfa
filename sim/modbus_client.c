/* A Modbus client on the virtual line (modbus_client.h). */
#include "sim/modbus_client.h"

#include <string.h>

static struct mbc *client;

/* ---- line ---------------------------------------------------------------------------------------------- */

static void hear(uint8_t octet, hv_time start, hv_time end)
{
    if (client->heard_n == 0)
        client->answer_start = start;
    if (client->heard_n < MBC_FRAME_MAX)
        client->heard[client->heard_n++] = octet;
    client->answer_end = end;
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
    c->time_out = HV_S;
    client = c;
    hv_set_wire(&wire);
}

void mbc_idle(unsigned tbit)
{
    hv_run_for(tbit * hv_bit());
}

/* -> end of the last one */
static hv_time put_run(const struct mbc_wrong *w, hv_time t, const uint8_t *octets, unsigned n)
{
    for (unsigned i = 0; i < n; i++) {
        if (w && w->gap && i == w->gap_at)
            t += w->gap;
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
        t = put_run(NULL, t, w->noise, w->noise_n) + w->noise_gap;
    c->request_end = put_run(w, t, octets, n);
    hv_run_until(c->request_end);
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
    const hv_time end = hv_now() + c->time_out;
    const hv_time quiet = 40 * hv_bit();
    while (c->heard_n == 0 ? hv_now() < end : hv_now() < c->answer_end + quiet)
        hv_run_for(10 * hv_bit());
    return c->heard_n ? mbc_unframe(&c->coding, c->heard, c->heard_n, body) : 0;
}
