/* Supervision of the bus: nothing heard for T_TO, or nothing that makes sense. Only for applications that take
 * fma_event_ind(): a device that takes none links boards/common/no_fma_watch.c instead. */
#include "fdl/fdl_priv.h"
#include "fdl/fma.h"
#include "phy_uart/phy_uart.h"

/* Time_out: T_TO = 6 T_SL + 2 n T_SL with n = 130 for a slave (EN 50170-2 part 4, 4.1.7); our choice: never less than
 * 100 ms, so that the event means "no master" and not "the master's computer was busy". */
#define T_TO_SLOTS_MS (uint32_t)133000 /* 266 slots, in ms at 2 bit/s; long: SDCC folds in 16 bits */
#define T_TO_MIN_MS   100u

static uint16_t quiet_ms;
static uint16_t t_to_ms;
static uint16_t seen_sd;
static uint16_t seen_errors;
static bool timed_out;

void fma_watch_t_sl(uint16_t t_sl)
{
    uint32_t half_rate = phy_bit_per_s(phy_read_value(PHY_BAUD_RATE)) / 2u; /* so that the product has 32 bits */
    uint32_t ms = half_rate ? T_TO_SLOTS_MS * t_sl / half_rate : 0;

    t_to_ms = ms < T_TO_MIN_MS ? T_TO_MIN_MS : ms > 60000u ? 60000u : (uint16_t)ms;
}

void fma_watch_reset(void)
{
    quiet_ms = 0;
    seen_sd = 0;
    seen_errors = 0;
    timed_out = false;
}

void fma_watch_cleared(const uint16_t XDATA *count)
{
    if (count == &fdl_counters.sd_count)
        seen_sd = 0;
    else
        seen_errors = 0;
}

/* One event when the bus falls silent, one a poll while only rubbish is heard. */
void fma_poll(uint16_t elapsed_ms)
{
    uint16_t sd = fma_count(&fdl_counters.sd_count);
    uint16_t errors = fma_count(&fdl_counters.sd_error_count);

    if (sd != seen_sd) {
        quiet_ms = 0;
        timed_out = false;
    } else if (quiet_ms < t_to_ms) {
        quiet_ms = (uint16_t)(quiet_ms + (elapsed_ms < 1000u ? elapsed_ms : 1000u));
    } else if (!timed_out) {
        timed_out = true;
        fma_event_ind(FMA_EVENT_TIME_OUT, 0);
    }
    if (sd == seen_sd && errors != seen_errors)
        fma_event_ind(FMA_EVENT_NOT_SYN, (uint8_t)errors);
    seen_sd = sd;
    seen_errors = errors;
}
