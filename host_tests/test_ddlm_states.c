/* Every service in every state, as facts 3.6 tables them (EN 50170-2 part 8, slave state machine; spec A6, A7), and the
 * start of a station. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
}

void tearDown(void)
{
    fake_end();
}

/* Answers. */
enum { NONE, SC, DATA, RS };

static uint8_t kind(void)
{
    if (fake.sent_len == 0)
        return NONE;
    if (fake.sent[0] == 0xE5)
        return SC;
    if (fake.sent[0] == 0x10)
        return fake.sent[3] == 0x03 ? RS : 0xFF;
    return DATA;
}

/* Without the main loop: nothing changes state under the table. */
static uint8_t answer_of(uint8_t da, uint8_t sap)
{
    fake.sent_len = 0;
    fake_silence();
    hear("68 05 05 68");
    fake_octet((uint8_t)(da | 0x80), 0);
    hear("82 6D");
    fake_octet(sap, 0);
    hear("3E");
    fake_octet((uint8_t)((da | 0x80) + 0x12D + sap), 0); /* 82 + 6D + 3E = 12D */
    fake_octet(0x16, 0);
    finish_request();
    return kind();
}

static uint8_t data_exchange_of(uint8_t da)
{
    fake.sent_len = 0;
    fake_silence();
    hear("68 05 05 68");
    fake_octet(da, 0);
    hear("02 6D 01 02");
    fake_octet((uint8_t)(da + 0x72), 0);
    fake_octet(0x16, 0);
    finish_request();
    return kind();
}

struct row {
    uint8_t state;
    uint8_t answers[10]; /* SAP 55 .. 62, Data_Exchange, a SAP no slave has */
};

static const CODE struct row table[4] = {
    /*                Set_Add Rd_Inp Rd_Outp Control Get_Cfg Diag  Set_Prm Chk_Cfg Exchange  54 */
    {DDLM_POWER_ON, {  SC,    RS,    RS,     RS,     DATA,   DATA, RS,     RS,     RS,       RS}},
    {DDLM_WAIT_PRM, {  RS,    RS,    RS,     RS,     DATA,   DATA, SC,     SC,     RS,       RS}},
    {DDLM_WAIT_CFG, {  RS,    RS,    RS,     RS,     DATA,   DATA, SC,     SC,     RS,       RS}},
    {DDLM_DATA_EXCH, { RS,    DATA,  DATA,   RS,     DATA,   DATA, SC,     SC,     DATA,     RS}},
};

/* By switches at 8 Set_Slave_Add is refused everywhere (spec A6). */
static void every_service(const CODE struct row *row, uint8_t da)
{
    uint8_t i;

    STATE(row->state);
    TEST_ASSERT_EQUAL_MESSAGE(row->answers[8], data_exchange_of(da), "Data_Exchange");
    TEST_ASSERT_EQUAL_MESSAGE(row->answers[9], answer_of(da, 54), "SAP 54");
    for (i = 0; i < 8; i++)
        TEST_ASSERT_EQUAL_MESSAGE(row->answers[i], answer_of(da, (uint8_t)(55 + i)), "SAP 55...");
}

static void services_at_power_on_without_an_address(void)
{
    station_begin(126);
    every_service(&table[0], 126);
}

static void services_in_wait_prm(void)
{
    every_service(&table[1], 8);
}

static void services_in_wait_cfg(void)
{
    to_wait_cfg();
    every_service(&table[2], 8);
}

static void services_in_data_exch(void)
{
    to_data_exch();
    ddlm_outputs(outputs);
    every_service(&table[3], 8);
}

static void set_slave_add_is_acknowledged_in_every_state_where_the_address_is_not_from_switches(void)
{
    station_begin(126);
    ask_sap(126, 2, 55, "08 12 34 00");
    ANSWERED("E5");
    TEST_ASSERT_EQUAL(SC, answer_of(8, 55));
    turn();
    to_wait_cfg();
    TEST_ASSERT_EQUAL(SC, answer_of(8, 55));
    turn();
    to_data_exch();
    TEST_ASSERT_EQUAL(SC, answer_of(8, 55));
    turn();
    STATE(DDLM_DATA_EXCH);
}

