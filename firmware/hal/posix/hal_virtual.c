/* The port in virtual time (hal_virtual.h).
 *
 * One loop (step) takes the earliest of: the test's events (a heap), the transmitter, the next pass of the
 * main loop, the next interrupt that becomes due. Hardware (receiver, transmitter, driver) goes on while
 * interrupts are masked; only the upcalls wait.
 */
#include "hal_virtual.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HZ        576000000u
#define FIFO_MAX  64u
#define CON_MAX   4096u
#define LOOP_WAIT (100u * HV_US)

struct event {
    hv_time at;
    uint64_t order;
    void (*fn)(void *arg, uint32_t value);
    void *arg;
    uint32_t value;
};

/* Invariants: heap[0] is the earliest; fifo[0..pending-1] ended in that order, none later than now;
 * sending implies octets != NULL and sent_n <= n; in_isr implies !masked was true at entry. */
static struct {
    hv_time now, tick_zero;
    struct event *heap;
    size_t events, room;
    uint64_t order;

    unsigned depth;
    bool restartable;
    jmp_buf restart;
    void (*boot)(void);
    void (*loop)(void);
    hv_time (*wait)(void);
    hv_time loop_due;
    bool in_loop;

    bool on, masked, in_isr, mask_known;
    uint8_t switches;

    hv_time bit;
    uint8_t format, char_bits;
    struct {
        uint8_t octet, err;
        hv_time end;
    } fifo[FIFO_MAX];
    unsigned pending;
    bool overrun;

    hv_time quiet_since, limit;
    bool limit_armed;

    const uint8_t *octets;
    uint16_t n, sent_n;
    hv_time tx_due; /* start of octets[sent_n], or the end of the last one */
    bool sending, sent_pending, driver;
    struct hv_wire wire;

    char con_in[CON_MAX], con_out[CON_MAX], con_read[CON_MAX];
    size_t con_in_n, con_in_at, con_out_n;
} vm;

struct hv_seen hv_seen;
struct hv_port hv_port;
uint8_t hv_nv[HAL_NV_SIZE];
bool hv_nv_broken;

static void fail_aloud(const char *what)
{
    fprintf(stderr, "virtual port: %s\n", what);
    abort();
}

void (*hv_on_failure)(const char *what) = fail_aloud;

/* ---- events ------------------------------------------------------------------------------------------- */

static bool before(const struct event *a, const struct event *b)
{
    return a->at != b->at ? a->at < b->at : a->order < b->order;
}

void hv_at(hv_time t, void (*fn)(void *arg, uint32_t value), void *arg, uint32_t value)
{
    const struct event e = {t < vm.now ? vm.now : t, vm.order++, fn, arg, value};
    if (vm.events == vm.room) {
        vm.room = vm.room ? 2 * vm.room : 256;
        vm.heap = realloc(vm.heap, vm.room * sizeof vm.heap[0]);
        if (!vm.heap)
            abort();
    }
    size_t i = vm.events++;
    for (; i > 0 && before(&e, &vm.heap[(i - 1) / 2]); i = (i - 1) / 2)
        vm.heap[i] = vm.heap[(i - 1) / 2];
    vm.heap[i] = e;
}

static struct event take_event(void)
{
    const struct event first = vm.heap[0];
    const struct event last = vm.heap[--vm.events];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child + 1 < vm.events && before(&vm.heap[child + 1], &vm.heap[child]))
            child++;
        if (child >= vm.events || !before(&vm.heap[child], &last))
            break;
        vm.heap[i] = vm.heap[child];
        i = child;
    }
    vm.heap[i] = last;
    return first;
}

/* ---- interrupts --------------------------------------------------------------------------------------- */

