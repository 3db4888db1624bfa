/* The port in real time: one thread, one line (line_pty.c, line_tty.c), standard input and output as the
 * console.
 *
 * An "interrupt" is an upcall made inside hal_idle() while not masked. hal_idle() sleeps in ppoll() until an
 * octet comes, the clock of silence runs out, or IDLE_NS is over, so that the main loop sees the ticks go by.
 *
 * The host hears octets in lumps and late, so silence is counted from the moment they were read, and every
 * line is HAL_LINE_UNTIMED. An octet that has arrived counts before a silence that has run out: ppoll() looks
 * for both. */
#define _GNU_SOURCE /* ppoll() */
#include "hal/hal.h"
#include "hal_host.h"
#include "line.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

#define NS_PER_S  1000000000u
#define NS_PER_MS 1000000u

/* our choice, all three: the main loop runs at least 250 times a second; a silence shorter than the kernel
 * could wake us for is over at once; octets no one fetches for so long are lost, as on a wire. */
#define IDLE_NS    (4u * NS_PER_MS)
#define AT_ONCE_NS 50000u
#define STUCK_NS   (100u * NS_PER_MS)

#define RX_CHUNK 1024u

enum tx_state { TX_OFF, TX_WRITING, TX_SHIFTING, TX_LOOPED };

/* Invariant: limit_ns != 0 where armed; tx.octets[0..tx.left-1] is what TX_WRITING has still to write. */
static struct {
    struct line line;
    bool masked;
    bool open; /* hal_line_open() has succeeded: octets are for the stack */
    bool loop;
    uint8_t unmark;
    uint32_t bit_per_s;
    uint8_t bits; /* of one character, start and stop included */
    uint64_t start_ns;
} hal;

static struct {
    uint64_t end_ns;   /* end of the last octet heard or sent                        */
    uint64_t empty_ns; /* the receiver was last found empty: silence is proven so far */
    hal_dur_t limit_ns;
    bool armed;
} silence;

static struct {
    enum tx_state state;
    const uint8_t *octets;
    uint16_t left;
    uint64_t until_ns; /* TX_WRITING: give up. TX_SHIFTING: the last stop bit is out */
} tx;

static uint8_t switches;
static volatile sig_atomic_t stopping;
void (*hal_host_tap)(const uint8_t *octets, const uint8_t *err, uint16_t n);

static uint64_t now_ns(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (uint64_t)t.tv_sec * NS_PER_S + (uint64_t)t.tv_nsec;
}

/* ---- start and end ------------------------------------------------------------------------------ */

static void note_signal(int number)
{
    (void)number;
    stopping = 1;
}

static void close_line(void)
{
    hal.line.close(&hal.line);
}

static void set_up_signals(void)
{
    static const int ends[] = {SIGTERM, SIGINT, SIGHUP};
    struct sigaction note = {.sa_handler = note_signal};
    struct sigaction ignore = {.sa_handler = SIG_IGN};
    size_t i;

    for (i = 0; i < sizeof ends / sizeof *ends; i++)
        sigaction(ends[i], &note, NULL);
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGTTIN, &ignore,
              NULL); /* a background job may not read the terminal: that is an end of input */
}

const char *hal_host_open(const struct hal_host *host)
{
    const char *wrong;

    switches = host->switches;
    wrong = nv_file_open(host->nv);
    if (wrong)
        return wrong;
    set_up_signals();
    if (strncmp(host->line, "pty:", 4) == 0)
        wrong = line_pty_open(&hal.line, host->line + 4);
    else
        wrong = line_tty_open(&hal.line, host->line);
    if (!wrong)
        atexit(close_line);
    return wrong;
}

bool hal_host_stopping(void)
{
    return stopping != 0;
}

void hal_init(void)
{
    prctl(PR_SET_TIMERSLACK, 1ul);
    hal.masked = true;
    hal.start_ns = now_ns();
}

void hal_reset(uint8_t why)
{
    if (why != HAL_RESET_ASKED)
        fprintf(stderr, "internal fault, the station ends with status %u\n", why);
    exit(why);
}

/* ---- machine ------------------------------------------------------------------------------------ */