static void fdl_status_is_answered_in_every_state(void)
{
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
    to_wait_cfg();
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
    to_data_exch();
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
}

static void ident_names_the_device(void)
{
    request("10 08 02 4E 58 16"); /* Fieldling UNIT H1 S2.3 */
    ANSWERED("68 1A 1A 68 02 08 08 09 04 02 04 46 69 65 6C 64 6C 69 6E 67 55 4E 49 54 48 31 53 32 2E 33 52 16");
}

static void the_station_starts_in_wait_prm_with_an_address_and_fail_safe_outputs(void)
{
    STATE(DDLM_WAIT_PRM);
    INFO(8, address);
    INFO(DDLM_NO_MASTER, master);
    INFO(1, baud);
    INFO(11, min_t_sdr);
    INFO(2, input_len);
    INFO(2, output_len);
    INFO(true, not_ready);
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
    OUTPUTS(DDLM_OUT_SAME, "00 00");
}

static void a_second_start_forgets_the_first(void)
{
    app.prm_good = true;
    ask_sap(8, 2, 61, "B8 0A 0A 0B 12 34 05");
    ask_sap(8, 2, 62, "10 20 10 20");
    inputs("31 01");
    ask("68 07 07 68 FF 82 46 3A 3E 28 00 67 16");
    INFO(true, sync);
    station_begin(126);
    STATE(DDLM_POWER_ON);
    INFO(DDLM_NO_MASTER, master);
    INFO(0, groups);
    INFO(false, sync);
    INFO(false, freeze);
    INFO(false, sync_enabled);
    INFO(false, freeze_enabled);
    INFO(false, wd_on);
    COUNTED(0, global_control);
    DIAG("02 05 00 FF 12 34");
}

static void data_for_saps_of_the_application_reach_it(void)
{
    app.data_count = 0;
    TEST_ASSERT_EQUAL(FMA_OK, fma_rsap_activate(40, FDL_ALL, 8, FDL_TO_MAIN, 0));
    ask_sap(8, 2, 40, "01 02");
    ANSWERED("E5");
    TEST_ASSERT_EQUAL(1, app.data_count);
    TEST_ASSERT_EQUAL(40, app.data_sap);
}

/* FDL_TO_ISR is DDLM's own: a SAP of the application has no function there. */
static void a_sap_of_the_application_that_wants_the_interrupt_is_refused_rs(void)
{
    fma_rsap_activate(40, FDL_ALL, 8, FDL_TO_ISR, 0);
    ask_sap(8, 2, 40, "01 02");
    ANSWERED("10 02 08 03 0D 16");
}

/* The application has taken so many SAPs that none is left for DP. */
static void a_sap_that_cannot_be_activated_is_a_fault(void)
{
    uint8_t i;

    app.faults = 0;
    for (i = 0; i < 12; i++) /* as many as are left beside the four of WAIT_PRM */
        fma_sap_activate(i, FDL_ALL, FDL_SDN, 1, FDL_TO_MAIN);
    ask_sap(8, 2, 61, "80 00 00 0B 12 34 00");
    ask_sap(8, 2, 62, "10 20 10 20");
    TEST_ASSERT_EQUAL(0, app.faults);
    inputs("31 01"); /* four more are needed */
    TEST_ASSERT_EQUAL(4, app.faults);
    TEST_ASSERT_EQUAL(DDLM_RE, app.fault);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(services_at_power_on_without_an_address);
    RUN_TEST(services_in_wait_prm);
    RUN_TEST(services_in_wait_cfg);
    RUN_TEST(services_in_data_exch);
    RUN_TEST(set_slave_add_is_acknowledged_in_every_state_where_the_address_is_not_from_switches);
    RUN_TEST(fdl_status_is_answered_in_every_state);
    RUN_TEST(ident_names_the_device);
    RUN_TEST(the_station_starts_in_wait_prm_with_an_address_and_fail_safe_outputs);
    RUN_TEST(a_second_start_forgets_the_first);
    RUN_TEST(data_for_saps_of_the_application_reach_it);
    RUN_TEST(a_sap_of_the_application_that_wants_the_interrupt_is_refused_rs);
    RUN_TEST(a_sap_that_cannot_be_activated_is_a_fault);
    return UNITY_END();
}