/* When the next upcall is due, were interrupts not masked. */
static hv_time interrupt_due(void)
{
    hv_time due = vm.sent_pending ? vm.now : HV_NEVER;
    if (vm.pending && vm.fifo[0].end + hv_port.octet_latency < due)
        due = vm.fifo[0].end + hv_port.octet_latency;
    if (vm.limit_armed && !vm.sending && vm.quiet_since + vm.limit < due)
        due = vm.quiet_since + vm.limit;
    return due < vm.now ? vm.now : due;
}

static void take_octet(void)
{
    const uint8_t octet = vm.fifo[0].octet, err = vm.fifo[0].err;
    vm.quiet_since = vm.fifo[0].end;
    vm.limit_armed = vm.limit != 0;
    vm.pending--;
    memmove(&vm.fifo[0], &vm.fifo[1], vm.pending * sizeof vm.fifo[0]);
    hv_seen.octets_in++;
    line_octet_isr(octet, err);
}

/* One upcall: the receiver before the silence (hal.h). */
static void interrupt(void)
{
    vm.in_isr = true;
    if (vm.sent_pending) {
        vm.sent_pending = false;
        line_sent_isr();
    } else if (vm.pending) {
        take_octet();
    } else {
        vm.limit_armed = false;
        line_silence_isr();
    }
    vm.in_isr = false;
}

static bool interruptible(void)
{
    return vm.on && !vm.masked && !vm.in_isr;
}

/* ---- transmitter -------------------------------------------------------------------------------------- */

static void drive(bool on)
{
    if (vm.driver == on)
        return;
    vm.driver = on;
    if (vm.wire.driver)
        vm.wire.driver(on);
}

static void transmit(void)
{
    if (vm.sent_n < vm.n) {
        const uint8_t octet = vm.octets[vm.sent_n++];
        const hv_time start = vm.tx_due;
        vm.tx_due = start + vm.char_bits * vm.bit;
        if (vm.wire.octet && !(vm.format & HAL_LOOP))
            vm.wire.octet(octet, start, vm.tx_due);
        if (vm.format & HAL_LOOP)
            hv_inject(vm.tx_due, octet, 0);
        return;
    }
    vm.sending = false;
    vm.quiet_since = vm.now;
    vm.limit_armed = vm.limit != 0;
    vm.sent_pending = true;
    drive(false);
}

/* ---- the engine --------------------------------------------------------------------------------------- */

static void run_loop(void)
{
    vm.in_loop = true;
    vm.loop();
    vm.in_loop = false;
    vm.loop_due = vm.now + (vm.wait ? vm.wait() : LOOP_WAIT);
}

/* Do the earliest thing not later than t. -> there was one. */
static bool step(hv_time t)
{
    const hv_time event = vm.events ? vm.heap[0].at : HV_NEVER;
    const hv_time tx = vm.sending ? vm.tx_due : HV_NEVER;
    const hv_time irq = interruptible() ? interrupt_due() : HV_NEVER;
    const hv_time loop = vm.on && vm.loop && !vm.in_loop ? vm.loop_due : HV_NEVER;
    const hv_time a = event < tx ? event : tx;
    const hv_time b = irq < loop ? irq : loop;
    const hv_time next = a < b ? a : b;
    if (next > t)
        return false;
    if (next > vm.now)
        vm.now = next;
    if (tx == next) {
        transmit();
    } else if (event == next) {
        const struct event e = take_event();
        e.fn(e.arg, e.value);
    } else if (irq == next) {
        interrupt();
    } else {
        run_loop();
    }
    return true;
}

static void start_over(void)
{
    drive(false);
    vm.sending = vm.sent_pending = vm.in_isr = vm.in_loop = vm.limit_armed = vm.overrun = false;
    vm.pending = 0;
    vm.limit = vm.bit = 0;
    vm.masked = true;
    vm.tick_zero = vm.loop_due = vm.now;
}

