/* The inverter of spec B7 behind its Modbus server, in virtual time: ramps to the step, trips, refusals,
 * storing. */
#include "inverter.h"
#include "modbus/mb.h"
#include "sim/modbus_client.h"
#include "unity.h"

#include <string.h>

#define SECOND ((hv_time)HV_S) /* the product must not be one of 32 bits */

static struct mbc client;

static void loop(void)
{
    mb_poll();
    inv_poll();
}

static void power_on(void)
{
    hal_init();
    memset(&mb_port, 0, sizeof mb_port);
    mb_port.bit_per_s = 19200;
    mb_port.format = HAL_8E1;
    mb_port.address = 1;
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
    inv_init();
    hv_set_loop(loop, NULL);
    hal_irq_restore(HAL_IRQ_ON);
    mbc_idle(50);
}

void setUp(void)
{
    hv_begin();
    mbc_begin(&client);
    power_on();
}

void tearDown(void)
{
}

/* -> the exception, 0: done */
static uint8_t request(const uint8_t *pdu, unsigned n, uint8_t *answer)
{
    uint8_t body[MBC_FRAME_MAX] = {1};
    memcpy(body + 1, pdu, n);
    mbc_send(&client, body, n + 1);
    TEST_ASSERT_GREATER_OR_EQUAL(3, mbc_wait(&client, answer));
    mbc_idle(40);
    return answer[1] & 0x80 ? answer[2] : 0;
}

static uint8_t write_register(uint8_t address, uint16_t value)
{
    const uint8_t pdu[] = {6, 0, address, (uint8_t)(value >> 8), (uint8_t)value};
    uint8_t answer[MBC_FRAME_MAX];
    return request(pdu, sizeof pdu, answer);
}

static uint8_t write_coil(uint8_t address, bool on)
{
    const uint8_t pdu[] = {5, 0, address, on ? 0xFF : 0, 0};
    uint8_t answer[MBC_FRAME_MAX];
    return request(pdu, sizeof pdu, answer);
}

static uint16_t read_register(uint8_t code, uint8_t address)
{
    const uint8_t pdu[] = {code, 0, address, 0, 1};
    uint8_t answer[MBC_FRAME_MAX];
    TEST_ASSERT_EQUAL(0, request(pdu, sizeof pdu, answer));
    return (uint16_t)(answer[3] << 8 | answer[4]);
}

static uint8_t status(void)
{
    const uint8_t pdu[] = {7};
    uint8_t answer[MBC_FRAME_MAX];
    TEST_ASSERT_EQUAL(0, request(pdu, sizeof pdu, answer));
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
    hv_run_for(HV_S);
    TEST_ASSERT_UINT_WITHIN(120, 3000, frequency());
    hv_run_for(1100 * HV_MS);
    TEST_ASSERT_EQUAL(6000, frequency());
    TEST_ASSERT_EQUAL_HEX8(0x85, status()); /* running, at set point, ready */
    TEST_ASSERT_EQUAL(
        4000, read_register(4, INV_V_OUTPUT_VOLTAGE)); /* above BASE_FREQ the voltage is the rated one */
}

static void test_voltage_follows_frequency_up_to_the_base_frequency(void)
{
    write_register(INV_P_SET_POINT, 2500);
    write_coil(INV_COIL_RUN, true);
    hv_run_for(10 * SECOND);
    TEST_ASSERT_EQUAL(2000, read_register(4, INV_V_OUTPUT_VOLTAGE)); /* 400 V * 25 / 50, in 0.1 V */
    TEST_ASSERT_EQUAL(510, read_register(4, INV_V_OUTPUT_CURRENT));  /* 60 % of 8.5 A, in 0.01 A */
}