uint8_t hal_irq_save(void)
{
    uint8_t state = hal.masked ? 0 : (uint8_t)HAL_IRQ_ON;

    hal.masked = true;
    return state;
}

void hal_irq_restore(uint8_t state)
{
    hal.masked = state != HAL_IRQ_ON;
}

uint16_t hal_ticks(void)
{
    return (uint16_t)((now_ns() - hal.start_ns) / NS_PER_MS);
}

uint8_t hal_switches(void)
{
    return switches;
}

void hal_wdog_kick(void)
{
}

/* ---- the line ----------------------------------------------------------------------------------- */

/* our choice: a pty counts as silent before it is opened, too. What was said before is not there any more, and the
 * first request of a master need not be lost. */
uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    static const uint8_t bits[HAL_FORMATS] = {11, 11, 11, 10, 10, 10, 10};
    uint8_t plain = format & (uint8_t)~HAL_LOOP;

    if (plain >= HAL_FORMATS || !hal.line.set(&hal.line, bit_per_s, plain))
        return HAL_LINE_NO;
    hal.open = true;
    hal.loop = (format & HAL_LOOP) != 0;
    hal.unmark = 0;
    hal.bit_per_s = bit_per_s;
    hal.bits = bits[plain];
    tx.state = TX_OFF;
    silence.limit_ns = 0;
    silence.armed = false;
    silence.empty_ns = now_ns();
    silence.end_ns = hal.line.bit_time ? silence.empty_ns : 0;
    return HAL_LINE_UNTIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    uint64_t ns;

    ASSERT(hal.bit_per_s != 0);
    ns = ((uint64_t)n * NS_PER_S + hal.bit_per_s - 1u) / hal.bit_per_s;

    return ns < UINT32_MAX ? (hal_dur_t)ns : UINT32_MAX;
}

void hal_silence(hal_dur_t d) IN_ISR
{
    silence.limit_ns = d;
    silence.armed = d != 0;
}

bool hal_silent(hal_dur_t d) IN_ISR
{
    (void)d;
    return false;
}

static void line_was_used(uint64_t until_ns)
{
    silence.end_ns = until_ns;
    silence.armed = silence.limit_ns != 0;
}

/* Write what the line takes now. What nobody will ever take counts as sent. */
static void write_on(uint64_t now)
{
    ssize_t n = 0;

    if (hal.line.present)
        n = write(hal.line.fd, tx.octets, tx.left);
    else
        tx.left = 0;
    if (n > 0) {
        tx.octets += n;
        tx.left = (uint16_t)(tx.left - n);
        tx.until_ns += hal.line.bit_time ? (uint64_t)n * hal.bits * NS_PER_S / hal.bit_per_s : 0;
    } else if (n < 0 && errno != EAGAIN && errno != EINTR) {
        hal.line.hangup(&hal.line);
        tx.left = 0;
    }
    if (now > tx.until_ns + STUCK_NS)
        tx.left = 0;
    if (tx.left == 0)
        tx.state = TX_SHIFTING;
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    ASSERT(n != 0 && tx.state == TX_OFF);
    tx.octets = octets;
    tx.left = n;
    tx.until_ns = now_ns();
    tx.state = hal.loop ? TX_LOOPED : TX_WRITING;
    if (hal_host_tap)
        hal_host_tap(octets, NULL, n);
    if (tx.state == TX_WRITING)
        write_on(tx.until_ns);
}

/* TX_SHIFTING: is the last stop bit out? The driver knows how many octets wait; the rest is computed. */
static bool all_out(uint64_t now)
{
    int waiting = 0;

    if (!hal.line.bit_time)
        return true;
    if (now < tx.until_ns)
        return false;
    if (ioctl(hal.line.fd, TIOCOUTQ, &waiting) != 0 || waiting <= 0)
        return true;
    tx.until_ns = now + (uint64_t)waiting * hal.bits * NS_PER_S / hal.bit_per_s;
    return false;
}

static void finish_sending(uint64_t now)
{
    tx.state = TX_OFF;
    line_was_used(now);
    line_sent_isr();
}

