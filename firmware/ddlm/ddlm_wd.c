/* Watchdog and baud search: three states over one clock.
 *
 *   BAUD_SEARCH   no rate yet: each rate the board can do, highest first, until an error-free telegram is heard
 *   BAUD_CONTROL  rate found (or fixed): nothing for us for 2 * WD_Baud_Control_Val * 10 ms -> search again
 *   DP_CONTROL    Set_Prm with WD_On: nothing from the owner for T_WD -> station to WAIT_PRM, outputs fail-safe
 *
 * The clock is restarted when the main loop sees that a telegram was heard, and the first millisecond it counts
 * may be almost over: so T_WD must have been passed, not reached. An expiry is never early, and late by at most 1
 * ms and a turn of the main loop.
 * Source   EN 50170-2 part 8, watchdog; facts 3.13
 */
#include "ddlm/ddlm_priv.h"
#include "phy_uart/phy_uart.h"

/* Time at one rate [ms]: two of the longest telegrams with their T_SYN and T_SDR, about 8000 T_bit, and at least
 * 100 ms for a master that polls slowly (our choice). */
#define SEARCH_MS(bit_per_s) ((bit_per_s) < 80000ul ? 8000000ul / (bit_per_s) : 100u)

static const CODE struct {
    uint8_t baud;
    uint16_t ms;
} search[] = {
    {PHY_BAUD_12M, SEARCH_MS(12000000ul)},  {PHY_BAUD_6M, SEARCH_MS(6000000ul)},
    {PHY_BAUD_3M, SEARCH_MS(3000000ul)},    {PHY_BAUD_1M5, SEARCH_MS(1500000ul)},
    {PHY_BAUD_500K, SEARCH_MS(500000ul)},   {PHY_BAUD_187K5, SEARCH_MS(187500ul)},
    {PHY_BAUD_93K75, SEARCH_MS(93750ul)},   {PHY_BAUD_45K45, SEARCH_MS(45450ul)},
    {PHY_BAUD_19K2, SEARCH_MS(19200ul)},    {PHY_BAUD_9K6, SEARCH_MS(9600ul)},
};
#define RATES (sizeof search / sizeof search[0])

#define BAUD_CONTROL_MS (2ul * 10u * DDLM_WD_BAUD_CONTROL_VAL)

static uint8_t state;
static bool fixed;         /* the rate was given: no search */
static uint8_t at;         /* in search[]                   */
static uint32_t quiet_ms;  /* since the clock was restarted */
static uint32_t t_wd_ms;   /* 0 = off                       */

/* The next rate this board can do; one round at most, so a board that can do none does not hang here. */
static void next_rate(void)
{
    uint8_t tries = RATES;

    do {
        at = at + 1u < RATES ? (uint8_t)(at + 1u) : 0u;
    } while (fma_set_value(FMA_BAUD_RATE, search[at].baud) != FMA_OK && --tries);
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
    at = RATES - 1u;
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
    fma_set_value(FMA_BAUD_RATE, baud);
    enter(DDLM_BAUD_CONTROL);
}

void ddlm_wd_set(uint8_t fact_1, uint8_t fact_2)
{
    t_wd_ms = 0;
    for (; fact_2; fact_2--)
        t_wd_ms += (uint16_t)(fact_1 * 10u); /* a product of 32 bits costs an 8-bit part 100 octets of code */
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
    else if (quiet_ms >= search[at].ms) {
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