void hv_run_until(hv_time t)
{
    if (vm.depth) {
        hv_on_failure("hv_run_until() inside itself: the station's code uses hv_spend()");
        return;
    }
    vm.depth = 1;
    vm.restartable = true;
    if (setjmp(vm.restart)) {
        start_over();
        if (vm.boot)
            vm.boot();
    }
    while (step(t)) {
    }
    vm.restartable = false;
    vm.depth = 0;
    if (t > vm.now)
        vm.now = t;
}

void hv_run_for(hv_time duration)
{
    hv_run_until(vm.now + duration);
}

void hv_spend(hv_time duration)
{
    const hv_time end = vm.now + duration;
    const bool in_loop = vm.in_loop;
    if (vm.in_isr) {
        hv_on_failure("hv_spend() in an interrupt");
        return;
    }
    vm.in_loop = true; /* main is here, not at the top of its loop */
    while (step(end)) {
    }
    vm.in_loop = in_loop;
    if (end > vm.now)
        vm.now = end;
}

hv_time hv_now(void)
{
    return vm.now;
}

void hv_begin(void)
{
    struct event *const heap = vm.heap;
    const size_t room = vm.room;
    memset(&vm, 0, sizeof vm);
    vm.heap = heap;
    vm.room = room;
    vm.switches = 126;
    vm.masked = true;
    vm.on = true;
    memset(&hv_seen, 0, sizeof hv_seen);
    memset(&hv_port, 0, sizeof hv_port);
    hv_port.fifo = 1;
    memset(hv_nv, 0xFF, sizeof hv_nv);
    hv_nv_broken = false;
    hv_on_failure = fail_aloud;
}

void hv_set_boot(void (*boot)(void))
{
    vm.boot = boot;
}

void hv_power_on(void)
{
    start_over();
    vm.on = true;
    if (vm.boot)
        vm.boot();
}

void hv_power_off(void)
{
    start_over();
    vm.on = false;
}

void hv_set_loop(void (*loop)(void), hv_time (*wait)(void))
{
    vm.loop = loop;
    vm.wait = wait;
    vm.loop_due = vm.now;
}

void hv_set_switches(uint8_t address)
{
    vm.switches = address;
}

/* ---- the station's side ------------------------------------------------------------------------------- */

static void main_only(const char *service)
{
    static char text[80];
    if (!vm.in_isr)
        return;
    snprintf(text, sizeof text, "%s called in an interrupt", service);
    hv_on_failure(text);
}

static void isr_or_lock(const char *service)
{
    static char text[80];
    if (vm.in_isr || vm.masked)
        return;
    snprintf(text, sizeof text, "%s called in main with interrupts on", service);
    hv_on_failure(text);
}

void hal_init(void)
{
    main_only("hal_init");
}

uint8_t hal_irq_save(void)
{
    main_only("hal_irq_save");
    const uint8_t state = (uint8_t)!vm.masked; /* HAL_IRQ_ON is 1 */
    vm.masked = true;
    return state;
}

void hal_irq_restore(uint8_t state)
{
    main_only("hal_irq_restore");
    vm.masked = state != HAL_IRQ_ON;
    while (interruptible() && interrupt_due() <= vm.now)
        interrupt();
}

uint16_t hal_ticks(void)
{
    main_only("hal_ticks");
    return (uint16_t)((vm.now - vm.tick_zero) / HV_MS);
}

uint8_t hal_nv_read(uint8_t index)
{
    main_only("hal_nv_read");
    if (index < HAL_NV_SIZE)
        return hv_nv[index];
    hv_on_failure("hal_nv_read: index");
    return 0xFF;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    main_only("hal_nv_write");
    if (index >= HAL_NV_SIZE) {
        hv_on_failure("hal_nv_write: index");
        return false;
    }
    hv_seen.nv_writes++;
    if (!hv_nv_broken)
        hv_nv[index] = value;
    return hv_nv[index] == value;
}

uint8_t hal_switches(void)
{
    main_only("hal_switches");
    return vm.switches;
}

void hal_wdog_kick(void)
{
    main_only("hal_wdog_kick");
    hv_seen.wdog_kicks++;
}

