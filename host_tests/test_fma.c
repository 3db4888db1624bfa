/* FMA1/2: the variables of PHY and FDL, SAP management, Ident, events; every M_status a slave can give.
 * Clauses: EN 50170-2 part 3, FMA1/2; part 4, 4.1.7 (T_TO = 6 T_SL + 2 n T_SL, n = 130); spec A5. */
#include "fdl_unit.h"

static struct {
    uint8_t count;
    uint8_t event;
    uint8_t detail;
} last;

void fma_event_ind(uint8_t event, uint8_t detail)
{
    last.count++;
    last.event = event;
    last.detail = detail;
}

static uint8_t events(void)
{
    uint8_t n = last.count;

    last.count = 0;
    return n;
}

void setUp(void)
{
    unit_begin();
    last.count = 0;
}

void tearDown(void)
{
    fake_end();
}

static uint16_t XDATA value;

static uint16_t read(uint8_t variable)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_read_value(variable, &value));
    return value;
}

/* ---- reset ---- */

static void reset_takes_an_address_of_0_to_126(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_reset(0));
    TEST_ASSERT_EQUAL(FMA_OK, fma_reset(126));
    TEST_ASSERT_EQUAL_UINT16(126, read(FMA_TS));
    TEST_ASSERT_EQUAL(FMA_IV, fma_reset(127));
    TEST_ASSERT_EQUAL_UINT16(126, read(FMA_TS));
}

static void reset_gives_every_variable_its_first_value(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    fma_set_value(FMA_T_SL, 1000);
    fma_set_value(FMA_MIN_T_SDR, 50);
    request("10 08 02 49 53 16");
    fma_reset(5);
    TEST_ASSERT_EQUAL_UINT16(5, read(FMA_TS));
    TEST_ASSERT_EQUAL_UINT16(255, read(FMA_BAUD_RATE)); /* none: the line is closed */
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_MEDIUM_RED));
    TEST_ASSERT_EQUAL_UINT16(1, read(FMA_TRANSMITTER));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_SIGNAL_SOURCE));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_LOOP));
    TEST_ASSERT_EQUAL_UINT16(100, read(FMA_T_SL));
    TEST_ASSERT_EQUAL_UINT16(11, read(FMA_MIN_T_SDR));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_SD_COUNT));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_SD_ERROR_COUNT));
    TEST_ASSERT_EQUAL(FMA_LS, fma_sap_deactivate(10));
}

/* ---- variables ---- */

static void the_station_address_is_0_to_126(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_TS, 0));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_TS, 126));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_TS, 127));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_TS, 256));
    TEST_ASSERT_EQUAL_UINT16(126, read(FMA_TS));
}

static void the_slot_time_is_37_to_16383_bit_times(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_T_SL, 37));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_T_SL, 16383));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_T_SL, 36));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_T_SL, 16384));
    TEST_ASSERT_EQUAL_UINT16(16383, read(FMA_T_SL));
}

static void min_t_sdr_is_11_to_255_bit_times(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_MIN_T_SDR, 11));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_MIN_T_SDR, 255));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_MIN_T_SDR, 10));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_MIN_T_SDR, 256));
    TEST_ASSERT_EQUAL_UINT16(255, read(FMA_MIN_T_SDR));
    fake_silence();
    hear("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL(255, fake.limit);
    fake_silence();
    fake_sent();
}

static void the_variables_of_phy_are_reached_through_fma(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_BAUD_RATE, 3));
    TEST_ASSERT_EQUAL_UINT32(187500, fake.rate);
    TEST_ASSERT_EQUAL_UINT16(3, read(FMA_BAUD_RATE));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_LOOP, 1));
    TEST_ASSERT_EQUAL_UINT16(1, read(FMA_LOOP));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_TRANSMITTER, 0));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_TRANSMITTER));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_MEDIUM_RED, 0));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_SIGNAL_SOURCE, 0));
}

static void what_the_hardware_cannot_is_answered_no(void)
{
    fake.fastest = 1500000;
    TEST_ASSERT_EQUAL(FMA_NO, fma_set_value(FMA_BAUD_RATE, 10));
    TEST_ASSERT_EQUAL(FMA_NO, fma_set_value(FMA_MEDIUM_RED, 1));
    TEST_ASSERT_EQUAL(FMA_NO, fma_set_value(FMA_SIGNAL_SOURCE, 2));
    TEST_ASSERT_EQUAL_UINT16(1, read(FMA_BAUD_RATE));
}

static void what_does_not_exist_is_answered_iv(void)
{
    value = 4711;
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_BAUD_RATE, 11));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_BAUD_RATE, 257)); /* not 1 */
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_LOOP, 2));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_VARIABLES, 0));
    TEST_ASSERT_EQUAL(FMA_IV, fma_read_value(FMA_VARIABLES, &value));
    TEST_ASSERT_EQUAL_UINT16(4711, value);
}