static void test_limits_bind_the_set_point(void)
{
    TEST_ASSERT_EQUAL(0, write_register(INV_P_MIN_FREQ, 1000));
    TEST_ASSERT_EQUAL(0, write_register(INV_P_MAX_FREQ, 4000));
    write_register(INV_P_SET_POINT, 6000);
    write_coil(INV_COIL_RUN, true);
    hv_run_for(10 * SECOND);
    TEST_ASSERT_EQUAL(4000, frequency());
    write_register(INV_P_SET_POINT, 0);
    hv_run_for(10 * SECOND);
    TEST_ASSERT_EQUAL(1000, frequency());
    TEST_ASSERT_EQUAL(3, write_register(INV_P_MIN_FREQ, 4001)); /* above MAX_FREQ */
    TEST_ASSERT_EQUAL(3, write_register(INV_P_SET_POINT, 40001));
    TEST_ASSERT_EQUAL(3, write_register(INV_P_ACCEL_TIME, 0));
}

static void test_reversing_goes_through_zero(void)
{
    bool zero = false;
    write_coil(INV_COIL_RUN, true);
    hv_run_for(6 * SECOND);
    TEST_ASSERT_EQUAL(5000, frequency());
    write_coil(INV_COIL_REVERSE, true);
    TEST_ASSERT_EQUAL_HEX8(0, status() & 1u << INV_IN_BACKWARD);
    for (unsigned i = 0; i < 100 && !zero; i++) {
        hv_run_for(50 * HV_MS);
        zero = (inv_inputs & 1u << INV_IN_BACKWARD) != 0;
    }
    TEST_ASSERT_TRUE(zero);
    TEST_ASSERT_LESS_THAN(200, inv_values[INV_V_OUTPUT_FREQ]);
    hv_run_for(6 * SECOND);
    TEST_ASSERT_EQUAL(5000, frequency());
}

static void test_trips_stop_the_drive_until_they_are_reset(void)
{
    write_coil(INV_COIL_RUN, true);
    hv_run_for(6 * SECOND);
    write_register(INV_P_LOAD, 220); /* above 200 %: overcurrent */
    hv_run_for(100 * HV_MS);
    TEST_ASSERT_EQUAL(0, frequency());
    TEST_ASSERT_EQUAL(INV_OVERCURRENT, read_register(4, INV_V_TRIP_CODE));
    TEST_ASSERT_EQUAL_HEX8(1u << INV_IN_TRIPPED, status());
    TEST_ASSERT_EQUAL(4, write_coil(INV_COIL_RUN, true));
    write_coil(INV_COIL_RESET, true);
    hv_run_for(50 * HV_MS);
    TEST_ASSERT_EQUAL(0, inv_coils);
    TEST_ASSERT_EQUAL(0, read_register(4, INV_V_TRIP_CODE));
    write_register(INV_P_LOAD, 60);
    TEST_ASSERT_EQUAL(0, write_coil(INV_COIL_RUN, true));
}

static void test_a_steep_ramp_down_under_load_trips_on_overvoltage(void)
{
    write_coil(INV_COIL_RUN, true);
    hv_run_for(6 * SECOND);
    write_register(INV_P_DECEL_TIME, 4);
    write_coil(INV_COIL_RUN, false);
    hv_run_for(100 * HV_MS);
    TEST_ASSERT_EQUAL(INV_OVERVOLTAGE, read_register(4, INV_V_TRIP_CODE));
}

static void test_long_overload_trips_on_overtemperature(void)
{
    write_coil(INV_COIL_RUN, true);
    hv_run_for(6 * SECOND);
    write_register(INV_P_LOAD, 190);
    hv_run_for(200 * SECOND);
    TEST_ASSERT_EQUAL(INV_OVERTEMPERATURE, read_register(4, INV_V_TRIP_CODE));
}

static void test_a_lost_client_trips_when_asked_to(void)
{
    write_register(INV_P_COMM_TIMEOUT, 10);
    write_coil(INV_COIL_RUN, true);
    for (unsigned i = 0; i < 30; i++) {
        hv_run_for(900 * HV_MS);
        TEST_ASSERT_EQUAL(0, read_register(4, INV_V_TRIP_CODE));
    }
    hv_run_for(1100 * HV_MS);
    TEST_ASSERT_EQUAL(INV_COMM_LOST, read_register(4, INV_V_TRIP_CODE));
}

