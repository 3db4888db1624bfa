/* What the host's GSD file says about rates is what the firmware does. */
#include "boards/posix/dp_rates.h"
#include "phy_uart/phy_uart.h"
#include "unity.h"

static const struct {
    uint32_t bit_per_s;
    unsigned max_t_sdr;
} promised[] = {
#define ROW(name, bit_per_s, max_t_sdr) {bit_per_s, max_t_sdr},
    BOARD_DP_RATES(ROW)};
#define PROMISED (sizeof promised / sizeof promised[0])

void setUp(void)
{
}

void tearDown(void)
{
}

static void each_promised_rate_is_one_of_the_firmware_with_that_max_t_sdr(void)
{
    for (unsigned i = 0; i < PROMISED; i++) {
        uint8_t baud = 0;
        while (baud < PHY_BAUDS && phy_bit_per_s(baud) != promised[i].bit_per_s)
            baud++;
        TEST_ASSERT_LESS_THAN(PHY_BAUDS, baud);
        TEST_ASSERT_EQUAL(promised[i].max_t_sdr, phy_max_t_sdr(baud));
    }
}

static void each_rate_of_the_firmware_but_38_4_is_promised(void)
{
    unsigned found = 0;
    for (uint8_t baud = 0; baud < PHY_BAUDS; baud++)
        for (unsigned i = 0; i < PROMISED; i++)
            found += promised[i].bit_per_s == phy_bit_per_s(baud);
    TEST_ASSERT_EQUAL(PROMISED, found);
    TEST_ASSERT_EQUAL(PHY_BAUDS - 1, found); /* 38.4 kbit/s is not PROFIBUS (spec A1) */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(each_promised_rate_is_one_of_the_firmware_with_that_max_t_sdr);
    RUN_TEST(each_rate_of_the_firmware_but_38_4_is_promised);
    return UNITY_END();
}
