/* The drive model: ramps, V/f characteristic, current, DC bus, heat; trips; storing of parameters. Whole
 * numbers only. None of it is a motor's data sheet: our choice, simple and plausible. */
#include "inverter_model.h"

#include "hal/hal.h"
#include "modbus/mb.h"

uint8_t XDATA inv_coils;
uint8_t XDATA inv_inputs;
uint16_t XDATA inv_params[INV_P_COUNT];
uint16_t XDATA inv_values[INV_V_COUNT];
uint16_t XDATA inv_trips[1 + INV_TRIPS_KEPT];
uint16_t XDATA inv_trend[INV_TREND_KEPT];
uint16_t XDATA inv_note[INV_NOTE_RECORDS];

#ifndef INV_STEP_MS /* 10, 20, 50 or 100 */
#define INV_STEP_MS 10
#endif
#define STEP_MS      ((unsigned)INV_STEP_MS)
#define AMBIENT      250u /* 0.1 degC */
#define TRIP_HEAT    950u
#define TRIP_CURRENT 200u /* % of RATED_CURRENT */

static uint16_t XDATA last_tick;
static uint16_t XDATA ramp_rest; /* of the division in ramp()                     */
static uint16_t XDATA percent;   /* of RATED_CURRENT                              */
static uint32_t XDATA heat;      /* TEMPERATURE * 256                             */
static uint32_t XDATA work;      /* energy below 0.1 Wh, in W * STEP_MS           */
static uint16_t XDATA run_ms, unasked_ms, trend_ms;
static uint16_t XDATA asked_before;
static bool XDATA backward;

static bool coil(uint8_t i)
{
    return (inv_coils >> i & 1u) != 0;
}

static void clear_coil(uint8_t i)
{
    inv_coils &= (uint8_t) ~(1u << i);
}

static void set_input(uint8_t i, bool on)
{
    inv_inputs = (uint8_t)(on ? inv_inputs | 1u << i : inv_inputs & ~(1u << i));
}

void inv_trip(uint8_t code)
{
    uint8_t i;
    clear_coil(INV_COIL_RUN);
    inv_values[INV_V_OUTPUT_FREQ] = 0;
    if (inv_values[INV_V_TRIP_CODE] != INV_NO_TRIP)
        return;
    inv_values[INV_V_TRIP_CODE] = code;
    for (i = INV_TRIPS_KEPT; i > 1; i--)
        inv_trips[i] = inv_trips[i - 1u];
    inv_trips[1] = code;
    if (inv_trips[0] < INV_TRIPS_KEPT)
        inv_trips[0]++;
}

static uint16_t wanted(void)
{
    uint16_t f = inv_params[INV_P_SET_POINT];
    if (!coil(INV_COIL_RUN) || backward != coil(INV_COIL_REVERSE))
        return 0;
    if (f < inv_params[INV_P_MIN_FREQ])
        f = inv_params[INV_P_MIN_FREQ];
    return f > inv_params[INV_P_MAX_FREQ] ? inv_params[INV_P_MAX_FREQ] : f;
}

/* MAX_FREQ in `time` tenths of a second: so much in one step; what the division leaves over is kept. */
static uint16_t ramp(uint16_t time)
{
    const uint32_t sum = (uint32_t)inv_params[INV_P_MAX_FREQ] + ramp_rest;
    const uint16_t steps = (uint16_t)(time * (100u / STEP_MS));
    const uint16_t step = (uint16_t)(sum / steps);
    ramp_rest = (uint16_t)(sum - (uint32_t)step * steps);
    return step;
}

/* -> +1, -1, 0: how the frequency moves */
static int8_t move_frequency(void)
{
    const uint16_t target = wanted();
    uint16_t XDATA *const f = &inv_values[INV_V_OUTPUT_FREQ];
    uint16_t step;
    if (*f == target) {
        if (target == 0 && coil(INV_COIL_RUN))
            backward = coil(INV_COIL_REVERSE);
        ramp_rest = 0;
        return 0;
    }
    if (*f < target) {
        step = ramp(inv_params[INV_P_ACCEL_TIME]);
        *f = (uint16_t)(target - *f > step ? *f + step : target);
        return 1;
    }
    step = ramp(inv_params[INV_P_DECEL_TIME]);
    *f = (uint16_t)(*f - target > step ? *f - step : target);
    return -1;
}

/* Voltage follows frequency up to BASE_FREQ; the current is magnetising 30 % or load, and half as much again
 * while accelerating; a fast ramp down feeds the DC bus, which trips at twice RATED_VOLTAGE. */
static void electrics(int8_t moving)
{
    const uint16_t f = inv_values[INV_V_OUTPUT_FREQ];
    const uint16_t full = (uint16_t)(10u * inv_params[INV_P_RATED_VOLTAGE]);
    uint16_t volt = f ? full : 0;
    uint16_t bus = (uint16_t)((uint32_t)full * 1448u >> 10); /* 1.414 */
    percent = 0;
    if (f) {
        percent = inv_params[INV_P_LOAD] > 30u ? inv_params[INV_P_LOAD] : 30u;
        if (f < inv_params[INV_P_BASE_FREQ])
            volt = (uint16_t)((uint32_t)full * f / inv_params[INV_P_BASE_FREQ]);
    }
    if (moving > 0)
        percent = (uint16_t)(percent + percent / 2u);
    inv_values[INV_V_OUTPUT_VOLTAGE] = volt;
    inv_values[INV_V_OUTPUT_CURRENT] = (uint16_t)((uint32_t)percent * inv_params[INV_P_RATED_CURRENT] / 100u);
    bus = (uint16_t)(bus - ((uint32_t)bus * percent * 13u >> 16)); /* 2 % down at 100 % */
    if (moving < 0)
        bus = (uint16_t)(bus + 200u * inv_params[INV_P_LOAD] / inv_params[INV_P_DECEL_TIME]); /* below 9760 + 50000 */
    inv_values[INV_V_DC_BUS] = bus;
    set_input(INV_IN_OVERLOADED, percent > 100u);
    if (percent > TRIP_CURRENT)
        inv_trip(INV_OVERCURRENT);
    if (bus > 2u * full)
        inv_trip(INV_OVERVOLTAGE);
}

