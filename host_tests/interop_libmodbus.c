/* libmodbus, a client nobody here wrote, against fieldling-modbus: all its calls, their limits and errors.
 * Started by interop_libmodbus.py with the station's pty; the station serves host_tests/modbus_image.txt at
 * address 17. */
#include "unity.h"

#include <errno.h>
#include <modbus.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static modbus_t *ctx;
static const char *pty;

void setUp(void)
{
    ctx = modbus_new_rtu(pty, 19200, 'N', 8, 1);
    TEST_ASSERT_NOT_NULL(ctx);
    modbus_set_slave(ctx, 17);
    modbus_set_response_timeout(ctx, 2, 0);
    TEST_ASSERT_EQUAL_MESSAGE(0, modbus_connect(ctx), modbus_strerror(errno));
}

void tearDown(void)
{
    modbus_close(ctx);
    modbus_free(ctx);
}

static void fails_with(int code, int result)
{
    TEST_ASSERT_EQUAL(-1, result);
    TEST_ASSERT_EQUAL_MESSAGE(code, errno, modbus_strerror(errno));
}

static void test_bits(void)
{
    uint8_t bits[MODBUS_MAX_READ_BITS];
    TEST_ASSERT_EQUAL(1, modbus_write_bit(ctx, 100, 1));
    TEST_ASSERT_EQUAL(1, modbus_read_bits(ctx, 100, 1, bits));
    TEST_ASSERT_EQUAL(1, bits[0]);
    TEST_ASSERT_EQUAL(1, modbus_write_bit(ctx, 100, 0));
    TEST_ASSERT_EQUAL(1, modbus_read_bits(ctx, 100, 1, bits));
    TEST_ASSERT_EQUAL(0, bits[0]);
    for (int i = 0; i < MODBUS_MAX_WRITE_BITS; i++)
        bits[i] = i % 3 == 0;
    TEST_ASSERT_EQUAL(MODBUS_MAX_WRITE_BITS, modbus_write_bits(ctx, 5, MODBUS_MAX_WRITE_BITS, bits));
    memset(bits, 0xFF, sizeof bits);
    TEST_ASSERT_EQUAL(MODBUS_MAX_READ_BITS, modbus_read_bits(ctx, 5, MODBUS_MAX_READ_BITS, bits));
    for (int i = 0; i < MODBUS_MAX_WRITE_BITS; i++)
        TEST_ASSERT_EQUAL(i % 3 == 0, bits[i]);
}

static void test_input_bits(void)
{
    uint8_t bits[MODBUS_MAX_READ_BITS];
    TEST_ASSERT_EQUAL(MODBUS_MAX_READ_BITS, modbus_read_input_bits(ctx, 0, MODBUS_MAX_READ_BITS, bits));
    for (int i = 0; i < MODBUS_MAX_READ_BITS; i++) /* inputs 0 2000 every 7 */
        TEST_ASSERT_EQUAL(i % 7 == 0, bits[i]);
}

static void test_registers(void)
{
    uint16_t values[MODBUS_MAX_READ_REGISTERS];
    TEST_ASSERT_EQUAL(1, modbus_write_register(ctx, 200, 0x1234));
    TEST_ASSERT_EQUAL(1, modbus_read_registers(ctx, 200, 1, values));
    TEST_ASSERT_EQUAL_HEX16(0x1234, values[0]);
    for (int i = 0; i < MODBUS_MAX_WRITE_REGISTERS; i++)
        values[i] = (uint16_t)(i * 257);
    TEST_ASSERT_EQUAL(MODBUS_MAX_WRITE_REGISTERS,
                      modbus_write_registers(ctx, 300, MODBUS_MAX_WRITE_REGISTERS, values));
    memset(values, 0, sizeof values);
    TEST_ASSERT_EQUAL(MODBUS_MAX_READ_REGISTERS,
                      modbus_read_registers(ctx, 300, MODBUS_MAX_READ_REGISTERS, values));
    for (int i = 0; i < MODBUS_MAX_WRITE_REGISTERS; i++)
        TEST_ASSERT_EQUAL_HEX16(i * 257, values[i]);
    TEST_ASSERT_EQUAL_HEX16(3 * 423 + 5, values[123]); /* holding-regs 0 1000 linear 3 5 */
}

static void test_input_registers(void)
{
    uint16_t values[MODBUS_MAX_READ_REGISTERS];
    TEST_ASSERT_EQUAL(MODBUS_MAX_READ_REGISTERS,
                      modbus_read_input_registers(ctx, 875, MODBUS_MAX_READ_REGISTERS, values));
    for (int i = 0; i < MODBUS_MAX_READ_REGISTERS; i++) /* input-regs 0 1000 linear 2 100 */
        TEST_ASSERT_EQUAL(2 * (875 + i) + 100, values[i]);
}

