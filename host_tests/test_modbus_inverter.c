/* The inverter of spec B7 behind its Modbus server, in virtual time: ramps to the step, trips, refusals,
 * storing. */
#include "hal/hal.h"
#include "inverter.h"
#include "modbus/mb.h"
#include "sim/modbus_client.h"
#include "unity.h"

#include <string.h>

static struct mbc client;
static uint8_t body[MBC_FRAME_MAX], answer[MBC_FRAME_MAX];

static void loop(void)
{
    mb_poll();
    inv_poll();
}

static void power_on(void)
{
    memset(&mb_port, 0, sizeof mb_port);
    mb_port.bit_per_s = 19200;
    mb_port.format = HAL_8E1;
    mb_port.address = 1;
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
    inv_init();
    mbc_power_on(loop);
    mbc_idle(50);
}

void setUp(void)
{
    mbc_begin(&client);
    power_on();
}

void tearDown(void)
{
    mbc_end();
}

/* -> the exception, 0: done; the answer is in answer[] */
static uint8_t request(const uint8_t *pdu, unsigned n)
{
    body[0] = 1;
    memcpy(body + 1, pdu, n);
    mbc_send(&client, body, n + 1);
    TEST_ASSERT_GREATER_OR_EQUAL(3, mbc_wait(&client, answer));
    mbc_idle(40);
    return answer[1] & 0x80 ? answer[2] : 0;
}

static uint8_t write_register(uint8_t address, uint16_t value)
{
    const uint8_t pdu[] = {6, 0, address, (uint8_t)(value >> 8), (uint8_t)value};
    return request(pdu, sizeof pdu);
}

static uint8_t write_coil(uint8_t address, bool on)
{
    const uint8_t pdu[] = {5, 0, address, on ? 0xFF : 0, 0};
    return request(pdu, sizeof pdu);
}

static uint16_t read_register(uint8_t code, uint8_t address)
{
    const uint8_t pdu[] = {code, 0, address, 0, 1};
    TEST_ASSERT_EQUAL(0, request(pdu, sizeof pdu));
    return (uint16_t)(answer[3] << 8 | answer[4]);
}

static uint8_t status(void)
{
    const uint8_t pdu[] = {7};
    TEST_ASSERT_EQUAL(0, request(pdu, sizeof pdu));
    return answer[2];
}

static uint16_t frequency(void)
{
    return read_register(4, INV_V_OUTPUT_FREQ);
}

static void test_the_ramp_takes_the_time_it_was_given(void)
{
    write_register(INV_P_ACCEL_TIME, 20); /* 0 to 60 Hz in 2 s: 30 Hz after 1 s */
    write_register(INV_P_SET_POINT, 6000);
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(1000);
    TEST_ASSERT_UINT_WITHIN(120, 3000, frequency());
    mbc_idle_ms(1100);
    TEST_ASSERT_EQUAL(6000, frequency());
    TEST_ASSERT_EQUAL_HEX8(0x85, status()); /* running, at set point, ready */
    TEST_ASSERT_EQUAL(
        4000, read_register(4, INV_V_OUTPUT_VOLTAGE)); /* above BASE_FREQ the voltage is the rated one */
}

static void test_voltage_follows_frequency_up_to_the_base_frequency(void)
{
    write_register(INV_P_SET_POINT, 2500);
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(10000);
    TEST_ASSERT_EQUAL(2000, read_register(4, INV_V_OUTPUT_VOLTAGE)); /* 400 V * 25 / 50, in 0.1 V */
    TEST_ASSERT_EQUAL(510, read_register(4, INV_V_OUTPUT_CURRENT));  /* 60 % of 8.5 A, in 0.01 A */
}

static void test_limits_bind_the_set_point(void)
{
    TEST_ASSERT_EQUAL(0, write_register(INV_P_MIN_FREQ, 1000));
    TEST_ASSERT_EQUAL(0, write_register(INV_P_MAX_FREQ, 4000));
    write_register(INV_P_SET_POINT, 6000);
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(10000);
    TEST_ASSERT_EQUAL(4000, frequency());
    write_register(INV_P_SET_POINT, 0);
    mbc_idle_ms(10000);
    TEST_ASSERT_EQUAL(1000, frequency());
    TEST_ASSERT_EQUAL(3, write_register(INV_P_MIN_FREQ, 4001)); /* above MAX_FREQ */
    TEST_ASSERT_EQUAL(3, write_register(INV_P_SET_POINT, 40001));
    TEST_ASSERT_EQUAL(3, write_register(INV_P_ACCEL_TIME, 0));
}

