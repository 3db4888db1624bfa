/* The line of hdlc_peer.h with the driver, the modelled 8273 and bits on a wire in virtual time. */
#include "hal/posix/hal_virtual_vm.h"
#include "hdlc_peer.h"
#include "sim/hdlc_bus.h"
#include "sim/hdlc_pcap.h"

#include <stdlib.h>
#include <string.h>

struct hdlc_peer peer;

/* HDLC_PCAP=FILE in the environment: all frames of all tests into a capture, for decoders of others
 * (host_tests/hdlc_host.py). */
static FILE *capture;

static void tap(const uint8_t *octets, unsigned n, bool from_station)
{
    (void)from_station;
    hdlc_pcap_frame(capture, octets, n, hbus.now * 1000000u / 7200u);
}

static void heard(void)
{
    memcpy(peer.answer, hbus.answer, hbus.answer_n);
    peer.answer_n = hbus.answer_n;
    peer.answers = hbus.answers;
}

void peer_begin(void (*init)(void), void (*loop)(void))
{
    if (!capture && getenv("HDLC_PCAP"))
        capture = hdlc_pcap_open(getenv("HDLC_PCAP"));
    memset(&peer, 0, sizeof peer);
    hbus_begin();
    hbus.tap = capture ? tap : NULL;
    hbus_station(init, loop);
    hbus_run(20);
}

void peer_end(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(0, hbus.collisions, "the station spoke while the primary did");
    TEST_ASSERT_EQUAL_MESSAGE(0, hbus.stuck, "an interrupt was left pending");
    TEST_ASSERT_EQUAL_MESSAGE(0, hal_8273_chip.lost_commands + hal_8273_chip.lost_parameters, "8273 misused");
    TEST_ASSERT_EQUAL(0, hal_8273_chip.data_without_request);
}

void peer_run(uint32_t bits)
{
    hbus_run(bits);
    heard();
}

void peer_say(const uint8_t *octets, unsigned n)
{
    hbus_say(octets, n);
    heard();
}

bool peer_ask(const uint8_t *octets, unsigned n)
{
    const bool one = hbus_ask(octets, n);
    heard();
    return one;
}

void peer_clear(void)
{
    hbus_clear();
    heard();
}

void peer_interrupt(void (*isr)(void))
{
    hv_vm.in_isr = true;
    isr();
    hv_vm.in_isr = false;
}
