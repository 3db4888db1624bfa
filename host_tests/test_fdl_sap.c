/* Service access points and REPLY_UPDATE.
 * Clauses: EN 50170-2 part 3, SAP activation, FDL_REPLY_UPDATE (L_status OK, LS, LR, IV); spec A4. */
#include "fdl_unit.h"

void setUp(void)
{
    unit_begin();
}

void tearDown(void)
{
    fake_end();
}

static struct fdl_sap PAGED how = {FDL_ALL, FDL_SRD, 4, FDL_ANSWER_ONLY, 0};

static void saps_0_to_62_and_the_default_sap_can_be_activated(void)
{
    TEST_ASSERT_TRUE(fdl_sap_set(0, &how));
    TEST_ASSERT_TRUE(fdl_sap_set(62, &how));
    TEST_ASSERT_TRUE(fdl_sap_set(FDL_SAP_NIL, &how));
    TEST_ASSERT_FALSE(fdl_sap_set(63, &how));
    TEST_ASSERT_FALSE(fdl_sap_set(65, &how));
    TEST_ASSERT_FALSE(fdl_sap_set(255, &how));
}

static void twelve_saps_are_active_at_once_and_no_more(void)
{
    uint8_t i;

    for (i = 0; i < 12; i++)
        TEST_ASSERT_TRUE(fdl_sap_set(i, &how));
    TEST_ASSERT_FALSE(fdl_sap_set(12, &how));
    TEST_ASSERT_TRUE(fdl_sap_set(11, &how)); /* changed, not added */
    TEST_ASSERT_TRUE(fdl_sap_clear(3));
    TEST_ASSERT_TRUE(fdl_sap_set(12, &how));
    TEST_ASSERT_FALSE(fdl_sap_set(3, &how));
}

static void only_an_active_sap_can_be_deactivated(void)
{
    TEST_ASSERT_FALSE(fdl_sap_clear(10));
    fdl_sap_set(10, &how);
    TEST_ASSERT_TRUE(fdl_sap_clear(10));
    TEST_ASSERT_FALSE(fdl_sap_clear(10));
    TEST_ASSERT_FALSE(fdl_sap_clear(63));
    TEST_ASSERT_FALSE(fdl_sap_clear(255));
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("10 02 08 03 0D 16");
}

static void a_reset_deactivates_every_sap(void)
{
    fdl_sap_set(10, &how);
    fdl_reset(8);
    TEST_ASSERT_FALSE(fdl_sap_clear(10));
}

static void an_update_needs_an_active_sap_with_a_buffer(void)
{
    static uint8_t XDATA lsdu[17];

    TEST_ASSERT_EQUAL(FDL_L_LS, fdl_reply_update(10, lsdu, 1, FDL_UPDATE_LOW));
    fdl_sap_set(10, &how);
    TEST_ASSERT_EQUAL(FDL_L_LS, fdl_reply_update(10, lsdu, 1, FDL_UPDATE_LOW));
    unit_srd_sap(FDL_ANSWER_ONLY);
    TEST_ASSERT_EQUAL(FDL_L_OK, fdl_reply_update(10, lsdu, 0, FDL_UPDATE_LOW));
    TEST_ASSERT_EQUAL(FDL_L_OK, fdl_reply_update(10, lsdu, 16, FDL_UPDATE_HIGH | FDL_UPDATE_SINGLE));
    TEST_ASSERT_EQUAL(FDL_L_LR, fdl_reply_update(10, lsdu, 17, FDL_UPDATE_LOW));
    TEST_ASSERT_EQUAL(FDL_L_IV, fdl_reply_update(10, lsdu, 1, FDL_UPDATE_KEEP));
    TEST_ASSERT_EQUAL(FDL_L_IV, fdl_reply_update(63, lsdu, 1, FDL_UPDATE_LOW));
    TEST_ASSERT_EQUAL(FDL_L_IV, fdl_reply_update(65, lsdu, 1, FDL_UPDATE_LOW));
}

static void transmit_multiple_answers_until_updated_again(void)
{
    unit_srd_sap(FDL_ANSWER_ONLY);
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("E5");
    unit_update(10, "55", FDL_UPDATE_LOW);
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 06 06 68 82 88 08 3E 0A 55 AF 16");
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 06 06 68 82 88 08 3E 0A 55 AF 16");
    unit_update(10, "66", FDL_UPDATE_HIGH);
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 06 06 68 82 88 0A 3E 0A 66 C2 16");
}

static void transmit_single_answers_once(void)
{
    unit_srd_sap(FDL_ANSWER_ONLY);
    unit_update(10, "55", FDL_UPDATE_SINGLE | FDL_UPDATE_HIGH);
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 06 06 68 82 88 0A 3E 0A 55 B1 16");
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("E5");
}

static void ask(void)
{
    fake_at_unlock = 0;
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
}

/* The answer that leaves while an update is written is the old one or the new one. */
static void an_update_is_taken_whole(void)
{
    unit_srd_sap(FDL_ANSWER_ONLY);
    unit_update(10, "55 55", FDL_UPDATE_LOW);
    fake_at_unlock = ask; /* at the first unlock: before the data are copied */
    unit_update(10, "66 66", FDL_UPDATE_LOW);
    ANSWERED("68 07 07 68 82 88 08 3E 0A 55 55 04 16");
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 07 07 68 82 88 08 3E 0A 66 66 26 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(saps_0_to_62_and_the_default_sap_can_be_activated);
    RUN_TEST(twelve_saps_are_active_at_once_and_no_more);
    RUN_TEST(only_an_active_sap_can_be_deactivated);
    RUN_TEST(a_reset_deactivates_every_sap);
    RUN_TEST(an_update_needs_an_active_sap_with_a_buffer);
    RUN_TEST(transmit_multiple_answers_until_updated_again);
    RUN_TEST(transmit_single_answers_once);
    RUN_TEST(an_update_is_taken_whole);
    return UNITY_END();
}
