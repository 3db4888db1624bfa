/* The Modbus inverter on the model of the F2808: requests and answers as octets (CRC: Modbus over serial line, 6.2.2). */
#include "contract_machine.h"
#include "cpu.h"
#include "inverter.h"
#include "modbus/mb.h"
#include "unity.h"

#include <string.h>

static uint8_t answer[64];
static unsigned answer_n;
static const uint8_t *request;
static unsigned request_n;
static uint64_t next;

void contract_restart(uint8_t why)
{
    TEST_FAIL_MESSAGE(why ? "assert" : "reset");
}

static void hear(uint8_t octet, uint64_t end)
{
    (void)end;
    if (answer_n < sizeof answer)
        answer[answer_n++] = octet;
}

static void say(void)
{
    if (request_n == 0 || f2808_now() < next)
        return;
    f2808_hear(*request++, 0);
    request_n--;
    next += f2808_char_clocks();
}

void setUp(void)
{
    static const struct f2808_wire wire = {hear, say};

    f2808_power_on();
    f2808_set_wire(&wire);
    hal_init();
    mb_port.bit_per_s = 19200;
    mb_port.format = HAL_8E1;
    mb_port.mode = MB_RTU;
    mb_port.address = 1;
    inv_init();
    TEST_ASSERT_EQUAL(HAL_LINE_TIMED, mb_open());
    hal_irq_restore(HAL_IRQ_ON);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, f2808_cut());
}

static void pass(uint16_t ms)
{
    const uint16_t began = hal_ticks();

    while ((uint16_t)(hal_ticks() - began) < ms) {
        mb_poll();
        inv_poll();
        hal_idle();
    }
}

static void ask(const char *octets, unsigned n)
{
    answer_n = 0;
    request = (const uint8_t *)octets;
    request_n = n;
    next = f2808_now() + 500000u; /* 5 ms: t3.5 and more */
    pass(100);
}

#define ASK(octets) ask(octets, sizeof octets - 1)
#define ANSWERED(octets)                                                                                         \
    (TEST_ASSERT_EQUAL_UINT(sizeof octets - 1, answer_n), TEST_ASSERT_EQUAL_HEX8_ARRAY(octets, answer, sizeof octets - 1))

static void registers_are_read(void)
{
    ASK("\x01\x03\x00\x00\x00\x03\x05\xCB");
    ANSWERED("\x01\x03\x06\x13\x88\x00\x00\x17\x70\xCD\xDD");
}

static void a_register_is_written_and_the_drive_follows(void)
{
    ASK("\x01\x06\x00\x00\x00\x0A\x09\xCD");
    ANSWERED("\x01\x06\x00\x00\x00\x0A\x09\xCD");
    ASK("\x01\x05\x00\x00\xFF\x00\x8C\x3A");
    ANSWERED("\x01\x05\x00\x00\xFF\x00\x8C\x3A");
    pass(200);
    TEST_ASSERT_EQUAL_UINT16(10, inv_values[INV_V_OUTPUT_FREQ]);
}

static void an_unknown_function_is_refused(void)
{
    ASK("\x01\x41\xC0\x10");
    ANSWERED("\x01\xC1\x01\xB0\x50");
}

static void another_station_and_a_wrong_crc_are_met_with_silence(void)
{
    ASK("\x02\x03\x00\x00\x00\x03\x05\xF8");
    TEST_ASSERT_EQUAL_UINT(0, answer_n);
    ASK("\x01\x03\x00\x00\x00\x03\x05\xCC");
    TEST_ASSERT_EQUAL_UINT(0, answer_n);
    registers_are_read();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(registers_are_read);
    RUN_TEST(a_register_is_written_and_the_drive_follows);
    RUN_TEST(an_unknown_function_is_refused);
    RUN_TEST(another_station_and_a_wrong_crc_are_met_with_silence);
    return UNITY_END();
}