static void start_delimiters_are_counted_and_the_counts_can_be_cleared_only(void)
{
    request("10 08 02 49 53 16");
    request("DC 02 03");
    request("11");
    TEST_ASSERT_EQUAL_UINT16(2, read(FMA_SD_COUNT));
    TEST_ASSERT_EQUAL_UINT16(1, read(FMA_SD_ERROR_COUNT));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_SD_COUNT, 5));
    TEST_ASSERT_EQUAL(FMA_IV, fma_set_value(FMA_SD_ERROR_COUNT, 5));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_SD_COUNT, 0));
    TEST_ASSERT_EQUAL(FMA_OK, fma_set_value(FMA_SD_ERROR_COUNT, 0));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_SD_COUNT));
    TEST_ASSERT_EQUAL_UINT16(0, read(FMA_SD_ERROR_COUNT));
}

/* ---- Ident ---- */

static void ident_is_vendor_type_hardware_and_software_release(void)
{
    static uint8_t XDATA data[64];

    TEST_ASSERT_EQUAL(23, fma_ident(data));
    /* 9 4 2 4, Fieldling, UNIT, H1, S2.3 */
    OCTETS("09 04 02 04 46 69 65 6C 64 6C 69 6E 67 55 4E 49 54 48 31 53 32 2E 33", data, 23);
}

/* ---- SAPs ---- */