static void test_what_defines_the_motor_is_busy_while_it_turns(void)
{
    TEST_ASSERT_EQUAL(0, write_register(INV_P_BASE_FREQ, 6000));
    write_coil(INV_COIL_RUN, true);
    hv_run_for(HV_S);
    TEST_ASSERT_EQUAL(6, write_register(INV_P_BASE_FREQ, 5000));
    TEST_ASSERT_EQUAL(0, write_register(INV_P_BASE_FREQ, 6000)); /* no change is no harm */
}

static void test_storing_is_acknowledged_then_busy_then_kept(void)
{
    write_register(INV_P_SET_POINT, 4321);
    hv_set_loop(mb_poll, NULL); /* the application is slow: storing stands still */
    TEST_ASSERT_EQUAL(5, write_register(INV_P_STORE, 1));
    TEST_ASSERT_EQUAL(6, write_register(INV_P_SET_POINT, 1111));
    TEST_ASSERT_EQUAL_HEX8(0, hv_nv[0]); /* no mark while it is not whole */
    static const uint8_t get_counter[] = {11};
    uint8_t answer[MBC_FRAME_MAX];
    TEST_ASSERT_EQUAL(0, request(get_counter, 1, answer));
    TEST_ASSERT_EQUAL_HEX8(0xFF, answer[2]);                    /* a program command is being processed */
    TEST_ASSERT_EQUAL(4321, read_register(3, INV_P_SET_POINT)); /* reading goes on */
    hv_set_loop(loop, NULL);
    hv_run_for(10 * HV_MS);
    TEST_ASSERT_EQUAL(0, write_register(INV_P_SET_POINT, 1111));
    power_on();
    TEST_ASSERT_EQUAL(4321, read_register(3, INV_P_SET_POINT));
    hv_nv[3] ^= 1; /* an octet has rotted: defaults */
    power_on();
    TEST_ASSERT_EQUAL(5000, read_register(3, INV_P_SET_POINT));
}

static void test_power_lost_while_storing_leaves_the_defaults(void)
{
    for (unsigned passes = 0; passes < 12; passes++) {
        hv_set_loop(mb_poll, NULL);
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
    uint8_t answer[MBC_FRAME_MAX];
    write_coil(INV_COIL_RUN, true);
    inv_values[INV_V_RUN_SECONDS_LOW] = 0xFFF0;
    for (unsigned i = 0; i < 400; i++) {
        hv_run_for(100 * HV_MS);
        TEST_ASSERT_EQUAL(0, request(pdu, sizeof pdu, answer));
        const unsigned seconds =
            (unsigned)answer[3] << 24 | (unsigned)answer[4] << 16 | (unsigned)answer[5] << 8 | answer[6];
        TEST_ASSERT_UINT_WITHIN(60, 0xFFF0 + 25, seconds); /* never 0 or 1FFFF */
    }
    TEST_ASSERT_EQUAL(1, read_register(4, INV_V_RUN_SECONDS_HIGH));
}

static void test_the_trend_is_a_file_and_cannot_be_written(void)
{
    const uint8_t read[] = {20, 7, 6, 0, INV_FILE_TREND, 0, 0, 0, 2};
    const uint8_t write[] = {21, 9, 6, 0, INV_FILE_TREND, 0, 0, 0, 1, 0, 0};
    const uint8_t note[] = {21, 9, 6, 0, INV_FILE_NOTE, 0, 0, 0, 1, 0xAB, 0xCD};
    uint8_t answer[MBC_FRAME_MAX];
    write_coil(INV_COIL_RUN, true);
    hv_run_for(20 * SECOND);
    TEST_ASSERT_EQUAL(0, request(read, sizeof read, answer));
    TEST_ASSERT_EQUAL_HEX8(5000 >> 8, answer[5]);
    TEST_ASSERT_EQUAL_HEX8(5000 & 0xFF, answer[6]);
    TEST_ASSERT_EQUAL(4, request(write, sizeof write, answer));
    TEST_ASSERT_EQUAL(0, request(note, sizeof note, answer));
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
    return UNITY_END();
}
