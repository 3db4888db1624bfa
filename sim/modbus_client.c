/* A Modbus client on the virtual line (modbus_client.h). */
#include "sim/modbus_client.h"

#include <string.h>

static struct mbc *client;

/* ---- encoder ------------------------------------------------------------------------------------------- */

uint16_t mbc_crc(const uint8_t *octets, unsigned n)
{
    unsigned crc = 0xFFFF;
    while (n--) {
        crc ^= *octets++;
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1u ? (crc >> 1) ^ 0xA001u : crc >> 1;
    }
    return (uint16_t)crc;
}

uint8_t mbc_lrc(const uint8_t *octets, unsigned n)
{
    unsigned sum = 0;
    while (n--)
        sum += *octets++;
    return (uint8_t)(0x100u - (sum & 0xFFu));
}

static unsigned put_hex(uint8_t *to, uint8_t octet)
{
    static const char digits[] = "0123456789ABCDEF";
    to[0] = (uint8_t)digits[octet >> 4];
    to[1] = (uint8_t)digits[octet & 15];
    return 2;
}

unsigned mbc_frame(const struct mbc *c, const uint8_t *body, unsigned n, uint8_t *frame)
{
    unsigned out = 0;
    if (c->mode == MBC_RTU) {
        const unsigned crc = mbc_crc(body, n) ^ c->wrong.check_xor;
        memcpy(frame, body, n);
        frame[n] = (uint8_t)crc;
        frame[n + 1] = (uint8_t)(crc >> 8);
        return n + 2;
    }
    frame[out++] = ':';
    for (unsigned i = 0; i < n; i++)
        out += put_hex(frame + out, body[i]);
    out += put_hex(frame + out, (uint8_t)(mbc_lrc(body, n) ^ c->wrong.check_xor));
    frame[out++] = '\r';
    frame[out++] = c->delimiter;
    return out;
}

static int hex_value(uint8_t c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

unsigned mbc_unframe(const struct mbc *c, const uint8_t *frame, unsigned n, uint8_t *body)
{
    unsigned out = 0;
    if (c->mode == MBC_RTU) {
        if (n < 4 || n > 256 || mbc_crc(frame, n - 2) != (frame[n - 2] | frame[n - 1] << 8))
            return 0;
        memcpy(body, frame, n - 2);
        return n - 2;
    }
    if (n < 9 || n > 513 || n % 2 == 0 || frame[0] != ':' || frame[n - 2] != '\r' ||
        frame[n - 1] != c->delimiter)
        return 0;
    for (unsigned i = 1; i < n - 2; i += 2) {
        const int high = hex_value(frame[i]), low = hex_value(frame[i + 1]);
        if (high < 0 || low < 0)
            return 0;
        body[out++] = (uint8_t)(high << 4 | low);
    }
    out--;
    return mbc_lrc(body, out) == body[out] ? out : 0;
}

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
    c->delimiter = '\n';
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
    unsigned len = mbc_frame(c, body, n, frame);
    for (unsigned i = 0; i < c->wrong.extra; i++)
        frame[len++] = c->mode == MBC_RTU ? 0x55 : '0';
    mbc_put(c, frame, len > c->wrong.cut ? len - c->wrong.cut : 0);
}

unsigned mbc_wait(struct mbc *c, uint8_t *body)
{
    const hv_time end = hv_now() + c->time_out;
    const hv_time quiet = 40 * hv_bit();
    while (hv_now() < end && (c->heard_n == 0 || hv_now() < c->answer_end + quiet))
        hv_run_for(10 * hv_bit());
    return c->heard_n ? mbc_unframe(c, c->heard, c->heard_n, body) : 0;
}