static void test_reversing_goes_through_zero(void)
{
    bool zero = false;
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(6000);
    TEST_ASSERT_EQUAL(5000, frequency());
    write_coil(INV_COIL_REVERSE, true);
    TEST_ASSERT_EQUAL_HEX8(0, status() & 1u << INV_IN_BACKWARD);
    for (unsigned i = 0; i < 100 && !zero; i++) {
        mbc_idle_ms(50);
        zero = (inv_inputs & 1u << INV_IN_BACKWARD) != 0;
    }
    TEST_ASSERT_TRUE(zero);
    TEST_ASSERT_LESS_THAN(200, inv_values[INV_V_OUTPUT_FREQ]);
    mbc_idle_ms(6000);
    TEST_ASSERT_EQUAL(5000, frequency());
}

static void test_trips_stop_the_drive_until_they_are_reset(void)
{
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(6000);
    write_register(INV_P_LOAD, 220); /* above 200 %: overcurrent */
    mbc_idle_ms(100);
    TEST_ASSERT_EQUAL(0, frequency());
    TEST_ASSERT_EQUAL(INV_OVERCURRENT, read_register(4, INV_V_TRIP_CODE));
    TEST_ASSERT_EQUAL_HEX8(1u << INV_IN_TRIPPED, status());
    TEST_ASSERT_EQUAL(4, write_coil(INV_COIL_RUN, true));
    write_coil(INV_COIL_RESET, true);
    mbc_idle_ms(50);
    TEST_ASSERT_EQUAL(0, inv_coils);
    TEST_ASSERT_EQUAL(0, read_register(4, INV_V_TRIP_CODE));
    write_register(INV_P_LOAD, 60);
    TEST_ASSERT_EQUAL(0, write_coil(INV_COIL_RUN, true));
}

static void test_a_steep_ramp_down_under_load_trips_on_overvoltage(void)
{
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(6000);
    write_register(INV_P_DECEL_TIME, 4);
    write_coil(INV_COIL_RUN, false);
    mbc_idle_ms(100);
    TEST_ASSERT_EQUAL(INV_OVERVOLTAGE, read_register(4, INV_V_TRIP_CODE));
}

static void test_long_overload_trips_on_overtemperature(void)
{
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(6000);
    write_register(INV_P_LOAD, 190);
    mbc_idle_ms(200000);
    TEST_ASSERT_EQUAL(INV_OVERTEMPERATURE, read_register(4, INV_V_TRIP_CODE));
}

static void test_a_lost_client_trips_when_asked_to(void)
{
    write_register(INV_P_COMM_TIMEOUT, 10);
    write_coil(INV_COIL_RUN, true);
    for (unsigned i = 0; i < 30; i++) {
        mbc_idle_ms(900);
        TEST_ASSERT_EQUAL(0, read_register(4, INV_V_TRIP_CODE));
    }
    mbc_idle_ms(1100);
    TEST_ASSERT_EQUAL(INV_COMM_LOST, read_register(4, INV_V_TRIP_CODE));
}

static void test_what_defines_the_motor_is_busy_while_it_turns(void)
{
    TEST_ASSERT_EQUAL(0, write_register(INV_P_BASE_FREQ, 6000));
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(1000);
    TEST_ASSERT_EQUAL(6, write_register(INV_P_BASE_FREQ, 5000));
    TEST_ASSERT_EQUAL(0, write_register(INV_P_BASE_FREQ, 6000)); /* no change is no harm */
}

static void test_storing_is_acknowledged_then_busy_then_kept(void)
{
    static const uint8_t get_counter[] = {11};
    write_register(INV_P_SET_POINT, 4321);
    mbc_power_on(mb_poll); /* the application is slow: storing stands still */
    TEST_ASSERT_EQUAL(5, write_register(INV_P_STORE, 1));
    TEST_ASSERT_EQUAL(6, write_register(INV_P_SET_POINT, 1111));
    TEST_ASSERT_EQUAL_HEX8(0, hal_nv_read(0)); /* no mark while it is not whole */
    TEST_ASSERT_EQUAL(0, request(get_counter, 1));
    TEST_ASSERT_EQUAL_HEX8(0xFF, answer[2]);                    /* a program command is being processed */
    TEST_ASSERT_EQUAL(4321, read_register(3, INV_P_SET_POINT)); /* reading goes on */
    mbc_power_on(loop);
    mbc_idle_ms(10);
    TEST_ASSERT_EQUAL(0, write_register(INV_P_SET_POINT, 1111));
    power_on();
    TEST_ASSERT_EQUAL(4321, read_register(3, INV_P_SET_POINT));
    hal_nv_write(3, hal_nv_read(3) ^ 1); /* an octet has rotted: defaults */
    power_on();
    TEST_ASSERT_EQUAL(5000, read_register(3, INV_P_SET_POINT));
}