static void test_mask_write(void)
{
    uint16_t value;
    TEST_ASSERT_EQUAL(1, modbus_write_register(ctx, 500, 0x12));
    TEST_ASSERT_EQUAL(1, modbus_mask_write_register(ctx, 500, 0xF2, 0x25));
    TEST_ASSERT_EQUAL(1, modbus_read_registers(ctx, 500, 1, &value));
    TEST_ASSERT_EQUAL_HEX16(0x17, value);
}

static void test_write_and_read(void)
{
    uint16_t values[MODBUS_MAX_WR_READ_REGISTERS], out[MODBUS_MAX_WR_WRITE_REGISTERS];
    for (int i = 0; i < MODBUS_MAX_WR_WRITE_REGISTERS; i++)
        out[i] = (uint16_t)(0x8000 + i);
    TEST_ASSERT_EQUAL(MODBUS_MAX_WR_READ_REGISTERS,
                      modbus_write_and_read_registers(ctx, 600, MODBUS_MAX_WR_WRITE_REGISTERS, out, 600,
                                                      MODBUS_MAX_WR_READ_REGISTERS, values));
    TEST_ASSERT_EQUAL_HEX16_ARRAY(out, values, MODBUS_MAX_WR_WRITE_REGISTERS);
}

static void test_server_id(void)
{
    uint8_t id[MODBUS_MAX_PDU_LENGTH];
    TEST_ASSERT_EQUAL(2 + 11, modbus_report_slave_id(ctx, sizeof id, id));
    TEST_ASSERT_EQUAL(180, id[0]); /* server-id 180 test server */
    TEST_ASSERT_EQUAL_HEX8(0xFF, id[1]);
    TEST_ASSERT_EQUAL_MEMORY("test server", id + 2, 11);
}

static void test_addresses_outside(void)
{
    uint8_t bits[16] = {0};
    uint16_t values[16] = {0};
    fails_with(EMBXILADD, modbus_read_bits(ctx, 2999, 2, bits));
    fails_with(EMBXILADD, modbus_read_input_bits(ctx, 2000, 1, bits));
    fails_with(EMBXILADD, modbus_read_registers(ctx, 999, 2, values));
    fails_with(EMBXILADD, modbus_read_input_registers(ctx, 1000, 1, values));
    fails_with(EMBXILADD, modbus_write_bit(ctx, 3000, 1));
    fails_with(EMBXILADD, modbus_write_register(ctx, 1000, 1));
    fails_with(EMBXILADD, modbus_write_bits(ctx, 2999, 2, bits));
    fails_with(EMBXILADD, modbus_write_registers(ctx, 999, 2, values));
    fails_with(EMBXILADD, modbus_mask_write_register(ctx, 1000, 1, 1));
    fails_with(EMBXILADD, modbus_write_and_read_registers(ctx, 999, 2, values, 0, 1, values));
    fails_with(EMBXILADD, modbus_write_and_read_registers(ctx, 0, 1, values, 999, 2, values));
}

static int raw(const uint8_t *request, int n, uint8_t *answer)
{
    TEST_ASSERT_EQUAL(n + 2, modbus_send_raw_request(ctx, (uint8_t *)request, n));
    return modbus_receive_confirmation(ctx, answer);
}

/* What the library itself would refuse to ask: the answers are 5 octets long, address, function | 80H, 03,
 * CRC. */
static void test_quantities_outside(void)
{
    static const uint8_t requests[][13] = {
        {17, 1, 0, 0, 0x07, 0xD1}, {17, 2, 0, 0, 0, 0},    {17, 3, 0, 0, 0, 0x7E},
        {17, 4, 0, 0, 0, 0},       {17, 5, 0, 0, 0x12, 0}, {17, 1, 0, 0, 0xFF, 0xFF},
    };
    uint8_t answer[MODBUS_RTU_MAX_ADU_LENGTH];
    for (unsigned i = 0; i < sizeof requests / sizeof requests[0]; i++) {
        TEST_ASSERT_EQUAL(5, raw(requests[i], 6, answer));
        TEST_ASSERT_EQUAL_HEX8(requests[i][1] | 0x80, answer[1]);
        TEST_ASSERT_EQUAL(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE, answer[2]);
    }
    /* libmodbus' own test: function 16, quantity 0, count 0, but six data octets; framed by silence, not by
     * length */
    static const uint8_t odd[] = {17, 16, 0, 0, 0, 0, 0, 0, 1, 0, 2, 0, 3};
    TEST_ASSERT_EQUAL(5, raw(odd, sizeof odd, answer));
    TEST_ASSERT_EQUAL(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE, answer[2]);
}

