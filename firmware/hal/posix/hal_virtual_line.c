/* The line of the port in virtual time: receiver, silence, transmitter (hal.h, "the line"; hal_virtual.h). */
#include "hal_virtual_vm.h"

#include <string.h>

#define HZ 576000000u

struct hv_port hv_port;

/* ---- interrupts --------------------------------------------------------------------------------------- */

/* When the next upcall is due, were interrupts not masked. */
hv_time hv_interrupt_due(void)
{
    hv_time due = hv_vm.sent_pending ? hv_vm.now : HV_NEVER;
    if (hv_vm.pending && hv_vm.fifo[0].end + hv_port.octet_latency < due)
        due = hv_vm.fifo[0].end + hv_port.octet_latency;
    if (hv_vm.limit_armed && !hv_vm.sending && hv_vm.quiet_since + hv_vm.limit < due)
        due = hv_vm.quiet_since + hv_vm.limit;
    return due < hv_vm.now ? hv_vm.now : due;
}

static void take_octet(void)
{
    const uint8_t octet = hv_vm.fifo[0].octet, err = hv_vm.fifo[0].err;
    hv_vm.quiet_since = hv_vm.fifo[0].end;
    hv_vm.limit_armed = hv_vm.limit != 0;
    hv_vm.pending--;
    memmove(&hv_vm.fifo[0], &hv_vm.fifo[1], hv_vm.pending * sizeof hv_vm.fifo[0]);
    hv_seen.octets_in++;
    line_octet_isr(octet, err);
}

/* One upcall: the receiver first (hal.h, hal_silence). */
void hv_interrupt(void)
{
    hv_vm.in_isr = true;
    if (hv_vm.pending) {
        take_octet();
    } else if (hv_vm.sent_pending) {
        hv_vm.sent_pending = false;
        line_sent_isr();
    } else {
        hv_vm.limit_armed = false;
        line_silence_isr();
    }
    hv_vm.in_isr = false;
}

bool hv_interruptible(void)
{
    return hv_vm.on && !hv_vm.masked && !hv_vm.in_isr;
}

/* ---- transmitter -------------------------------------------------------------------------------------- */

static void drive(bool on)
{
    if (hv_vm.driver == on)
        return;
    hv_vm.driver = on;
    if (hv_vm.wire.driver)
        hv_vm.wire.driver(on);
}

static bool looped(void)
{
    return (hv_vm.format & HAL_LOOP) != 0;
}

static void into_fifo(uint8_t octet, uint8_t err)
{
    if (hv_vm.pending >= hv_port.fifo || hv_vm.pending >= HV_FIFO_MAX) {
        hv_seen.octets_lost++;
        hv_vm.overrun = true;
        return;
    }
    hv_vm.fifo[hv_vm.pending].octet = octet;
    hv_vm.fifo[hv_vm.pending].err = (uint8_t)(err | (hv_vm.overrun ? HAL_ERR_OVERRUN : 0));
    hv_vm.fifo[hv_vm.pending++].end = hv_vm.now;
    hv_vm.overrun = false;
}

void hv_transmit(void)
{
    if (looped() && hv_vm.sent_n > 0)
        into_fifo(hv_vm.octets[hv_vm.sent_n - 1], 0);
    if (hv_vm.sent_n < hv_vm.n) {
        const uint8_t octet = hv_vm.octets[hv_vm.sent_n++];
        const hv_time start = hv_vm.tx_due;
        hv_vm.tx_due = start + hv_vm.char_bits * hv_vm.bit;
        if (hv_vm.wire.octet && !looped())
            hv_vm.wire.octet(octet, start, hv_vm.tx_due);
        return;
    }
    hv_vm.sending = false;
    hv_vm.quiet_since = hv_vm.now;
    hv_vm.limit_armed = hv_vm.limit != 0;
    hv_vm.sent_pending = true;
    drive(false);
}

void hv_vm_line_off(void)
{
    drive(false);
    hv_vm.sending = hv_vm.sent_pending = hv_vm.limit_armed = hv_vm.overrun = false;
    hv_vm.pending = 0;
    hv_vm.limit = hv_vm.bit = 0;
}

/* ---- the station's side, line -------------------------------------------------------------------------- */

hv_time hv_bit_of(uint32_t bit_per_s)
{
    if (bit_per_s == 45450u)
        return HZ / (12000000u / 264u);
    return bit_per_s && HZ % bit_per_s == 0 ? HZ / bit_per_s : 0;
}

static bool board_can(uint32_t bit_per_s)
{
    if (!hv_port.rates)
        return true;
    for (const uint32_t *r = hv_port.rates; *r; r++)
        if (*r == bit_per_s)
            return true;
    return false;
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    static const uint8_t bits[HAL_FORMATS] = {11, 11, 11, 10, 10, 10, 10}; /* start, data, parity, stop */
    hv_main_only("hal_line_open");
    const hv_time bit = hv_bit_of(bit_per_s);
    if (!bit || !board_can(bit_per_s) || (format & (uint8_t)~HAL_LOOP) >= HAL_FORMATS)
        return HAL_LINE_NO;
    hv_vm.bit = bit;
    hv_vm.format = format;
    hv_vm.char_bits = bits[format & (uint8_t)~HAL_LOOP];
    hv_vm.sending = hv_vm.sent_pending = hv_vm.overrun = hv_vm.limit_armed = false;
    hv_vm.pending = 0;
    hv_vm.limit = 0;
    hv_vm.quiet_since = hv_vm.now;
    drive(false);
    hv_seen.opens++;
    return hv_port.untimed ? HAL_LINE_UNTIMED : HAL_LINE_TIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    hv_main_only("hal_tbit");
    const hv_time d = n * hv_vm.bit;
    return d > UINT32_MAX ? UINT32_MAX : (hal_dur_t)d;
}

void hal_silence(hal_dur_t d) IN_ISR
{
    hv_isr_or_lock("hal_silence");
    hv_vm.limit = d;
    hv_vm.limit_armed = d != 0 && hv_vm.bit != 0;
}

bool hal_silent(hal_dur_t d) IN_ISR
{
    (void)d;
    return false;
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    hv_isr_or_lock("hal_send");
    if (hv_vm.sending || n == 0 || !hv_vm.bit) {
        hv_on_failure(hv_vm.sending ? "hal_send while sending" : "hal_send of nothing or on a closed line");
        return;
    }
    hv_vm.octets = octets;
    hv_vm.n = n;
    hv_vm.sent_n = 0;
    hv_vm.sending = true;
    hv_vm.tx_due = hv_vm.now + hv_port.send_latency;
    if (!looped())
        drive(true);
}

/* ---- the line, the test's side ------------------------------------------------------------------------ */

void hv_receive(uint8_t octet, uint8_t err)
{
    if (hv_vm.on && hv_vm.bit && !hv_vm.driver && !looped())
        into_fifo(octet, err);
}

static void receive_event(void *unused, uint32_t value)
{
    (void)unused;
    hv_receive((uint8_t)value, (uint8_t)(value >> 8));
}

void hv_inject(hv_time t, uint8_t octet, uint8_t err)
{
    hv_at(t, receive_event, NULL, (uint32_t)(octet | err << 8));
}

void hv_set_wire(const struct hv_wire *wire)
{
    hv_vm.wire = *wire;
}

bool hv_driver(void)
{
    return hv_vm.driver;
}

hv_time hv_bit(void)
{
    return hv_vm.bit;
}

uint8_t hv_char_bits(void)
{
    return hv_vm.char_bits;
}

uint8_t hv_format(void)
{
    return hv_vm.format;
}
