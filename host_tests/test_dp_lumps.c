/* A line that shows no silence (a pty, a USB converter): octets come in lumps, telegrams back to back, and no rule about
 * idle time can be kept. What is still true then: facts, sections 0.8 and 2.3. */
#include "dp_fixture.h"

#include <string.h>

static void boot_untimed(void)
{
    dp_begin(8, PHY_BAUD_19K2);
    hv_port.untimed = true;
    hv_port.fifo = 64;
    dp_power_cycle();
}

void setUp(void)
{
    boot_untimed();
}

void tearDown(void)
{
}

#define STATUS 0x10, 0x08, 0x02, 0x49, 0x53, 0x16
#define GAP_9  0x10, 0x09, 0x02, 0x49, 0x54, 0x16
#define DX_A   0x68, 0x05, 0x05, 0x68, 0x08, 0x02, 0x5D, 0x33, 0x44, 0xDE, 0x16

/* All octets at one moment. -> how many telegrams the station said to that. */
static unsigned lump(const uint8_t *octets, unsigned n)
{
    const unsigned before = seg_said.telegrams;
    for (unsigned i = 0; i < n; i++)
        hv_receive(octets[i], 0);
    hv_run_for(50 * HV_MS);
    (void)seg_verdict(); /* the judge has heard no request */
    return seg_said.telegrams - before;
}

#define LUMP(...) lump((const uint8_t[]){__VA_ARGS__}, sizeof(const uint8_t[]){__VA_ARGS__})

static void a_request_in_one_lump_is_answered(void)
{
    TEST_ASSERT_EQUAL_UINT(1, LUMP(STATUS));
    TEST_ASSERT_EQUAL_HEX8(0x00, seg_said.octets[3]);
}

static void tokens_polls_of_others_and_their_answers_before_it_do_no_harm(void)
{
    TEST_ASSERT_EQUAL_UINT(1,
                           LUMP(0xDC, 0x02, 0x02, GAP_9, 0x10, 0x02, 0x09, 0x00, 0x0B, 0x16, 0xE5, STATUS));
}

static void of_several_retries_in_one_lump_only_the_last_is_answered_and_one_executed(void)
{
    struct ddlm_counters c;
    TO_DATA_EXCH(SET_PRM);
    TEST_ASSERT_EQUAL_UINT(1, LUMP(DX_A, DX_A, DX_A, DX_A));
    ddlm_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT16(1, c.data_exchange);
    OUTPUTS(0x33, 0x44);
}

static void a_request_that_the_master_has_given_up_is_not_answered(void)
{
    TEST_ASSERT_EQUAL_UINT(0, LUMP(STATUS, STATUS, STATUS, STATUS, GAP_9));
    TEST_ASSERT_EQUAL_UINT(1, LUMP(STATUS));
}

static void a_telegram_in_several_lumps_is_one_telegram(void)
{
    static const uint8_t head[] = {0x10, 0x08, 0x02}, tail[] = {0x49, 0x53, 0x16};
    for (unsigned i = 0; i < sizeof head; i++)
        hv_receive(head[i], 0);
    hv_run_for(30 * hv_bit());
    TEST_ASSERT_EQUAL_UINT(1, lump(tail, sizeof tail));
}

static void after_rubbish_in_a_lump_silence_resynchronises(void)
{
    TEST_ASSERT_EQUAL_UINT(0, LUMP(0x68, 0x05, 0x00, 0x16, STATUS));
    TEST_ASSERT_EQUAL_UINT(1, LUMP(STATUS));
}

static void any_cut_of_the_octets_gives_the_same_answers(void)
{
    static const uint8_t octets[] = {0xDC, 0x02, 0x02, GAP_9, STATUS};
    for (unsigned cut = 1; cut < sizeof octets; cut++) {
        for (unsigned i = 0; i < cut; i++)
            hv_receive(octets[i], 0);
        hv_run_for(5 * hv_bit());
        TEST_ASSERT_EQUAL_UINT(1, lump(octets + cut, sizeof octets - cut));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_request_in_one_lump_is_answered);
    RUN_TEST(tokens_polls_of_others_and_their_answers_before_it_do_no_harm);
    RUN_TEST(of_several_retries_in_one_lump_only_the_last_is_answered_and_one_executed);
    RUN_TEST(a_request_that_the_master_has_given_up_is_not_answered);
    RUN_TEST(a_telegram_in_several_lumps_is_one_telegram);
    RUN_TEST(after_rubbish_in_a_lump_silence_resynchronises);
    RUN_TEST(any_cut_of_the_octets_gives_the_same_answers);
    return UNITY_END();
}
