/* Set_Slave_Add: the address a master gives, and what of it survives power-down.
 * Clause: EN 50170-2 part 8, Set_Slave_Add; spec A6; facts 3.12.
 * 1 New_Slave_Add 0..125; 2, 3 ident; 4 No_Add_Chg; 5... Rem_Slave_Data. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(126);
    app.faults = 0;
}

void tearDown(void)
{
    fake_end();
}

#define SET_ADDRESS(station, du) ask_sap(station, 2, 55, du)
#define STATUS_126 "10 7E 02 49 C9 16"

/* Power off and on; the memory keeps. */
static void power_cycle(uint8_t switches)
{
    fake.masked = true;
    ddlm_slave_init(switches, 1);
    fake.masked = false;
}

static void without_an_address_the_station_answers_as_126_and_waits(void)
{
    STATE(DDLM_POWER_ON);
    INFO(126, address);
    request(STATUS_126);
    ANSWERED("10 02 7E 00 80 16");
    DIAG("02 05 00 FF 12 34");
    ask_sap(126, 2, 61, "80 00 00 0B 12 34 00");
    ANSWERED("10 02 7E 03 83 16"); /* RS */
    STATE(DDLM_POWER_ON);
}

static void the_new_address_counts_at_once_and_parameters_are_awaited(void)
{
    SET_ADDRESS(126, "08 12 34 00");
    ANSWERED("E5");
    STATE(DDLM_WAIT_PRM);
    INFO(8, address);
    INFO(false, address_locked);
    request(STATUS_126);
    NOT_ANSWERED();
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
    DIAG("02 05 00 FF 12 34");
}

static void the_acknowledge_still_leaves_from_the_old_address(void)
{
    request("68 09 09 68 FE 82 6D 37 3E 08 12 34 00 B0 16");
    ANSWERED("E5");
    request(STATUS_126);
    ANSWERED("10 02 7E 00 80 16"); /* the main loop has not come round yet */
    turn();
    request(STATUS_126);
    NOT_ANSWERED();
}

static void the_address_survives_power_down(void)
{
    SET_ADDRESS(126, "08 12 34 00");
    power_cycle(126);
    STATE(DDLM_WAIT_PRM);
    INFO(8, address);
}

static void addresses_0_and_125_are_the_first_and_the_last(void)
{
    SET_ADDRESS(126, "00 12 34 00");
    INFO(0, address);
    SET_ADDRESS(0, "7D 12 34 00");
    INFO(125, address);
    power_cycle(126);
    INFO(125, address);
}

/* Acknowledged and not processed. */
static void not_processed(void)
{
    ANSWERED("E5");
    STATE(DDLM_POWER_ON);
    INFO(126, address);
    COUNTED(1, not_processed);
    power_cycle(126);
    INFO(126, address);
}

static void address_126_is_none(void)
{
    SET_ADDRESS(126, "7E 12 34 00");
    not_processed();
}

static void address_255_is_none(void)
{
    SET_ADDRESS(126, "FF 12 34 00");
    not_processed();
}

static void a_wrong_ident_is_another_device(void)
{
    SET_ADDRESS(126, "08 12 35 00");
    not_processed();
}

static void three_octets_are_too_few(void)
{
    SET_ADDRESS(126, "08 12 34");
    not_processed();
}

static void remaining_slave_data_are_taken_and_not_used(void)
{
    SET_ADDRESS(126, "08 12 34 00 AA BB CC");
    INFO(8, address);
}

static void it_may_be_changed_while_parameters_are_awaited_and_not_later(void)
{
    SET_ADDRESS(126, "08 12 34 00");
    SET_ADDRESS(8, "09 12 34 00");
    INFO(9, address);
    SET_ADDRESS(9, "08 12 34 00");
    INFO(8, address);
    to_wait_cfg();
    SET_ADDRESS(8, "09 12 34 00");
    ANSWERED("E5");
    INFO(8, address);
    COUNTED(1, not_processed);
    to_data_exch();
    SET_ADDRESS(8, "09 12 34 00");
    INFO(8, address);
    STATE(DDLM_DATA_EXCH);
    COUNTED(2, not_processed);
}

static void no_add_chg_forbids_further_changes_for_ever(void)
{
    SET_ADDRESS(126, "08 12 34 01");
    INFO(true, address_locked);
    SET_ADDRESS(8, "09 12 34 00");
    INFO(8, address);
    COUNTED(1, not_processed);
    power_cycle(126);
    INFO(8, address);
    INFO(true, address_locked);
    SET_ADDRESS(8, "09 12 34 00");
    INFO(8, address);
}

static void any_value_but_0_is_no_add_chg(void)
{
    SET_ADDRESS(126, "08 12 34 80");
    INFO(true, address_locked);
}