static void read_all(uint8_t *to, size_t n)
{
    for (size_t got = 0; got < n;) {
        struct pollfd p = {.fd = modbus_get_socket(ctx), .events = POLLIN};
        TEST_ASSERT_EQUAL_MESSAGE(1, poll(&p, 1, 2000), "no answer");
        const ssize_t k = read(p.fd, to + got, n - got);
        TEST_ASSERT_GREATER_THAN(0, k);
        got += (size_t)k;
    }
}

/* Functions this library has no call for: 24 (fifo 0x4DE 440 4740), 20 (file 4 20 linear 1 0x100), 43/14. */
static void test_raw_fifo_file_and_identification(void)
{
    static const uint8_t fifo[] = {17, 24, 0x04, 0xDE},
                         fifo_answer[] = {17, 24, 0, 6, 0, 2, 0x01, 0xB8, 0x12, 0x84};
    static const uint8_t file[] = {17, 20, 7, 6, 0, 4, 0, 1, 0, 2},
                         file_answer[] = {17, 20, 6, 5, 6, 1, 1, 1, 2};
    static const uint8_t vendor[] = {17, 43, 14, 4, 0};
    uint8_t answer[MODBUS_RTU_MAX_ADU_LENGTH];
    modbus_send_raw_request(ctx, (uint8_t *)fifo, sizeof fifo);
    read_all(answer, sizeof fifo_answer + 2);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(fifo_answer, answer, sizeof fifo_answer);
    modbus_send_raw_request(ctx, (uint8_t *)file, sizeof file);
    read_all(answer, sizeof file_answer + 2);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(file_answer, answer, sizeof file_answer);
    modbus_send_raw_request(ctx, (uint8_t *)vendor, sizeof vendor);
    read_all(answer, 19 + 2);
    TEST_ASSERT_EQUAL_MEMORY("Fieldling", answer + 10, 9);
}

static void test_unknown_function(void)
{
    static const uint8_t request[] = {17, 0x42};
    uint8_t answer[MODBUS_RTU_MAX_ADU_LENGTH];
    TEST_ASSERT_EQUAL(5, raw(request, 2, answer));
    TEST_ASSERT_EQUAL_HEX8(0xC2, answer[1]);
    TEST_ASSERT_EQUAL(MODBUS_EXCEPTION_ILLEGAL_FUNCTION, answer[2]);
}

static void test_an_absent_station_does_not_answer_and_ours_does_at_once_after_it(void)
{
    uint16_t value;
    for (int i = 0; i < 5; i++) {
        modbus_set_response_timeout(ctx, 0, 100000);
        modbus_set_slave(ctx, 18);
        fails_with(ETIMEDOUT, modbus_read_registers(ctx, 0, 1, &value));
        modbus_set_response_timeout(ctx, 2, 0);
        modbus_set_slave(ctx, 17);
        TEST_ASSERT_EQUAL_MESSAGE(1, modbus_read_registers(ctx, 0, 1, &value), modbus_strerror(errno));
    }
}

static void test_broadcast_is_executed_and_not_answered(void)
{
    uint16_t value;
    modbus_set_response_timeout(ctx, 0, 100000);
    TEST_ASSERT_EQUAL(0, modbus_set_slave(ctx, MODBUS_BROADCAST_ADDRESS));
    fails_with(ETIMEDOUT, modbus_write_register(ctx, 700, 0xBCA5));
    modbus_set_response_timeout(ctx, 2, 0);
    modbus_set_slave(ctx, 17);
    TEST_ASSERT_EQUAL(1, modbus_read_registers(ctx, 700, 1, &value));
    TEST_ASSERT_EQUAL_HEX16(0xBCA5, value);
}

static void test_a_thousand_requests_one_after_the_other(void)
{
    uint16_t value;
    for (uint16_t i = 0; i < 500; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(1, modbus_write_register(ctx, 701, i), modbus_strerror(errno));
        TEST_ASSERT_EQUAL_MESSAGE(1, modbus_read_registers(ctx, 701, 1, &value), modbus_strerror(errno));
        TEST_ASSERT_EQUAL(i, value);
    }
}

int main(int argc, char **argv)
{
    if (argc != 2)
        return 2;
    pty = argv[1];
    UNITY_BEGIN();
    RUN_TEST(test_bits);
    RUN_TEST(test_input_bits);
    RUN_TEST(test_registers);
    RUN_TEST(test_input_registers);
    RUN_TEST(test_mask_write);
    RUN_TEST(test_write_and_read);
    RUN_TEST(test_server_id);
    RUN_TEST(test_addresses_outside);
    RUN_TEST(test_quantities_outside);
    RUN_TEST(test_raw_fifo_file_and_identification);
    RUN_TEST(test_unknown_function);
    RUN_TEST(test_an_absent_station_does_not_answer_and_ours_does_at_once_after_it);
    RUN_TEST(test_broadcast_is_executed_and_not_answered);
    RUN_TEST(test_a_thousand_requests_one_after_the_other);
    return UNITY_END();
}