static void test_power_lost_while_storing_leaves_the_defaults(void)
{
    for (unsigned passes = 0; passes < 12; passes++) {
        mbc_power_on(mb_poll);
        write_register(INV_P_SET_POINT, 1234);
        TEST_ASSERT_EQUAL(5, write_register(INV_P_STORE, 1));
        for (unsigned i = 0; i < passes; i++)
            inv_poll();
        power_on();
        TEST_ASSERT_EQUAL(passes < 12 ? 5000 : 1234, read_register(3, INV_P_SET_POINT));
    }
}

static void test_counters_of_32_bits_are_two_registers_read_at_once(void)
{
    const uint8_t pdu[] = {4, 0, INV_V_RUN_SECONDS_HIGH, 0, 2};
    write_coil(INV_COIL_RUN, true);
    inv_values[INV_V_RUN_SECONDS_LOW] = 0xFFF0;
    for (unsigned i = 0; i < 400; i++) {
        mbc_idle_ms(100);
        TEST_ASSERT_EQUAL(0, request(pdu, sizeof pdu));
        const uint32_t seconds =
            (uint32_t)answer[3] << 24 | (uint32_t)answer[4] << 16 | (uint32_t)answer[5] << 8 | answer[6];
        TEST_ASSERT_UINT32_WITHIN(60, 0xFFF0ul + 25u, seconds); /* never 0 or 1FFFF */
    }
    TEST_ASSERT_EQUAL(1, read_register(4, INV_V_RUN_SECONDS_HIGH));
}

/* 60 Hz in 10 s are 0.60 Hz in 100 ms. */
static void test_the_trend_has_64_records_newest_first(void)
{
    static const uint8_t read[] = {20, 7, 6, 0, INV_FILE_TREND, 0, 0, 0, 64};
    unsigned i;
    write_register(INV_P_ACCEL_TIME, 100);
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(7000);
    TEST_ASSERT_EQUAL(0, request(read, sizeof read));
    TEST_ASSERT_EQUAL(1 + 2 * 64, answer[3]);
    TEST_ASSERT_UINT32_WITHIN(120, 4200, answer[5] << 8 | answer[6]);
    for (i = 0; i < 63; i++) {
        const uint8_t *const at = answer + 5 + 2 * i;
        TEST_ASSERT_EQUAL(60, (at[0] << 8 | at[1]) - (at[2] << 8 | at[3]));
    }
}

static void test_the_trend_is_a_file_and_cannot_be_written(void)
{
    const uint8_t read[] = {20, 7, 6, 0, INV_FILE_TREND, 0, 0, 0, 2};
    const uint8_t write[] = {21, 9, 6, 0, INV_FILE_TREND, 0, 0, 0, 1, 0, 0};
    const uint8_t note[] = {21, 9, 6, 0, INV_FILE_NOTE, 0, 0, 0, 1, 0xAB, 0xCD};
    write_coil(INV_COIL_RUN, true);
    mbc_idle_ms(20000);
    TEST_ASSERT_EQUAL(0, request(read, sizeof read));
    TEST_ASSERT_EQUAL_HEX8(5000 >> 8, answer[5]);
    TEST_ASSERT_EQUAL_HEX8(5000 & 0xFF, answer[6]);
    TEST_ASSERT_EQUAL(4, request(write, sizeof write));
    TEST_ASSERT_EQUAL(0, request(note, sizeof note));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_ramp_takes_the_time_it_was_given);
    RUN_TEST(test_voltage_follows_frequency_up_to_the_base_frequency);
    RUN_TEST(test_limits_bind_the_set_point);
    RUN_TEST(test_reversing_goes_through_zero);
    RUN_TEST(test_trips_stop_the_drive_until_they_are_reset);
    RUN_TEST(test_a_steep_ramp_down_under_load_trips_on_overvoltage);
    RUN_TEST(test_long_overload_trips_on_overtemperature);
    RUN_TEST(test_a_lost_client_trips_when_asked_to);
    RUN_TEST(test_what_defines_the_motor_is_busy_while_it_turns);
    RUN_TEST(test_storing_is_acknowledged_then_busy_then_kept);
    RUN_TEST(test_power_lost_while_storing_leaves_the_defaults);
    RUN_TEST(test_counters_of_32_bits_are_two_registers_read_at_once);
    RUN_TEST(test_the_trend_is_a_file_and_cannot_be_written);
    RUN_TEST(test_the_trend_has_64_records_newest_first);
    return UNITY_END();
}