static void a_factory_reset_forgets_address_and_lock(void)
{
    SET_ADDRESS(126, "08 12 34 01");
    TEST_ASSERT_TRUE(ddlm_factory_reset());
    INFO(8, address); /* until the next start */
    power_cycle(126);
    INFO(126, address);
    INFO(false, address_locked);
    STATE(DDLM_POWER_ON);
    SET_ADDRESS(126, "09 12 34 00");
    INFO(9, address);
}

static void a_factory_reset_of_a_memory_that_does_not_store_says_so(void)
{
    fake.nv_writes = 0;
    TEST_ASSERT_FALSE(ddlm_factory_reset());
    fake.nv_writes = 1;
    TEST_ASSERT_FALSE(ddlm_factory_reset());
    fake.nv_writes = 2;
    TEST_ASSERT_FALSE(ddlm_factory_reset());
}

static void a_memory_that_does_not_store_is_a_fault_and_the_old_address_stays(void)
{
    fake.nv_writes = 0;
    SET_ADDRESS(126, "08 12 34 00");
    ANSWERED("E5");
    INFO(126, address);
    TEST_ASSERT_EQUAL(1, app.faults);
    TEST_ASSERT_EQUAL(DDLM_NO, app.fault);
}

/* Power fails after each cell: then there is the new address or none, never another. */
static void a_power_failure_while_storing_leaves_no_address_rather_than_a_wrong_one(void)
{
    uint8_t writes;

    for (writes = 0; writes < 4; writes++) {
        SET_ADDRESS(126, "08 12 34 00");
        INFO(8, address);
        fake.nv_writes = writes;
        SET_ADDRESS(8, "09 12 34 01");
        fake.nv_writes = FAKE_NV_UNLIMITED;
        power_cycle(126);
        INFO(writes == 0 ? 8 : 126, address);
        INFO(false, address_locked);
        ddlm_factory_reset();
        power_cycle(126);
    }
}

static void memory_that_was_never_written_or_is_garbage_holds_no_address(void)
{
    fake.nv[0] = 0x08;
    fake.nv[1] = 0x08;
    power_cycle(126);
    INFO(126, address);
    fake.nv[0] = 0x7E; /* 126 with a right complement */
    fake.nv[1] = 0x81;
    power_cycle(126);
    INFO(126, address);
    fake.nv[0] = 0;
    fake.nv[1] = 0;
    fake.nv[2] = 0x5A;
    power_cycle(126);
    INFO(126, address);
    INFO(false, address_locked);
}

static void with_an_address_from_switches_the_service_is_refused_rs(void)
{
    SET_ADDRESS(126, "08 12 34 01");
    power_cycle(5);
    INFO(5, address);
    INFO(false, address_locked);
    SET_ADDRESS(5, "09 12 34 00");
    ANSWERED("10 02 05 03 0A 16");
    INFO(5, address);
    power_cycle(126);
    INFO(8, address);
}

static void the_owner_may_take_the_station_at_its_new_address(void)
{
    SET_ADDRESS(126, "08 12 34 00");
    to_data_exch();
    request("68 05 05 68 08 02 6D 01 02 7A 16");
    ANSWERED("68 05 05 68 02 08 08 31 01 44 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(without_an_address_the_station_answers_as_126_and_waits);
    RUN_TEST(the_new_address_counts_at_once_and_parameters_are_awaited);
    RUN_TEST(the_acknowledge_still_leaves_from_the_old_address);
    RUN_TEST(the_address_survives_power_down);
    RUN_TEST(addresses_0_and_125_are_the_first_and_the_last);
    RUN_TEST(address_126_is_none);
    RUN_TEST(address_255_is_none);
    RUN_TEST(a_wrong_ident_is_another_device);
    RUN_TEST(three_octets_are_too_few);
    RUN_TEST(remaining_slave_data_are_taken_and_not_used);
    RUN_TEST(it_may_be_changed_while_parameters_are_awaited_and_not_later);
    RUN_TEST(no_add_chg_forbids_further_changes_for_ever);
    RUN_TEST(any_value_but_0_is_no_add_chg);
    RUN_TEST(a_factory_reset_forgets_address_and_lock);
    RUN_TEST(a_factory_reset_of_a_memory_that_does_not_store_says_so);
    RUN_TEST(a_memory_that_does_not_store_is_a_fault_and_the_old_address_stays);
    RUN_TEST(a_power_failure_while_storing_leaves_no_address_rather_than_a_wrong_one);
    RUN_TEST(memory_that_was_never_written_or_is_garbage_holds_no_address);
    RUN_TEST(with_an_address_from_switches_the_service_is_refused_rs);
    RUN_TEST(the_owner_may_take_the_station_at_its_new_address);
    return UNITY_END();
}
