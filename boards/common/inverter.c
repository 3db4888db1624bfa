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
uint16_t XDATA inv_note[INV_NOTE_RECORDS];

#ifndef INV_STEP_MS /* 10, 20, 50 or 100 */
#define INV_STEP_MS 10
#endif
#ifndef INV_PARTS_A_PASS /* of a step; so many that time which was lost is caught up with at once */
#define INV_PARTS_A_PASS 2750u
#endif
#define STEP_MS      ((unsigned)INV_STEP_MS)
#define AMBIENT      250u /* 0.1 degC */
#define TRIP_HEAT    950u
#define TRIP_CURRENT 200u /* % of RATED_CURRENT */

static uint16_t XDATA last_tick;
static uint16_t XDATA ramp_rest; /* of the division in ramp()                     */
static uint16_t XDATA percent;   /* of RATED_CURRENT                              */
static uint32_t XDATA heat;      /* TEMPERATURE * 256                             */
static uint32_t XDATA work;      /* energy below 0.1 Wh, in W ms                  */
static uint16_t XDATA run_ms, unasked_ms, trend_ms;
static uint16_t XDATA asked_before;
static bool XDATA backward;
static int8_t XDATA moving; /* +1, -1, 0: how the frequency moves */
static uint8_t XDATA next;  /* part of the step; PARTS: it is done */

static uint16_t XDATA trend[INV_TREND_KEPT]; /* a ring, newer ones below older ones */
static uint8_t XDATA trend_at;               /* the newest */

#define COIL(name)  ((uint8_t)(1u << INV_COIL_##name))
#define INPUT(name) ((uint8_t)(1u << INV_IN_##name))

static bool reverse(void)
{
    return (inv_coils & COIL(REVERSE)) != 0;
}