/* First order towards ambient + 0.4 K per % of current squared over 100 (4 * 256 / 100 is 41 / 4); time constant
 * 164 s. */
static void warm(void)
{
    const uint32_t end = AMBIENT * (uint32_t)256 + ((uint32_t)percent * percent * 41u >> 2);
    if (heat < end)
        heat += ((end - heat) >> 14) * (STEP_MS / 10u) + 1u;
    else if (heat > end)
        heat -= ((heat - end) >> 14) * (STEP_MS / 10u) + 1u;
    inv_values[INV_V_TEMPERATURE] = (uint16_t)(heat / 256u);
    if (inv_values[INV_V_TEMPERATURE] > TRIP_HEAT)
        inv_trip(INV_OVERTEMPERATURE);
}

/* Two registers, high half first. */
static void count(uint8_t register_high)
{
    if (++inv_values[register_high + 1u] == 0)
        inv_values[register_high]++;
}

/* Power = 1.73 U I, of 0.1 V and 0.01 A (1.73 / 1000 is 1814 / 2^20); 0.1 Wh are 360 000 W ms. */
static void account(void)
{
    const uint32_t watts =
        ((uint32_t)inv_values[INV_V_OUTPUT_VOLTAGE] * inv_values[INV_V_OUTPUT_CURRENT] >> 10) * 1814u >> 10;
    for (work += watts * STEP_MS; work >= 360000u; work -= 360000u) /* 20 times at most */
        count(INV_V_ENERGY_HIGH);
    if (inv_values[INV_V_OUTPUT_FREQ] && (run_ms = (uint16_t)(run_ms + STEP_MS)) >= 1000u) {
        run_ms = 0;
        count(INV_V_RUN_SECONDS_HIGH);
    }
}

static void record_trend(void)
{
    uint8_t i;
    trend_ms = (uint16_t)(trend_ms + STEP_MS);
    if (trend_ms < 100u)
        return;
    trend_ms = 0;
    for (i = INV_TREND_KEPT - 1u; i > 0; i--)
        inv_trend[i] = inv_trend[i - 1u];
    inv_trend[0] = inv_values[INV_V_OUTPUT_FREQ];
}

static void watch_client(void)
{
    const uint16_t asked = mb_diag.counter[MB_SLAVE_MESSAGE];
    unasked_ms = (uint16_t)(asked == asked_before && unasked_ms < 65000u ? unasked_ms + STEP_MS : 0u);
    asked_before = asked;
    if (coil(INV_COIL_RUN) && inv_params[INV_P_COMM_TIMEOUT] &&
        unasked_ms >= 100u * inv_params[INV_P_COMM_TIMEOUT])
        inv_trip(INV_COMM_LOST);
}

static void obey_coils(void)
{
    if (coil(INV_COIL_RESET) && !coil(INV_COIL_RUN))
        inv_values[INV_V_TRIP_CODE] = INV_NO_TRIP;
    if (coil(INV_COIL_EXTERNAL_TRIP))
        inv_trip(INV_EXTERNAL);
    if (coil(INV_COIL_COAST)) {
        clear_coil(INV_COIL_RUN);
        inv_values[INV_V_OUTPUT_FREQ] = 0;
    }
    clear_coil(INV_COIL_RESET);
    clear_coil(INV_COIL_EXTERNAL_TRIP);
}

static void step(void)
{
    int8_t moving;
    watch_client();
    moving = inv_values[INV_V_TRIP_CODE] ? 0 : move_frequency();
    electrics(moving);
    warm();
    account();
    record_trend();
    set_input(INV_IN_RUNNING, inv_values[INV_V_OUTPUT_FREQ] != 0);
    set_input(INV_IN_BACKWARD, backward);
    set_input(INV_IN_AT_SET_POINT, coil(INV_COIL_RUN) && inv_values[INV_V_OUTPUT_FREQ] == wanted());
    set_input(INV_IN_ACCELERATING, moving > 0);
    set_input(INV_IN_DECELERATING, moving < 0);
    set_input(INV_IN_TRIPPED, inv_values[INV_V_TRIP_CODE] != INV_NO_TRIP);
    set_input(INV_IN_READY, inv_values[INV_V_TRIP_CODE] == INV_NO_TRIP);
}

void inv_init(void)
{
#define DEFAULT(name, unit, min, max, value, saved, text) value,
    static const uint16_t CODE defaults[] = {INV_PARAMS(DEFAULT)};
    uint8_t i;
    for (i = 0; i < INV_P_COUNT; i++)
        inv_params[i] = defaults[i];
    for (i = 0; i < INV_V_COUNT; i++)
        inv_values[i] = 0;
    inv_trips[0] = 0;
    inv_coils = inv_inputs = 0;
    backward = false;
    heat = AMBIENT * (uint32_t)256;
    work = 0;
    inv_restore();
    last_tick = hal_ticks();
    step();
}

void inv_poll(void)
{
    const uint16_t now = hal_ticks();
    uint8_t most = 250;
    inv_store_poll();
    obey_coils();
    while ((uint16_t)(now - last_tick) >= STEP_MS && most--) {
        last_tick = (uint16_t)(last_tick + STEP_MS);
        step();
    }
}
