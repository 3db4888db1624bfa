/* The port in virtual time (hal_virtual.h).
 *
 * One loop (step) takes the earliest of: the test's events (a heap), the transmitter, the next pass of the
 * main loop, the next interrupt that becomes due. The line is in hal_virtual_line.c.
 */
#include "hal_virtual_vm.h"

#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CON_MAX   4096u
#define LOOP_WAIT (100u * HV_US)

struct event {
    hv_time at;
    uint64_t order;
    void (*fn)(void *arg, uint32_t value);
    void *arg;
    uint32_t value;
};

/* What the station's code cannot reach. Invariant: heap[0] is the earliest event. */
static struct {
    struct event *heap;
    size_t events, room;
    uint64_t order;

    bool running, restartable;
    jmp_buf restart;
    void (*boot)(void);
    void (*loop)(void);
    hv_time (*wait)(void);
    hv_time loop_due;

    char con_in[CON_MAX], con_out[CON_MAX], con_read[CON_MAX];
    size_t con_in_n, con_in_at, con_out_n;
} host;

struct hv_vm hv_vm;
struct hv_seen hv_seen;
uint8_t hv_nv[HAL_NV_SIZE];
bool hv_nv_broken;

static void fail_aloud(const char *what)
{
    fprintf(stderr, "virtual port: %s\n", what);
    abort();
}

void (*hv_on_failure)(const char *what) = fail_aloud;

void hv_main_only(const char *service)
{
    static char text[80];
    if (!hv_vm.in_isr)
        return;
    snprintf(text, sizeof text, "%s called in an interrupt", service);
    hv_on_failure(text);
}

void hv_isr_or_lock(const char *service)
{
    static char text[80];
    if (hv_vm.in_isr || hv_vm.masked)
        return;
    snprintf(text, sizeof text, "%s called in main with interrupts on", service);
    hv_on_failure(text);
}

/* ---- events ------------------------------------------------------------------------------------------- */

static bool before(const struct event *a, const struct event *b)
{
    return a->at != b->at ? a->at < b->at : a->order < b->order;
}

void hv_at(hv_time t, void (*fn)(void *arg, uint32_t value), void *arg, uint32_t value)
{
    const struct event e = {t < hv_vm.now ? hv_vm.now : t, host.order++, fn, arg, value};
    if (host.events == host.room) {
        host.room = host.room ? 2 * host.room : 256;
        host.heap = realloc(host.heap, host.room * sizeof host.heap[0]);
        if (!host.heap)
            abort();
    }
    size_t i = host.events++;
    for (; i > 0 && before(&e, &host.heap[(i - 1) / 2]); i = (i - 1) / 2)
        host.heap[i] = host.heap[(i - 1) / 2];
    host.heap[i] = e;
}

static struct event take_event(void)
{
    const struct event first = host.heap[0];
    const struct event last = host.heap[--host.events];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child + 1 < host.events && before(&host.heap[child + 1], &host.heap[child]))
            child++;
        if (child >= host.events || !before(&host.heap[child], &last))
            break;
        host.heap[i] = host.heap[child];
        i = child;
    }
    host.heap[i] = last;
    return first;
}

/* ---- the engine --------------------------------------------------------------------------------------- */

static void run_loop(void)
{
    hv_vm.in_loop = true;
    host.loop();
    hv_vm.in_loop = false;
    host.loop_due = hv_vm.now + (host.wait ? host.wait() : LOOP_WAIT);
}

/* Do the earliest thing not later than t. -> there was one. */
static bool step(hv_time t)
{
    const hv_time event = host.events ? host.heap[0].at : HV_NEVER;
    const hv_time tx = hv_vm.sending ? hv_vm.tx_due : HV_NEVER;
    const hv_time irq = hv_interruptible() ? hv_interrupt_due() : HV_NEVER;
    const hv_time loop = hv_vm.on && host.loop && !hv_vm.in_loop ? host.loop_due : HV_NEVER;
    const hv_time a = event < tx ? event : tx;
    const hv_time b = irq < loop ? irq : loop;
    const hv_time next = a < b ? a : b;
    if (next > t)
        return false;
    if (next > hv_vm.now)
        hv_vm.now = next;
    if (tx == next) {
        hv_transmit();
    } else if (event == next) {
        const struct event e = take_event();
        e.fn(e.arg, e.value);
    } else if (irq == next) {
        hv_interrupt();
    } else {
        run_loop();
    }
    return true;
}

static void start_over(void)
{
    hv_vm_line_off();
    hv_vm.in_isr = hv_vm.in_loop = false;
    hv_vm.masked = true;
    hv_vm.tick_zero = host.loop_due = hv_vm.now;
}

