/* The line of hdlc_peer.h where nothing is below the station but a stand-in for the driver (hdlc_8273.h): whole frames, on
 * the machine without time. */
#include "fake_hal.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc_peer.h"

#include <string.h>

#define BIT_PER_S     7200u
#define FRAME_AROUND  32u  /* bits: FCS and two flags */
#define PATIENCE_BITS 100u /* a station answers at once, or when its main loop comes round */

struct hdlc_peer peer;

/* ---- the driver -------------------------------------------------------------------------------------------- */

volatile struct hdlc_8273_counters XDATA hdlc_8273_counters;
struct hdlc_frame XDATA hdlc_8273_out;
static struct hdlc_frame XDATA in;
static bool full;
static uint8_t address_1, address_2;
static uint16_t sending; /* bits that our frame still takes */

bool hdlc_8273_open(uint8_t mode, uint8_t a1, uint8_t a2)
{
    uint8_t i;
    (void)mode;
    for (i = 0; i < HDLC_RX_COUNTERS; i++)
        hdlc_8273_counters.rx[i] = 0;
    for (i = 0; i < HDLC_TX_COUNTERS; i++)
        hdlc_8273_counters.tx[i] = 0;
    address_1 = a1;
    address_2 = a2;
    full = false;
    sending = 0;
    return true;
}

void hdlc_8273_poll(void)
{
}

const struct hdlc_frame XDATA *hdlc_8273_frame(void)
{
    return full ? &in : NULL;
}

void hdlc_8273_release(void)
{
    full = false;
}

void hdlc_8273_send(uint8_t n)
{
    uint8_t i;
    TEST_ASSERT_EQUAL_MESSAGE(0, sending, "sent while sending");
    TEST_ASSERT_TRUE(n >= 2 && n <= HDLC_FRAME_MAX);
    for (i = 0; i < n; i++)
        peer.answer[i] = hdlc_8273_out.octets[i];
    peer.answer_n = n;
    peer.answers++;
    sending = (uint16_t)(8u * n + FRAME_AROUND);
}

bool hdlc_8273_sending(void)
{
    return sending != 0;
}

/* ---- the line ---------------------------------------------------------------------------------------------- */

static void (*main_loop)(void);
static uint32_t ms_part; /* of the next millisecond, in 1/7200 of it */

void peer_begin(void (*init)(void), void (*loop)(void))
{
    fake_begin();
    memset(&peer, 0, sizeof peer);
    fake.masked = true;
    init();
    fake.masked = false;
    main_loop = loop;
    ms_part = 0;
    peer_run(20);
}

void peer_end(void)
{
    fake_end();
}

static void clock_on(uint32_t bits)
{
    for (ms_part += 1000u * bits; ms_part >= BIT_PER_S; ms_part -= BIT_PER_S)
        fake.ticks++;
    if (sending && sending <= bits)
        hdlc_8273_counters.tx[HDLC_TX_GOOD]++;
    sending = sending > bits ? (uint16_t)(sending - bits) : 0;
}

void peer_run(uint32_t bits)
{
    const uint32_t pass = bits / 1024u + 1u;
    while (bits) {
        const uint32_t now = bits < pass ? bits : pass;
        clock_on(now);
        main_loop();
        bits -= now;
    }
}

void peer_say(const uint8_t *octets, unsigned n)
{
    peer_run(8u * n + FRAME_AROUND);
    if (octets[0] != address_1 && octets[0] != address_2)
        return;
    hdlc_8273_counters.rx[full ? HDLC_RX_FULL : HDLC_RX_GOOD]++;
    if (full)
        return;
    in.n = n > HDLC_FRAME_MAX ? HDLC_FRAME_MAX + 1u : (uint8_t)n;
    memcpy(in.octets, octets, in.n);
    full = true;
}

bool peer_ask(const uint8_t *octets, unsigned n)
{
    unsigned left = PATIENCE_BITS;
    peer_clear();
    peer_say(octets, n);
    while (peer.answers == 0 && left--)
        peer_run(1);
    peer_run(sending + 20u);
    return peer.answers == 1;
}

void peer_clear(void)
{
    peer.answers = peer.answer_n = 0;
}

void peer_interrupt(void (*isr)(void))
{
    fake.isr++;
    isr();
    fake.isr--;
}
