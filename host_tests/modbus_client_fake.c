/* A Modbus client on the line of the machine without time (fake_hal.h): here time is whole bit times, and passes only while
 * the client waits or an octet is on its way. The main loop comes round every few of them. */
#include "fake_hal.h"
#include "sim/modbus_client.h"

#include <string.h>

#define PASS_TBIT  25u /* of the main loop */
#define QUIET_TBIT 40u /* after an answer */

static struct mbc *client;
static void (*main_loop)(void);
static uint32_t pass = PASS_TBIT;
static uint32_t silent;  /* since the last octet on the line, or since it was opened */
static uint8_t opens;
static uint32_t ms_part; /* of the next millisecond: 1000 / bit_per_s seconds each */
static uint32_t sending; /* bit times that the answer still takes */
static uint8_t frame[MBC_FRAME_MAX];

static uint8_t char_bits(void)
{
    return fake.format <= HAL_8N2 ? 11 : 10;
}

/* An answer begins / has ended. */
static void answer_begins(void)
{
    memcpy(client->heard, fake.sent, fake.sent_len);
    client->heard_n = fake.sent_len;
    client->answer_delay = silent;
    client->answer_time = sending = (uint32_t)fake.sent_len * char_bits();
}

static void answer_ends(void)
{
    fake_sent();
    silent = 0;
}

static void clock_on(uint32_t tbit)
{
    if (opens != fake.opens) {
        opens = fake.opens;
        silent = sending = 0;
    }
    if (sending) {
        sending -= tbit;
        if (sending == 0)
            answer_ends();
    } else {
        silent += tbit;
        if (fake.armed && silent >= fake.limit)
            fake_silence();
    }
    if (fake.rate == 0)
        return;
    for (ms_part += 1000u * tbit; ms_part >= fake.rate; ms_part -= fake.rate)
        fake.ticks++;
}

/* -> the next moment at which something happens, at most tbit away */
static uint32_t step(uint32_t tbit)
{
    uint32_t next = tbit < pass ? tbit : pass;
    if (sending && sending < next)
        next = sending;
    if (!sending && fake.armed && fake.limit > silent && fake.limit - silent < next)
        next = fake.limit - silent;
    return next;
}

void mbc_idle(uint32_t tbit)
{
    while (tbit) {
        const uint32_t now = step(tbit);
        tbit -= now;
        clock_on(now);
        main_loop();
        if (fake.sending && !sending)
            answer_begins();
    }
}

uint32_t mbc_tbit_of_ms(uint32_t ms)
{
    return fake.rate / 100u * ms / 10u; /* rates are whole hundreds, and the product has 32 bits */
}

void mbc_idle_ms(uint32_t ms)
{
    const uint32_t tbit = mbc_tbit_of_ms(ms);
    pass = tbit / 64u > PASS_TBIT ? tbit / 64u : PASS_TBIT; /* a simulated 8051 has better things to do */
    mbc_idle(tbit);
    pass = PASS_TBIT;
}

uint8_t mbc_format(void)
{
    return fake.format;
}

static void no_loop(void)
{
}

void mbc_begin(struct mbc *c)
{
    fake_begin();
    memset(c, 0, sizeof *c);
    c->coding.delimiter = '\n';
    c->time_out = 1000;
    client = c;
    main_loop = no_loop;
    silent = ms_part = sending = 0;
    opens = 0;
}

void mbc_power_on(void (*loop)(void))
{
    main_loop = loop;
}

void mbc_end(void)
{
    fake_end();
}

void mbc_interrupt(void (*isr)(void))
{
    fake_at_unlock = isr;
}

static void put_run(const struct mbc_wrong *w, const uint8_t *octets, unsigned n)
{
    unsigned i;
    for (i = 0; i < n; i++) {
        if (w && w->gap && i == w->gap_at)
            mbc_idle(w->gap);
        mbc_idle(char_bits());
        if (!sending) /* what is heard while the station drives the line is its own */
            fake_octet(octets[i], w && w->err && i == w->err_at ? w->err : 0);
        silent = 0;
    }
}

void mbc_put(struct mbc *c, const uint8_t *octets, unsigned n)
{
    c->heard_n = 0;
    if (c->wrong.noise_n) {
        put_run(0, c->wrong.noise, c->wrong.noise_n);
        mbc_idle(c->wrong.noise_gap);
    }
    put_run(&c->wrong, octets, n);
}

void mbc_send(struct mbc *c, const uint8_t *octets, unsigned n)
{
    unsigned len = mbc_frame(&c->coding, octets, n, c->wrong.check_xor, frame);
    unsigned i;
    for (i = 0; i < c->wrong.extra; i++)
        frame[len++] = c->coding.mode == MBC_RTU ? 0x55 : '0';
    mbc_put(c, frame, len > c->wrong.cut ? len - c->wrong.cut : 0);
}

unsigned mbc_wait(struct mbc *c, uint8_t *octets)
{
    uint32_t left = mbc_tbit_of_ms(c->time_out);
    while (c->heard_n == 0 && left > PASS_TBIT) {
        mbc_idle(PASS_TBIT);
        left -= PASS_TBIT;
    }
    if (c->heard_n == 0)
        return 0;
    mbc_idle(sending + QUIET_TBIT);
    return mbc_unframe(&c->coding, c->heard, c->heard_n, octets);
}