void hv_run_until(hv_time t)
{
    if (host.running) {
        hv_on_failure("hv_run_until() inside itself: the station's code uses hv_spend()");
        return;
    }
    host.running = true;
    host.restartable = true;
    if (setjmp(host.restart)) {
        start_over();
        if (host.boot)
            host.boot();
    }
    while (step(t)) {
    }
    host.restartable = false;
    host.running = false;
    if (t > hv_vm.now)
        hv_vm.now = t;
}

void hv_run_for(hv_time duration)
{
    hv_run_until(hv_vm.now + duration);
}

void hv_spend(hv_time duration)
{
    const hv_time end = hv_vm.now + duration;
    const bool in_loop = hv_vm.in_loop;
    if (hv_vm.in_isr) {
        hv_on_failure("hv_spend() in an interrupt");
        return;
    }
    hv_vm.in_loop = true; /* main is here, not at the top of its loop */
    while (step(end)) {
    }
    hv_vm.in_loop = in_loop;
    if (end > hv_vm.now)
        hv_vm.now = end;
}

bool hv_interruptible_now(void)
{
    return hv_interruptible();
}

hv_time hv_now(void)
{
    return hv_vm.now;
}

void hv_begin(void)
{
    struct event *const heap = host.heap;
    const size_t room = host.room;
    memset(&host, 0, sizeof host);
    host.heap = heap;
    host.room = room;
    memset(&hv_vm, 0, sizeof hv_vm);
    hv_vm.switches = 126;
    hv_vm.masked = true;
    hv_vm.on = true;
    memset(&hv_seen, 0, sizeof hv_seen);
    memset(&hv_port, 0, sizeof hv_port);
    hv_port.fifo = 1;
    memset(hv_nv, 0xFF, sizeof hv_nv);
    hv_nv_broken = false;
    hv_on_failure = fail_aloud;
}

void hv_set_boot(void (*boot)(void))
{
    host.boot = boot;
}

void hv_power_on(void)
{
    start_over();
    hv_vm.on = true;
    if (host.boot)
        host.boot();
}

void hv_power_off(void)
{
    start_over();
    hv_vm.on = false;
}

void hv_set_loop(void (*loop)(void), hv_time (*wait)(void))
{
    host.loop = loop;
    host.wait = wait;
    host.loop_due = hv_vm.now;
}

void hv_set_switches(uint8_t address)
{
    hv_vm.switches = address;
}

/* ---- the station's side, machine ----------------------------------------------------------------------- */

void hal_init(void)
{
    hv_main_only("hal_init");
}

uint8_t hal_irq_save(void)
{
    hv_main_only("hal_irq_save");
    const uint8_t state = (uint8_t)!hv_vm.masked; /* HAL_IRQ_ON is 1 */
    hv_vm.masked = true;
    return state;
}

void hal_irq_restore(uint8_t state)
{
    hv_main_only("hal_irq_restore");
    hv_vm.masked = state != HAL_IRQ_ON;
    while (hv_interruptible() && hv_interrupt_due() <= hv_vm.now)
        hv_interrupt();
}

uint16_t hal_ticks(void)
{
    hv_main_only("hal_ticks");
    return (uint16_t)((hv_vm.now - hv_vm.tick_zero) / HV_MS);
}

uint8_t hal_nv_read(uint8_t index)
{
    hv_main_only("hal_nv_read");
    if (index < HAL_NV_SIZE)
        return hv_nv[index];
    hv_on_failure("hal_nv_read: index");
    return 0xFF;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    hv_main_only("hal_nv_write");
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
    hv_main_only("hal_switches");
    return hv_vm.switches;
}

void hal_wdog_kick(void)
{
    hv_main_only("hal_wdog_kick");
    hv_seen.wdog_kicks++;
}

void hal_idle(void)
{
    hv_main_only("hal_idle");
    hv_seen.idles++;
}

void hal_reset(uint8_t why)
{
    hv_seen.resets++;
    hv_seen.reset_why = why;
    if (why == HAL_RESET_ASSERT)
        hv_on_failure("a failed ASSERT of the station");
    if (!host.restartable)
        hv_on_failure("hal_reset() outside hv_run_until()");
    longjmp(host.restart, 1);
}

/* ---- console ------------------------------------------------------------------------------------------ */

int16_t hal_con_get(void)
{
    hv_main_only("hal_con_get");
    return host.con_in_at < host.con_in_n ? (uint8_t)host.con_in[host.con_in_at++] : -1;
}

void hal_con_put(uint8_t octet)
{
    hv_main_only("hal_con_put");
    if (host.con_out_n < CON_MAX - 1)
        host.con_out[host.con_out_n++] = (char)octet;
}

void hv_con_type(const char *text)
{
    for (; *text && host.con_in_n < CON_MAX; text++)
        host.con_in[host.con_in_n++] = *text;
}

const char *hv_con_text(void)
{
    memcpy(host.con_read, host.con_out, host.con_out_n);
    host.con_read[host.con_out_n] = 0;
    host.con_out_n = 0;
    return host.con_read;
}
