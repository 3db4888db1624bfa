/* The inverter's registers, described once: the code, the table in firmware/modbus/README.md (make
 * modbus-map) and the host station's display are made from these rows. Addresses count from 0 in the order of
 * the rows.
 *
 *   COIL(name, text)                                     bits, read and write
 *   INPUT(name, text)                                    bits, read only; the first 8: exception status
 *   PARAM(name, unit, min, max, default, saved, text)    holding registers; saved: kept by STORE
 *   VALUE(name, unit, text)                              input registers
 *
 * Units: the number is in the unit given, "0.01 Hz" means 5000 is 50 Hz.
 */
#ifndef INVERTER_MAP_H
#define INVERTER_MAP_H

#define INV_COILS(COIL)                                                                                      \
    COIL(RUN, "1 = ramp up and run, 0 = ramp down and stop; refused (04) while tripped")                     \
    COIL(REVERSE, "direction; while running the drive ramps down, turns and ramps up")                       \
    COIL(COAST, "1 = output off at once, the motor coasts; clears RUN")                                      \
    COIL(RESET, "write 1: clear the trip; reads as 0")                                                       \
    COIL(EXTERNAL_TRIP, "write 1: trip with code 5, as the emergency input does; reads as 0")

#define INV_INPUTS(INPUT)                                                                                    \
    INPUT(RUNNING, "output on")                                                                              \
    INPUT(BACKWARD, "the motor turns backward")                                                              \
    INPUT(AT_SET_POINT, "output frequency = set point")                                                      \
    INPUT(ACCELERATING, "ramping up")                                                                        \
    INPUT(DECELERATING, "ramping down")                                                                      \
    INPUT(OVERLOADED, "output current above 100 % of RATED_CURRENT")                                         \
    INPUT(TRIPPED, "see TRIP_CODE")                                                                          \
    INPUT(READY, "not tripped, DC bus charged")

#define INV_PARAMS(PARAM)                                                                                    \
    PARAM(SET_POINT, "0.01 Hz", 0, 40000, 5000, 1, "wanted output frequency; limited to MIN_FREQ..MAX_FREQ") \
    PARAM(MIN_FREQ, "0.01 Hz", 0, 40000, 0, 1, "not above MAX_FREQ")                                         \
    PARAM(MAX_FREQ, "0.01 Hz", 100, 40000, 6000, 1, "not below MIN_FREQ")                                    \
    PARAM(ACCEL_TIME, "0.1 s", 1, 6000, 50, 1, "from 0 to MAX_FREQ")                                         \
    PARAM(DECEL_TIME, "0.1 s", 1, 6000, 50, 1, "from MAX_FREQ to 0; below 10 with load: overvoltage trip")   \
    PARAM(BASE_FREQ, "0.01 Hz", 1000, 40000, 5000, 0, "frequency of RATED_VOLTAGE; busy (06) while running") \
    PARAM(RATED_VOLTAGE, "V", 50, 690, 400, 0, "busy (06) while running")                                    \
    PARAM(RATED_CURRENT, "0.01 A", 10, 60000, 850, 0, "busy (06) while running")                             \
    PARAM(LOAD, "%", 0, 250, 60, 0, "simulated load torque")                                                 \
    PARAM(COMM_TIMEOUT, "0.1 s", 0, 600, 0, 0,                                                               \
          "trip with code 4 when running and not asked for so long; 0 = never")                              \
    PARAM(STORE, "", 0, 1, 0, 0,                                                                             \
          "write 1: keep set point, limits and ramps; answered acknowledge (05), then busy")

#define INV_VALUES(VALUE)                                                                                    \
    VALUE(OUTPUT_FREQ, "0.01 Hz", "output frequency")                                                        \
    VALUE(OUTPUT_VOLTAGE, "0.1 V", "output voltage")                                                         \
    VALUE(OUTPUT_CURRENT, "0.01 A", "output current")                                                        \
    VALUE(DC_BUS, "0.1 V", "DC bus voltage")                                                                 \
    VALUE(TEMPERATURE, "0.1 degC", "heat sink")                                                              \
    VALUE(TRIP_CODE, "",                                                                                     \
          "0 none, 1 overcurrent, 2 overtemperature, 3 overvoltage, 4 communication lost, 5 external")       \
    VALUE(ENERGY_HIGH, "0.1 Wh", "32-bit energy counter, high half: read both in one request")               \
    VALUE(ENERGY_LOW, "0.1 Wh", "32-bit energy counter, low half")                                           \
    VALUE(RUN_SECONDS_HIGH, "s", "32-bit running time, high half")                                           \
    VALUE(RUN_SECONDS_LOW, "s", "32-bit running time, low half")

#define INV_NAME_COIL(name, text)                              INV_COIL_##name,
#define INV_NAME_INPUT(name, text)                             INV_IN_##name,
#define INV_NAME_PARAM(name, unit, min, max, deflt, keep, txt) INV_P_##name,
#define INV_NAME_VALUE(name, unit, text)                       INV_V_##name,

enum { INV_COILS(INV_NAME_COIL) INV_COIL_COUNT };
enum { INV_INPUTS(INV_NAME_INPUT) INV_IN_COUNT };
enum { INV_PARAMS(INV_NAME_PARAM) INV_P_COUNT };
enum { INV_VALUES(INV_NAME_VALUE) INV_V_COUNT };

/* Function 24: the last trips, newest first. Function 20: output frequency every 100 ms, newest first (file
 * 1); a note of the owner's, read and write (file 2). */
#define INV_TRIP_FIFO    0x0100u
#define INV_TRIPS_KEPT   8u
#define INV_FILE_TREND   1u
#ifndef INV_TREND_KEPT /* a part with little RAM keeps fewer */
#define INV_TREND_KEPT   64u
#endif
#define INV_FILE_NOTE    2u
#define INV_NOTE_RECORDS 16u

enum inv_trip {
    INV_NO_TRIP,
    INV_OVERCURRENT,
    INV_OVERTEMPERATURE,
    INV_OVERVOLTAGE,
    INV_COMM_LOST,
    INV_EXTERNAL,
};

#endif