void hal_idle(void)
{
    main_only("hal_idle");
    hv_seen.idles++;
}

void hal_reset(uint8_t why)
{
    hv_seen.resets++;
    hv_seen.reset_why = why;
    if (why == HAL_RESET_ASSERT)
        hv_on_failure("a failed ASSERT of the station");
    if (!vm.restartable)
        hv_on_failure("hal_reset() outside hv_run_until()");
    longjmp(vm.restart, 1);
}

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
    main_only("hal_line_open");
    const hv_time bit = hv_bit_of(bit_per_s);
    if (!bit || !board_can(bit_per_s) || (format & (uint8_t)~HAL_LOOP) >= HAL_FORMATS)
        return HAL_LINE_NO;
    vm.bit = bit;
    vm.format = format;
    vm.char_bits = bits[format & (uint8_t)~HAL_LOOP];
    vm.sending = vm.sent_pending = vm.overrun = vm.limit_armed = false;
    vm.pending = 0;
    vm.limit = 0;
    vm.quiet_since = vm.now;
    drive(false);
    hv_seen.opens++;
    return hv_port.untimed ? HAL_LINE_UNTIMED : HAL_LINE_TIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    main_only("hal_tbit");
    const hv_time d = n * vm.bit;
    return d > UINT32_MAX ? UINT32_MAX : (hal_dur_t)d;
}

void hal_silence(hal_dur_t d) IN_ISR
{
    isr_or_lock("hal_silence");
    vm.limit = d;
    vm.limit_armed = d != 0 && vm.bit != 0;
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    isr_or_lock("hal_send");
    if (vm.sending || n == 0 || !vm.bit) {
        hv_on_failure(vm.sending ? "hal_send while sending" : "hal_send of nothing or on a closed line");
        return;
    }
    vm.octets = octets;
    vm.n = n;
    vm.sent_n = 0;
    vm.sending = true;
    vm.tx_due = vm.now + hv_port.send_latency;
    if (!(vm.format & HAL_LOOP))
        drive(true);
}

/* ---- the line, the test's side ------------------------------------------------------------------------ */

void hv_receive(uint8_t octet, uint8_t err)
{
    if (!vm.on || !vm.bit || vm.driver)
        return;
    if (vm.pending >= hv_port.fifo || vm.pending >= FIFO_MAX) {
        hv_seen.octets_lost++;
        vm.overrun = true;
        return;
    }
    vm.fifo[vm.pending].octet = octet;
    vm.fifo[vm.pending].err = (uint8_t)(err | (vm.overrun ? HAL_ERR_OVERRUN : 0));
    vm.fifo[vm.pending++].end = vm.now;
    vm.overrun = false;
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
    vm.wire = *wire;
}

bool hv_driver(void)
{
    return vm.driver;
}

hv_time hv_bit(void)
{
    return vm.bit;
}

uint8_t hv_char_bits(void)
{
    return vm.char_bits;
}

uint8_t hv_format(void)
{
    return vm.format;
}

/* ---- console ------------------------------------------------------------------------------------------ */

int16_t hal_con_get(void)
{
    main_only("hal_con_get");
    return vm.con_in_at < vm.con_in_n ? (uint8_t)vm.con_in[vm.con_in_at++] : -1;
}

void hal_con_put(uint8_t octet)
{
    main_only("hal_con_put");
    if (vm.con_out_n < CON_MAX - 1)
        vm.con_out[vm.con_out_n++] = (char)octet;
}

void hv_con_type(const char *text)
{
    for (; *text && vm.con_in_n < CON_MAX; text++)
        vm.con_in[vm.con_in_n++] = *text;
}

const char *hv_con_text(void)
{
    memcpy(vm.con_read, vm.con_out, vm.con_out_n);
    vm.con_read[vm.con_out_n] = 0;
    vm.con_out_n = 0;
    return vm.con_read;
}