static void feed_back(void)
{
    uint16_t i;

    for (i = 0; i < tx.left && tx.state == TX_LOOPED; i++) {
        line_was_used(now_ns());
        line_octet_isr(tx.octets[i], 0);
    }
    if (tx.state == TX_LOOPED)
        finish_sending(now_ns());
}

/* Make the upcalls that are due. True: some were. */
static bool serve(uint64_t now)
{
    bool any = false;

    for (;;) {
        if (tx.state == TX_LOOPED)
            feed_back();
        else if (tx.state == TX_SHIFTING && all_out(now))
            finish_sending(now);
        else if (tx.state == TX_OFF && silence.armed &&
                 silence.end_ns + silence.limit_ns <= silence.empty_ns + AT_ONCE_NS) {
            silence.armed = false;
            line_silence_isr();
        } else {
            return any;
        }
        any = true;
    }
}

/* On a pty an answer is sent before the next octet is looked at: that may be the start of the next request.
 * On a line with bit times we are deaf while we send. */
static void hear(const uint8_t *octets, const uint8_t *err, uint16_t n, uint64_t now)
{
    uint16_t i;

    if (hal_host_tap)
        hal_host_tap(octets, err, n);
    for (i = 0; i < n && tx.state == TX_OFF; i++) {
        line_was_used(now);
        line_octet_isr(octets[i], err[i]);
        if (tx.state == TX_SHIFTING && !hal.line.bit_time)
            finish_sending(now);
    }
}

static void receive(void)
{
    uint8_t raw[RX_CHUNK], octets[RX_CHUNK], err[RX_CHUNK];
    ssize_t got = read(hal.line.fd, raw, sizeof raw);
    uint64_t now = now_ns();
    uint16_t n = 0;
    ssize_t i;

    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) {
        hal.line.hangup(&hal.line);
        return;
    }
    if (got < (ssize_t)sizeof raw)
        silence.empty_ns = now;
    if (hal.loop || tx.state != TX_OFF) /* half duplex: what comes while we send is our own echo or noise */
        return;
    for (i = 0; i < got; i++) {
        if (hal.line.marked) {
            n = (uint16_t)(n + line_unmark(&hal.unmark, raw[i], &octets[n], &err[n]));
        } else {
            octets[n] = raw[i];
            err[n++] = 0;
        }
    }
    if (n != 0)
        hear(octets, err, n, now);
}

/* ---- sleeping ----------------------------------------------------------------------------------- */

static uint64_t until(uint64_t now, uint64_t event, uint64_t at_most)
{
    uint64_t wait = event > now ? event - now : 0;

    return wait < at_most ? wait : at_most;
}

static uint64_t sleep_ns(uint64_t now)
{
    uint64_t ns = IDLE_NS;

    if (tx.state == TX_SHIFTING)
        ns = until(now, tx.until_ns, ns);
    else if (tx.state == TX_OFF && silence.armed)
        ns = until(now, silence.end_ns + silence.limit_ns, ns);
    return ns;
}

static void wait_for_something(void)
{
    enum { CONSOLE, EVENT, LINE, FDS };
    struct timespec timeout = {.tv_nsec = (long)sleep_ns(now_ns())};
    struct pollfd p[FDS] = {
        [CONSOLE] = {.fd = con_input(), .events = POLLIN},
        [EVENT] = {.fd = hal.line.event_fd, .events = POLLIN},
        [LINE] = {.fd = hal.line.present && hal.open ? hal.line.fd : -1, .events = POLLIN},
    };
    int n;

    if (tx.state == TX_WRITING)
        p[LINE].events |= POLLOUT;
    n = ppoll(p, FDS, &timeout, NULL);
    if (n <= 0) {
        if (n == 0)
            silence.empty_ns = now_ns();
    } else {
        if (p[EVENT].revents)
            hal.line.event(&hal.line);
        if (p[LINE].revents & ~POLLOUT)
            receive();
        else
            silence.empty_ns = now_ns();
        if (p[CONSOLE].revents)
            con_read();
    }
    if (tx.state == TX_WRITING)
        write_on(now_ns());
}

void hal_idle(void)
{
    if (hal.masked)
        return;
    if (serve(now_ns())) /* set up by the main loop: it may want to go on with the result */
        return;
    wait_for_something();
    serve(now_ns());
}
