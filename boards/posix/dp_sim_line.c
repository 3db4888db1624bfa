/* A line of fieldling-master that is a simulated RS-485 segment in this process, with DP-TEST01 on it.
 *
 * Both ends, the segment and its judge run in virtual time, exact to 1/576 us, which is paced to go by as
 * fast as real time does: T_SDR and T_SYN are those of the segment, not of this computer. The station is the
 * firmware, from the UART's interrupts upwards; the master shares no code with it. */
#include "board.h"
#include "dp_sim.h"
#include "dp_test01_app.h"
#include "phy_uart/phy_uart.h"
#include "sim/segment.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/select.h>
#include <time.h>

#define FRAME_NS    50000000l     /* virtual time goes by in steps of so much real time */
#define CATCH_UP    (HV_S / 5u)   /* a computer that cannot follow shows a slower bus, not a wrong one */
#define STARTS_UP   (10u * HV_MS) /* from power-up until the station listens */
#define SLOT_MARGIN 22u           /* [T_bit] beyond max_T_SDR: two characters */

struct dp_sim dp_sim;

/* ---- the station's board: a room that warms up and cools down, and a door switch --------------------- */

/* 30 .. 34 degrees and back within 8 s. */
static uint8_t temperature(void)
{
    unsigned step = (unsigned)(hv_now() / HV_S) % 8u;

    return (uint8_t)(30u + (step < 4u ? step : 8u - step));
}

static uint8_t door(void)
{
    return hv_now() / (700u * HV_MS) % 3u == 2u;
}

uint8_t board_input(uint8_t module)
{
    return module == 0 ? temperature() : door();
}

void board_output(uint8_t module, uint8_t value)
{
    dp_sim.out[module] = value;
}

static void boot(void)
{
    hal_init();
    dp_test01_init(hal_switches(), dp_sim.baud);
    hal_irq_restore(HAL_IRQ_ON);
}

/* ---- the master's end of the segment ----------------------------------------------------------------- */

static struct seg_party master;
static struct master_line *line;

/* Who listens during wait(). */
static void (*listener)(void *of, uint64_t now, uint8_t octet);
static void *listener_of;

static void hear_octet(struct seg_party *self, uint8_t octet, uint8_t err)
{
    (void)self;
    (void)err; /* this segment has no faults */
    if (listener)
        listener(listener_of, hv_now(), octet);
}

static void send_octets(void *of, const uint8_t *octets, unsigned n)
{
    (void)of;
    seg_send(&master, hv_now(), octets, n, NULL);
}

static void note_telegram(const char *who, hv_time start, const uint8_t *octets, unsigned n)
{
    ml_said(line, start, octets, n);
    dp_sim_telegram(strcmp(who, master.name) != 0, start, octets, n);
}

/* ---- pace -------------------------------------------------------------------------------------------- */

static hv_time real_start; /* of virtual time, on the real clock */
static hv_time horizon;    /* as far as virtual time may go now */

static hv_time real_time(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (hv_time)t.tv_sec * HV_S + (hv_time)t.tv_nsec * HV_US / 1000u;
}

/* Real time goes by. -> 2 `also` is readable, else 1 */
static int next_frame(int also)
{
    const struct timespec frame = {.tv_nsec = FRAME_NS};
    fd_set readable;
    int ready;

    fflush(stdout);
    FD_ZERO(&readable);
    if (also >= 0)
        FD_SET(also, &readable);
    ready = pselect(also + 1, &readable, NULL, NULL, &frame, NULL);
    horizon = real_time() - real_start;
    if (horizon > hv_now() + CATCH_UP) {
        real_start += horizon - hv_now() - CATCH_UP;
        horizon = hv_now() + CATCH_UP;
    }
    return ready > 0 ? 2 : 1;
}

/* ---- the kind of line -------------------------------------------------------------------------------- */

static const char *take_address(const char *text)
{
    char *end;
    unsigned long address = *text ? strtoul(text, &end, 10) : 8;

    if (*text && (*end || end == text || address > 126))
        return "sim:ADDRESS, 0 to 126, is expected";
    dp_sim.address = (uint8_t)address;
    return NULL;
}

static const char *take_rate(uint32_t rate)
{
    for (dp_sim.baud = 0; dp_sim.baud < PHY_BAUDS; dp_sim.baud++)
        if (phy_bit_per_s(dp_sim.baud) == rate)
            return NULL;
    return "the simulated segment has the rates 9600, 19200, 38400, 45450, 93750, 187500, 500000, 1500000, "
           "3000000, 6000000, 12000000";
}

static const char *sim_open(struct master_line *l, const char *path, unsigned slot_ms, struct ini *ini)
{
    const char *bad = take_address(path + sizeof ML_SIM - 1);

    (void)slot_ms;
    if (!bad)
        bad = take_rate(l->rate);
    if (bad)
        return bad;
    line = l;
    hv_begin();
    hv_set_switches(dp_sim.address);
    seg_begin(l->rate, dp_sim.address);
    seg_trace = note_telegram;
    hv_set_boot(boot);
    hv_set_loop(dp_test01_poll, NULL);
    hv_power_on();
    hv_run_for(STARTS_UP);
    master = (struct seg_party){.name = "master", .judged = true, .hears = hear_octet};
    seg_attach(&master);
    ini->bit = master.bit;
    ini->slot = (seg_max_t_sdr() + SLOT_MARGIN) * master.bit;
    ini->gap = 33 * master.bit;
    ini->untimed = false;
    ini->send = send_octets;
    real_start = real_time() - hv_now();
    return NULL;
}

static void sim_close(struct master_line *l)
{
    (void)l;
    hv_power_off();
}

static uint64_t sim_now(const struct master_line *l)
{
    (void)l;
    return hv_now();
}

/* Not longer than a character: who hears one may be due earlier. A master that is due already lets a bit time
 * go by. */
static int sim_wait(struct master_line *l, uint64_t until, int also,
                    void (*hear)(void *of, uint64_t now, uint8_t octet), void *of)
{
    hv_time now = hv_now();
    hv_time end = now + 11u * master.bit;

    (void)l;
    if (now >= horizon)
        return next_frame(also);
    if (until < end)
        end = until > now ? until : now + master.bit;
    listener = hear;
    listener_of = of;
    hv_run_until(end);
    listener = NULL;
    return 1;
}

const struct ml_kind ml_sim = {sim_open, sim_close, sim_now, sim_wait, &dp_sim_view};