static void sap_activate_takes_sda_sdn_or_both(void)
{
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(1, FDL_ALL, FDL_SDA, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(1, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(1, FDL_ALL, FDL_SDA | FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_activate(1, FDL_ALL, 0, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_activate(1, FDL_ALL, FDL_SRD, 1, FDL_TO_MAIN));
}

static void parameters_out_of_range_are_answered_iv(void)
{
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_activate(63, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_activate(65, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_activate(1, 128, FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_activate(1, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN + 1));
    TEST_ASSERT_EQUAL(FMA_IV, fma_rsap_activate(63, FDL_ALL, 1, FDL_TO_MAIN, 0));
    TEST_ASSERT_EQUAL(FMA_IV, fma_rsap_activate(1, 128, 1, FDL_TO_MAIN, 0));
    TEST_ASSERT_EQUAL(FMA_IV, fma_rsap_activate(1, FDL_ALL, 1, FDL_TO_MAIN + 1, 0));
    TEST_ASSERT_EQUAL(FMA_IV, fma_sap_deactivate(65));
    TEST_ASSERT_EQUAL(FMA_LS, fma_sap_deactivate(1));
}

static void the_thirteenth_sap_has_no_resource(void)
{
    uint8_t i;

    for (i = 0; i < 12; i++)
        TEST_ASSERT_EQUAL(FMA_OK, fma_rsap_activate(i, i, 1, FDL_TO_MAIN, 0));
    TEST_ASSERT_EQUAL(FMA_LR, fma_rsap_activate(12, FDL_ALL, 1, FDL_TO_MAIN, 0));
    TEST_ASSERT_EQUAL(FMA_LR, fma_sap_activate(12, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_deactivate(0));
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(12, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN));
}

static void lsap_status_shows_what_was_activated(void)
{
    static struct fdl_sap PAGED sap;

    TEST_ASSERT_EQUAL(FMA_LS, fma_lsap_status(20, &sap));
    fma_sap_activate(20, 3, FDL_SDA, 17, FDL_TO_ISR);
    TEST_ASSERT_EQUAL(FMA_OK, fma_lsap_status(20, &sap));
    TEST_ASSERT_EQUAL(3, sap.access);
    TEST_ASSERT_EQUAL_HEX8(FDL_SDA, sap.services);
    TEST_ASSERT_EQUAL(17, sap.max_len);
    TEST_ASSERT_EQUAL(FDL_TO_ISR, sap.handling);
    TEST_ASSERT_TRUE(sap.reply == 0);
    unit_srd_sap(FDL_TO_MAIN);
    fma_lsap_status(10, &sap);
    TEST_ASSERT_EQUAL(127, sap.access);
    TEST_ASSERT_EQUAL_HEX8(FDL_SRD, sap.services);
    TEST_ASSERT_TRUE(sap.reply == &reply_10);
    TEST_ASSERT_EQUAL(FMA_IV, fma_lsap_status(65, &sap));
}

/* ---- events ---- */

static void a_changed_phy_variable_is_an_event(void)
{
    fma_set_value(FMA_BAUD_RATE, 0);
    TEST_ASSERT_EQUAL(1, events());
    TEST_ASSERT_EQUAL(FMA_EVENT_PHY, last.event);
    TEST_ASSERT_EQUAL(3, last.detail); /* PHY Baud_rate */
    fma_set_value(FMA_BAUD_RATE, 0);
    TEST_ASSERT_EQUAL(0, events());
}

/* 266 slots of 100 T_bit at 19.2 kbit/s are 1385 ms. */
static void silence_for_t_to_is_one_time_out(void)
{
    fma_poll(1000);
    fma_poll(384);
    fma_poll(0);
    TEST_ASSERT_EQUAL(0, events());
    fma_poll(1);
    fma_poll(0);
    TEST_ASSERT_EQUAL(1, events());
    TEST_ASSERT_EQUAL(FMA_EVENT_TIME_OUT, last.event);
    fma_poll(1000);
    fma_poll(1000);
    TEST_ASSERT_EQUAL(0, events());
    request("10 09 02 49 54 16");
    fma_poll(1000);
    fma_poll(1000);
    fma_poll(1000);
    TEST_ASSERT_EQUAL(0, events());
    fma_poll(0);
    TEST_ASSERT_EQUAL(1, events());
}

static void a_start_delimiter_from_anybody_ends_the_silence(void)
{
    uint8_t i;

    for (i = 0; i < 10; i++) {
        fma_poll(1000);
        request("DC 02 03");
    }
    TEST_ASSERT_EQUAL(0, events());
}

static void t_to_is_never_less_than_100_ms(void)
{
    fma_set_value(FMA_BAUD_RATE, 10);
    events();
    fma_poll(99);
    fma_poll(0);
    TEST_ASSERT_EQUAL(0, events());
    fma_poll(1);
    fma_poll(0);
    TEST_ASSERT_EQUAL(1, events());
}

/* 266 slots of 16383 T_bit at 19.2 kbit/s would be 227 s. */
static void t_to_is_never_more_than_60_s(void)
{
    uint8_t i;

    fma_set_value(FMA_T_SL, 16383);
    for (i = 0; i < 60; i++)
        fma_poll(999);
    fma_poll(0);
    TEST_ASSERT_EQUAL(0, events());
    fma_poll(60);
    fma_poll(0);
    TEST_ASSERT_EQUAL(1, events());
}

/* 266 slots of 16160 T_bit at 12 Mbit/s are 358 ms. */
static void t_to_is_right_for_long_slots_at_high_rates(void)
{
    fma_set_value(FMA_BAUD_RATE, 10);
    fma_set_value(FMA_T_SL, 16160);
    events();
    fma_poll(357);
    fma_poll(0);
    TEST_ASSERT_EQUAL(0, events());
    fma_poll(1);
    fma_poll(0);
    TEST_ASSERT_EQUAL(1, events());
}

static void rubbish_alone_is_not_syn(void)
{
    request("11");
    fma_poll(1);
    TEST_ASSERT_EQUAL(1, events());
    TEST_ASSERT_EQUAL(FMA_EVENT_NOT_SYN, last.event);
    TEST_ASSERT_EQUAL(1, last.detail);
    fma_poll(1);
    TEST_ASSERT_EQUAL(0, events());
    request("12");
    request("10 09 02 49 54 16");
    fma_poll(1);
    TEST_ASSERT_EQUAL(0, events());
}

static void clearing_the_counts_is_neither_rubbish_nor_a_telegram(void)
{
    request("11");
    request("E5");
    fma_poll(1);
    events();
    fma_poll(1000);
    fma_set_value(FMA_SD_ERROR_COUNT, 0);
    fma_set_value(FMA_SD_COUNT, 0);
    fma_poll(1000);
    TEST_ASSERT_EQUAL(0, events());
    fma_poll(0);
    TEST_ASSERT_EQUAL(1, events());
    TEST_ASSERT_EQUAL(FMA_EVENT_TIME_OUT, last.event);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(reset_takes_an_address_of_0_to_126);
    RUN_TEST(reset_gives_every_variable_its_first_value);
    RUN_TEST(the_station_address_is_0_to_126);
    RUN_TEST(the_slot_time_is_37_to_16383_bit_times);
    RUN_TEST(min_t_sdr_is_11_to_255_bit_times);
    RUN_TEST(the_variables_of_phy_are_reached_through_fma);
    RUN_TEST(what_the_hardware_cannot_is_answered_no);
    RUN_TEST(what_does_not_exist_is_answered_iv);
    RUN_TEST(start_delimiters_are_counted_and_the_counts_can_be_cleared_only);
    RUN_TEST(ident_is_vendor_type_hardware_and_software_release);
    RUN_TEST(sap_activate_takes_sda_sdn_or_both);
    RUN_TEST(parameters_out_of_range_are_answered_iv);
    RUN_TEST(the_thirteenth_sap_has_no_resource);
    RUN_TEST(lsap_status_shows_what_was_activated);
    RUN_TEST(a_changed_phy_variable_is_an_event);
    RUN_TEST(silence_for_t_to_is_one_time_out);
    RUN_TEST(a_start_delimiter_from_anybody_ends_the_silence);
    RUN_TEST(t_to_is_never_less_than_100_ms);
    RUN_TEST(t_to_is_never_more_than_60_s);
    RUN_TEST(t_to_is_right_for_long_slots_at_high_rates);
    RUN_TEST(rubbish_alone_is_not_syn);
    RUN_TEST(clearing_the_counts_is_neither_rubbish_nor_a_telegram);
    return UNITY_END();
}
