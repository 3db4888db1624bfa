/* PHY variable Loop (spec A2): transmitter and receiver of the station alone, through all of PHY and FDL. */
#include "dp_fixture.h"
#include "hal_virtual.h"

/* FDL status request of station 8 to itself (EN 50170-2 part 4, 4.7.1): its FCS is 08 + 08 + 49. */
static uint8_t XDATA to_itself[] = {0x10, 0x08, 0x08, 0x49, 0x59, 0x16};

static struct fdl_counters after;

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

static void send_to_itself(void)
{
    uint8_t irq = hal_irq_save();

    phy_tx.at = to_itself;
    phy_tx.len = sizeof to_itself;
    phy_answer_isr();
    hal_irq_restore(irq);
    hv_run_for(50 * HV_MS);
    fdl_read_counters(&after);
}

static void in_the_loop_the_station_hears_and_answers_itself(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_LOOP, PHY_ENABLED));
    hv_run_for(10 * HV_MS);
    send_to_itself();
    TEST_ASSERT_EQUAL_UINT(1, after.requests);
    TEST_ASSERT_EQUAL_UINT(1, after.answers);
    TEST_ASSERT_EQUAL_UINT(0, after.cancelled + after.gap + after.format + after.checksum + after.sd_error_count);
}

static void in_the_loop_nothing_reaches_the_line_and_nothing_comes_from_it(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_LOOP, PHY_ENABLED));
    hv_run_for(10 * HV_MS);
    SILENT("10 08 02 49 53 16");
    send_to_itself();
    TEST_ASSERT_EQUAL_UINT(0, seg_said.telegrams);
    TEST_ASSERT_EQUAL_UINT(1, after.requests);
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_LOOP, PHY_DISABLED));
    hv_run_for(10 * HV_MS);
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
}

static void without_the_loop_the_station_does_not_hear_itself(void)
{
    send_to_itself();
    TEST_ASSERT_EQUAL_UINT(0, after.requests + after.foreign);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(in_the_loop_the_station_hears_and_answers_itself);
    RUN_TEST(in_the_loop_nothing_reaches_the_line_and_nothing_comes_from_it);
    RUN_TEST(without_the_loop_the_station_does_not_hear_itself);
    return UNITY_END();
}
