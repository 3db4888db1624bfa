/* Watchdog and baud search: three states over one clock.
 *
 *   BAUD_SEARCH   no rate yet: each rate the board can do, highest first, until an error-free telegram is heard
 *   BAUD_CONTROL  rate found (or fixed): nothing for us for 2 * WD_Baud_Control_Val * 10 ms -> search again
 *   DP_CONTROL    Set_Prm with WD_On: nothing from the owner for T_WD -> station to WAIT_PRM, outputs fail-safe
 *
 * The clock is restarted when the main loop sees that a telegram was heard, and the first millisecond it counts may be
 * almost over: so T_WD must have been passed, not reached. An expiry is never early, and late by at most 1 ms and
 * a turn of the main loop.
 * Source   EN 50170-2 part 8, watchdog; facts 3.13
 */
#include "ddlm/ddlm_priv.h"
#include "phy_uart/phy_uart.h"

static const CODE uint8_t search_order[] = {
    PHY_BAUD_12M,   PHY_BAUD_6M,    PHY_BAUD_3M,    PHY_BAUD_1M5,  PHY_BAUD_500K,
    PHY_BAUD_187K5, PHY_BAUD_93K75, PHY_BAUD_45K45, PHY_BAUD_19K2, PHY_BAUD_9K6,
};

/* Time at one rate [ms]: two of the longest telegrams with their T_SYN and T_SDR, about 8000 T_bit, and at least
 * 100 ms for a master that polls slowly (our choice). */
#define SEARCH_TBIT_MS 8000000ul
#define SEARCH_MIN_MS  100u

#define BAUD_CONTROL_MS (2ul * 10u * DDLM_WD_BAUD_CONTROL_VAL)

static uint8_t state;
static bool fixed;         /* the rate was given: no search */
static uint8_t at;         /* in search_order               */
static uint32_t quiet_ms;  /* since the clock was restarted */
static uint32_t t_wd_ms;   /* 0 = off                       */
static uint32_t t_search_ms;

static bool try_rate(uint8_t baud)
{
    if (fma_set_value(FMA_BAUD_RATE, baud) != FMA_OK)
        return false;
    t_search_ms = SEARCH_TBIT_MS / phy_bit_per_s(baud);
    if (t_search_ms < SEARCH_MIN_MS)
        t_search_ms = SEARCH_MIN_MS;
    return true;
}

/* The next rate this board can do; one round at most, so a board that can do none does not hang here. */
static void next_rate(void)
{
    uint8_t tries = sizeof search_order;

    do {
        at = at + 1u < sizeof search_order ? (uint8_t)(at + 1u) : 0u;
    } while (!try_rate(search_order[at]) && --tries);
}

static void enter(uint8_t to)
{
    state = to;
    quiet_ms = 0;
    fdl_listen(to == DDLM_BAUD_SEARCH);
}

static void start_search(void)
{
    enter(DDLM_BAUD_SEARCH);
    at = sizeof search_order - 1u;
    next_rate();
}

void ddlm_wd_init(uint8_t baud)
{
    t_wd_ms = 0;
    fixed = baud != DDLM_BAUD_AUTO;
    if (!fixed) {
        start_search();
        return;
    }
    try_rate(baud);
    enter(DDLM_BAUD_CONTROL);
}

void ddlm_wd_set(uint8_t fact_1, uint8_t fact_2)
{
    t_wd_ms = (uint32_t)fact_1 * fact_2 * 10u;
    enter(DDLM_DP_CONTROL);
}

void ddlm_wd_off(void)
{
    t_wd_ms = 0;
    if (state == DDLM_DP_CONTROL)
        enter(DDLM_BAUD_CONTROL);
}

/* Which telegrams restart the clock of a state. */
static uint8_t restarts(void)
{
    switch (state) {
    case DDLM_BAUD_SEARCH:
        return FDL_HEARD_ANY;
    case DDLM_BAUD_CONTROL:
        return FDL_HEARD_OWN;
    default:
        return FDL_HEARD_OWNER;
    }
}

static void st_baud_search(bool heard)
{
    if (heard)
        enter(DDLM_BAUD_CONTROL);
    else if (quiet_ms >= t_search_ms) {
        quiet_ms = 0;
        next_rate();
    }
}

/* The slave's state is not touched: it may still be exchanging data as far as it knows. */
static void st_baud_control(void)
{
    if (!fixed && quiet_ms >= BAUD_CONTROL_MS)
        start_search();
}

static void st_dp_control(void)
{
    if (quiet_ms <= t_wd_ms)
        return;
    ddlm_counters.wd_expired++;
    ddlm_leave_master();
}

void ddlm_wd_poll(uint16_t elapsed_ms, uint8_t heard)
{
    bool restart = (heard & restarts()) != 0;

    quiet_ms = restart ? 0 : quiet_ms + elapsed_ms;
    switch (state) {
    case DDLM_BAUD_SEARCH:
        st_baud_search(restart);
        break;
    case DDLM_BAUD_CONTROL:
        st_baud_control();
        break;
    default:
        st_dp_control();
        break;
    }
}

bool ddlm_wd_on(void)
{
    return state == DDLM_DP_CONTROL;
}

uint8_t ddlm_wd_state(void)
{
    return state;
}

uint32_t ddlm_wd_ms(void)
{
    return t_wd_ms;
}