void inv_trip(uint8_t code)
{
    uint8_t i;
    inv_coils &= (uint8_t)~COIL(RUN);
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
    if (!(inv_coils & COIL(RUN)) || backward != reverse())
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

/* -> moving */
static int8_t move(void)
{
    const uint16_t target = wanted();
    uint16_t XDATA *const f = &inv_values[INV_V_OUTPUT_FREQ];
    uint16_t step;
    if (*f == target) {
        if (target == 0 && (inv_coils & COIL(RUN)))
            backward = reverse();
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

static void move_frequency(void)
{
    moving = inv_values[INV_V_TRIP_CODE] ? 0 : move();
}

static uint16_t full_voltage(void)
{
    return (uint16_t)(10u * inv_params[INV_P_RATED_VOLTAGE]);
}

/* Follows the frequency up to BASE_FREQ. */
static void set_voltage(void)
{
    const uint16_t f = inv_values[INV_V_OUTPUT_FREQ];
    uint16_t volt = f ? full_voltage() : 0;
    if (f && f < inv_params[INV_P_BASE_FREQ])
        volt = (uint16_t)((uint32_t)volt * f / inv_params[INV_P_BASE_FREQ]);
    inv_values[INV_V_OUTPUT_VOLTAGE] = volt;
}

/* Magnetising 30 % or load, and half as much again while accelerating. */
static void set_current(void)
{
    percent = 0;
    if (inv_values[INV_V_OUTPUT_FREQ])
        percent = inv_params[INV_P_LOAD] > 30u ? inv_params[INV_P_LOAD] : 30u;
    if (moving > 0)
        percent = (uint16_t)(percent + percent / 2u);
    inv_values[INV_V_OUTPUT_CURRENT] = (uint16_t)((uint32_t)percent * inv_params[INV_P_RATED_CURRENT] / 100u);
    if (percent > TRIP_CURRENT)
        inv_trip(INV_OVERCURRENT);
}

/* A fast ramp down feeds it; it trips at twice RATED_VOLTAGE. */
static void set_dc_bus(void)
{
    const uint16_t full = full_voltage();
    uint16_t bus = (uint16_t)((uint32_t)full * 1448u >> 10);       /* 1.414 */
    bus = (uint16_t)(bus - ((uint32_t)bus * percent * 13u >> 16)); /* 2 % down at 100 % */
    if (moving < 0)
        bus = (uint16_t)(bus + 200u * inv_params[INV_P_LOAD] / inv_params[INV_P_DECEL_TIME]); /* below 9760 + 50000 */
    inv_values[INV_V_DC_BUS] = bus;
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
static void count(uint8_t register_high, uint16_t more)
{
    const uint16_t low = (uint16_t)(inv_values[register_high + 1u] + more);
    inv_values[register_high + 1u] = low;
    if (low < more)
        inv_values[register_high]++;
}

/* Power = 1.73 U I, of 0.1 V and 0.01 A (1.73 / 1000 is 1814 / 2^20). */
static void add_work(void)
{
    const uint32_t watts =
        ((uint32_t)inv_values[INV_V_OUTPUT_VOLTAGE] * inv_values[INV_V_OUTPUT_CURRENT] >> 10) * 1814u >> 10;
    work += watts * STEP_MS;
}

/* 0.1 Wh are 360 000 W ms. */
static void count_energy(void)
{
    uint16_t done; /* some 200 at most */
    if (work < 360000u)
        return;
    done = (uint16_t)(work / 360000u);
    work -= done * (uint32_t)360000u;
    count(INV_V_ENERGY_HIGH, done);
}

static void count_seconds(void)
{
    if (inv_values[INV_V_OUTPUT_FREQ] && (run_ms = (uint16_t)(run_ms + STEP_MS)) >= 1000u) {
        run_ms = 0;
        count(INV_V_RUN_SECONDS_HIGH, 1);
    }
}

static void record_trend(void)
{
    trend_ms = (uint16_t)(trend_ms + STEP_MS);
    if (trend_ms < 100u)
        return;
    trend_ms = 0;
    trend_at = (uint8_t)(trend_at ? trend_at - 1u : INV_TREND_KEPT - 1u);
    trend[trend_at] = inv_values[INV_V_OUTPUT_FREQ];
}

uint16_t inv_trend(uint8_t i)
{
    i = (uint8_t)(trend_at + i);
    return trend[i < INV_TREND_KEPT ? i : i - INV_TREND_KEPT];
}

static void watch_client(void)
{
    const uint16_t asked = mb_diag.counter[MB_SLAVE_MESSAGE];
    unasked_ms = (uint16_t)(asked == asked_before && unasked_ms < 65000u ? unasked_ms + STEP_MS : 0u);
    asked_before = asked;
    if ((inv_coils & COIL(RUN)) && inv_params[INV_P_COMM_TIMEOUT] &&
        unasked_ms >= 100u * inv_params[INV_P_COMM_TIMEOUT])
        inv_trip(INV_COMM_LOST);
}

static void obey_coils(void)
{
    if ((inv_coils & (COIL(RESET) | COIL(RUN))) == COIL(RESET))
        inv_values[INV_V_TRIP_CODE] = INV_NO_TRIP;
    if (inv_coils & COIL(EXTERNAL_TRIP))
        inv_trip(INV_EXTERNAL);
    if (inv_coils & COIL(COAST)) {
        inv_coils &= (uint8_t)~COIL(RUN);
        inv_values[INV_V_OUTPUT_FREQ] = 0;
    }
    inv_coils &= (uint8_t) ~(COIL(RESET) | COIL(EXTERNAL_TRIP));
}

static void set_inputs(void)
{
    uint8_t on = inv_values[INV_V_TRIP_CODE] != INV_NO_TRIP ? INPUT(TRIPPED) : INPUT(READY);
    if (inv_values[INV_V_OUTPUT_FREQ])
        on |= INPUT(RUNNING);
    if (backward)
        on |= INPUT(BACKWARD);
    if ((inv_coils & COIL(RUN)) && inv_values[INV_V_OUTPUT_FREQ] == wanted())
        on |= INPUT(AT_SET_POINT);
    if (moving > 0)
        on |= INPUT(ACCELERATING);
    if (moving < 0)
        on |= INPUT(DECELERATING);
    if (percent > 100u)
        on |= INPUT(OVERLOADED);
    inv_inputs = on;
}

/* A step, in parts: the whole of it takes an 8051 8000 machine cycles, for which a request would wait. There a pass
 * of the main loop does one part, and a client may see values of two steps side by side. */
static void (*const CODE parts[])(void) = {
    watch_client, move_frequency, set_voltage,   set_current,  set_dc_bus, warm,
    add_work,     count_energy,   count_seconds, record_trend, set_inputs,
};
#define PARTS (sizeof parts / sizeof parts[0])

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
    for (next = 0; next < PARTS; next++)
        parts[next]();
}

void inv_poll(void)
{
    const uint16_t now = hal_ticks();
    uint16_t most = INV_PARTS_A_PASS;
    inv_store_poll();
    obey_coils();
    do {
        if (next == PARTS) {
            if ((uint16_t)(now - last_tick) < STEP_MS)
                return;
            last_tick = (uint16_t)(last_tick + STEP_MS);
            next = 0;
        }
        parts[next++]();
    } while (--most);
}
