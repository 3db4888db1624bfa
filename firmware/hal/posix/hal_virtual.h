/* The port in virtual time: one station, one process, deterministic. This is the test's side of it; the
 * station's side is hal.h.
 *
 * Nothing here waits. Time stands still while code runs and jumps to the next event in hv_run_until(). All
 * line events are exact to the tick, so a test may say "44 bit times and not one tick less".
 *
 * The port also checks the station's use of it (hal.h, contexts): a wrong use, or a failed ASSERT of the
 * station, ends in hv_on_failure().
 */
#ifndef FIELDLING_HAL_VIRTUAL_H
#define FIELDLING_HAL_VIRTUAL_H

#include "hal/hal.h"

/* One tick is 1/576 us: every bit time of PROFIBUS (9600 bit/s ... 12 Mbit/s) and of Modbus is a whole number
 * of ticks. 45.45 kbit/s, asked for as 45450, is 12 MHz / 264. */
typedef uint64_t hv_time;
#define HV_US    576u
#define HV_MS    576000u
#define HV_S     576000000u
#define HV_NEVER UINT64_MAX

/* ---- the machine ------------------------------------------------------------------------------------- */

/* Everything as delivered: time 0, no events, no hooks, all settings below at their defaults, NV memory
 * erased, interrupts masked. Once at the start of every test. */
void hv_begin(void);

/* What the station does after a reset: called after hal_reset() and by hv_power_on(). Statics of the station
 * are NOT set back; boot must initialise them like start-up code and main() would. */
void hv_set_boot(void (*boot)(void));

/* Power comes back: the machine as after reset (NV memory and settings stay, line closed, driver off,
 * interrupts masked, ticks from 0), then boot. hv_power_off(): all of it but boot; no main loop, dead line. */
void hv_power_on(void);
void hv_power_off(void);

/* The background loop: loop is called once per pass; wait() says how long after the end of a pass the next
 * one starts. wait = NULL is every 100 us. Interrupts happen between passes, and inside where the
 * application calls hv_spend(). loop = NULL: none. */
void hv_set_loop(void (*loop)(void), hv_time (*wait)(void));

/* Main code takes this long: events and interrupts happen meanwhile (masked ones are deferred). main, lock. */
void hv_spend(hv_time duration);

/* Could an interrupt happen now? False in an interrupt and while they are masked. */
bool hv_interruptible_now(void);

/* Address switches (default 126); NV memory as the station sees it; make the next writes of NV fail. */
void hv_set_switches(uint8_t address);
extern uint8_t hv_nv[HAL_NV_SIZE];
extern bool hv_nv_broken;

/* What the station did with the machine. */
struct hv_seen {
    uint16_t resets;   /* hal_reset() calls */
    uint8_t reset_why; /* of the last one */
    uint32_t wdog_kicks;
    uint32_t idles;
    uint32_t nv_writes;
    uint32_t opens;       /* hal_line_open() that did not answer no */
    uint32_t octets_in;   /* given to line_octet_isr() */
    uint32_t octets_lost; /* receiver full: interrupts were masked too long */
};
extern struct hv_seen hv_seen;

/* Called with one line of text on a failed ASSERT or a broken rule of hal.h. Default: stderr and abort(). */
extern void (*hv_on_failure)(const char *what);

/* ---- time -------------------------------------------------------------------------------------------- */

hv_time hv_now(void);

/* Let everything happen up to and including time t; then now is t. hv_run_for: from now on. Not nested. */
void hv_run_until(hv_time t);
void hv_run_for(hv_time duration);

/* Call fn(arg, value) at time t (not before now), outside the station. Events of the same time come in the
 * order they were asked for, and before the station's interrupts of that time. */
void hv_at(hv_time t, void (*fn)(void *arg, uint32_t value), void *arg, uint32_t value);

/* ---- the line ---------------------------------------------------------------------------------------- */

/* The station as it has the line open: bit time in ticks (0 = closed), bits of one character, HAL_ format. */
hv_time hv_bit(void);
uint8_t hv_char_bits(void);
uint8_t hv_format(void);

/* A bit time of a rate, in ticks; 0 when it is not a whole number. */
hv_time hv_bit_of(uint32_t bit_per_s);

/* An octet's last stop bit ends now / at time t, on the receiver's pin. Dropped while the line is closed,
 * or the driver is on. */
void hv_receive(uint8_t octet, uint8_t err);
void hv_inject(hv_time t, uint8_t octet, uint8_t err);

/* What the station puts on the line. octet is called when the start bit leaves, with the end of the stop bit;
 * driver when the driver enable changes. A driver switched off before `end` has cut that octet. */
struct hv_wire {
    void (*octet)(uint8_t octet, hv_time start, hv_time end);
    void (*driver)(bool on);
};
void hv_set_wire(const struct hv_wire *wire);
bool hv_driver(void);

/* ---- how good the port is: defaults are an ideal one --------------------------------------------------- */

struct hv_port {
    const uint32_t *rates; /* rates this board can, ends with 0; NULL: every rate with a whole bit time */
    hv_time octet_latency; /* from the end of the stop bit to line_octet_isr() */
    hv_time send_latency;  /* from hal_send() to the start bit */
    uint8_t fifo;          /* octets the receiver keeps while interrupts are masked; 1 at least */
    bool untimed;          /* hal_line_open() answers HAL_LINE_UNTIMED */
};
extern struct hv_port hv_port;

/* ---- console ----------------------------------------------------------------------------------------- */

void hv_con_type(const char *text); /* appended to what hal_con_get() will read */
const char *hv_con_text(void);      /* all that hal_con_put() got since the last call */

#endif
