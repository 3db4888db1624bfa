/* Samples of a remote module after 70000 of them: numbers have 16 bits. */
#include "hdlc_peer.h"
#include "remote_board_fake.h"
#include "remote_module.h"
#include "unity.h"

static void init(void)
{
    rm_init(RM_AI, 5, 0);
}

void setUp(void)
{
    board_fake_begin();
    peer_begin(init, rm_poll);
}

void tearDown(void)
{
    peer_end();
}

/* Octet at of the answer, and the next: high octet first. */
static uint16_t field(unsigned at)
{
    return (uint16_t)(peer.answer[2 + at] << 8 | peer.answer[2 + at + 1]);
}

static void test_samples_numbers_and_losses_survive_the_wrap_of_16_bits(void)
{
    uint8_t command[] = {0x05, 0x10, 0x04, 0x01, 0x00};
    uint16_t number = (uint16_t)69941; /* the log holds 60 */
    uint8_t ns = 0;
    for (uint32_t k = 1; k <= 70000; k++) {
        board.analog_in[0] = (uint16_t)k;
        for (unsigned i = 0; i < RM_SAMPLE_MS; i++)
            peer_interrupt(rm_tick_isr);
        if (k % 1000 == 0)
            peer_run(20); /* the main loop looks at every channel */
    }
    ANSWERS("05 93", "05 73");
    for (;;) {
        command[1] = (uint8_t)(ns << 5 | 0x10 | ns << 1);
        TEST_ASSERT_TRUE(peer_ask(command, sizeof command));
        TEST_ASSERT_EQUAL_HEX16(ns ? 0 : 0xFFFF, field(2)); /* 69941 lost, saturated; and then none */
        TEST_ASSERT_EQUAL_HEX16(number, field(4));
        if (peer.answer[2 + 6] == 0)
            break;
        for (unsigned i = 0; i < peer.answer[2 + 6]; i++)
            TEST_ASSERT_EQUAL_HEX16(number++, field(7 + 2 * i));
        ns = (ns + 1) & 7;
    }
    TEST_ASSERT_EQUAL_HEX16((uint16_t)70001, number);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_samples_numbers_and_losses_survive_the_wrap_of_16_bits);
    return UNITY_END();
}
