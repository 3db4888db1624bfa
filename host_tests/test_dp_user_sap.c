/* Spec D2, A4: the application's own service access points on the line, beside DP: SDA, SDN, SRD and CSRD (whose polls
 * are SRD telegrams), REPLY_UPDATE single and multiple, refusals. EN 50170-2 part 3. */
#include "dp_fixture.h"

#include <string.h>

#define SAP_A 10u /* takes SDA and SDN            */
#define SAP_B 11u /* answers SRD from a reply     */
#define OWN   12u /* master 3 only                */

static uint8_t rooms[3][FDL_ROOM(8)];
static struct fdl_reply reply;

static struct {
    unsigned n;
    uint8_t service, ssap, sa, update, len, data[8];
    bool high;
} got;

void ddlm_user_data_ind(const struct fdl_ind XDATA *ind)
{
    got.n++;
    got.service = ind->service;
    got.ssap = ind->ssap;
    got.sa = ind->sa;
    got.high = ind->high;
    got.update = ind->update;
    got.len = ind->len;
    memcpy(got.data, ind->lsdu, ind->len);
}

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
    memset(&got, 0, sizeof got);
    fdl_reply_init(&reply, rooms[0], 8, SAP_B);
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(SAP_A, FDL_ALL, FDL_SDA | FDL_SDN, 4, FDL_TO_MAIN));
    TEST_ASSERT_EQUAL(FMA_OK, fma_rsap_activate(SAP_B, FDL_ALL, 4, FDL_TO_MAIN, &reply));
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_activate(OWN, 3, FDL_SDA, 4, FDL_TO_MAIN));
}

void tearDown(void)
{
}

#define RR_ "10 02 08 02 0C 16"
#define RS_ "10 02 08 03 0D 16"

static void an_SDA_is_acknowledged_and_given_to_the_application_once(void)
{
    ASK("68 07 07 68 88 82 55 0A 3E A1 B2 FA 16", ACK); /* SDA high, FCB 0 FCV 1 */
    ASK("68 07 07 68 88 82 55 0A 3E A1 B2 FA 16", ACK); /* its retry */
    TEST_ASSERT_EQUAL_UINT(1, got.n);
    TEST_ASSERT_EQUAL(FDL_SDA, got.service);
    TEST_ASSERT_TRUE(got.high);
    TEST_ASSERT_EQUAL(62, got.ssap);
    TEST_ASSERT_EQUAL(2, got.sa);
    TEST_ASSERT_EQUAL(2, got.len);
    TEST_ASSERT_EQUAL_HEX8(0xB2, got.data[1]);
    TEST_ASSERT_EQUAL(FDL_UPDATED_NO, got.update);
    ASK("68 05 05 68 88 82 63 0A 3E B5 16", ACK); /* SDA low, no data */
    TEST_ASSERT_FALSE(got.high);
    TEST_ASSERT_EQUAL(0, got.len);
}

static void an_SDN_is_given_to_the_application_and_not_answered(void)
{
    SILENT("68 06 06 68 88 82 44 0A 3E 77 0D 16");
    SILENT("68 06 06 68 FF 82 46 0A 3E 78 87 16"); /* to everybody */
    TEST_ASSERT_EQUAL_UINT(2, got.n);
    TEST_ASSERT_EQUAL_HEX8(0x78, got.data[0]);
}

static void an_SRD_is_answered_from_what_was_updated_before(void)
{
    static const uint8_t data[] = {0x31, 0x32};
    ASK("68 06 06 68 88 82 6D 0B 3E 01 C1 16", ACK); /* nothing yet: no reply data */
    TEST_ASSERT_EQUAL(FDL_UPDATED_NO, got.update);
    TEST_ASSERT_EQUAL(FDL_L_OK, fdl_reply_update(SAP_B, data, 2, FDL_UPDATE_LOW));
    ASK("68 06 06 68 88 82 6D 0B 3E 02 C2 16", "68 07 07 68 82 88 08 3E 0B 31 32 BE 16");
    ASK("68 06 06 68 88 82 6C 0B 3E 03 C2 16",
        "68 07 07 68 82 88 08 3E 0B 31 32 BE 16"); /* multiple: stays */
    TEST_ASSERT_EQUAL_UINT(3, got.n);
    TEST_ASSERT_EQUAL(FDL_UPDATED_LO, got.update);
    TEST_ASSERT_EQUAL(FDL_L_OK, fdl_reply_update(SAP_B, data, 2, FDL_UPDATE_HIGH | FDL_UPDATE_SINGLE));
    ASK("68 05 05 68 88 82 6D 0B 3E C0 16",
        "68 07 07 68 82 88 0A 3E 0B 31 32 C0 16"); /* a CSRD poll: no data */
    TEST_ASSERT_EQUAL(FDL_UPDATED_HI, got.update);
    ASK("68 05 05 68 88 82 6D 0B 3E C0 16", ACK);  /* single: gone */
    TEST_ASSERT_EQUAL(FDL_UPDATED_NO, got.update);
}

static void a_lost_answer_to_a_single_update_is_repeated(void)
{
    static const uint8_t data[] = {0x31};
    TEST_ASSERT_EQUAL(FDL_L_OK, fdl_reply_update(SAP_B, data, 1, FDL_UPDATE_SINGLE));
    ASK("68 05 05 68 88 82 5D 0B 3E B0 16", "68 06 06 68 82 88 08 3E 0B 31 8C 16");
    ASK("68 05 05 68 88 82 5D 0B 3E B0 16", "68 06 06 68 82 88 08 3E 0B 31 8C 16");
}

static void too_long_a_request_is_answered_RR(void)
{
    ASK("68 0A 0A 68 88 82 65 0A 3E 01 02 03 04 05 C6 16", RR_);
    ASK("68 09 09 68 88 82 65 0A 3E 01 02 03 04 C1 16", ACK);
    TEST_ASSERT_EQUAL_UINT(1, got.n);
}

static void when_the_main_loop_does_not_come_RR_asks_the_master_to_wait(void)
{
    hv_set_loop(NULL, NULL);
    for (unsigned i = 0; i < FDL_BOXES; i++)
        ASK("68 05 05 68 88 82 63 0A 3E B5 16", ACK);
    ASK("68 05 05 68 88 82 63 0A 3E B5 16", RR_);
    TEST_ASSERT_EQUAL_UINT(0, got.n);
    hv_set_loop(dp_station_poll, NULL);
    hv_run_for(5 * HV_MS);
    TEST_ASSERT_EQUAL_UINT(FDL_BOXES, got.n);
    ASK("68 05 05 68 88 82 63 0A 3E B5 16", ACK);
}

static void the_wrong_service_or_the_wrong_station_is_answered_RS(void)
{
    ASK("68 05 05 68 88 82 6D 0A 3E BF 16", RS_); /* SRD to a SAP for SDA */
    ASK("68 05 05 68 88 82 65 0B 3E B8 16", RS_); /* SDA to one for SRD */
    ASK("68 05 05 68 88 82 65 0C 3E B9 16", RS_); /* only master 3 may */
    ASK("68 05 05 68 88 83 65 0C 3E BA 16", ACK);
    TEST_ASSERT_EQUAL(FMA_OK, fma_sap_deactivate(SAP_A));
    ASK("68 05 05 68 88 82 65 0A 3E B7 16", RS_);
    TEST_ASSERT_EQUAL_UINT(1, got.n);
}

static void it_goes_on_beside_data_exchange(void)
{
    TO_DATA_EXCH("68 0C 0C 68 88 82 6D 3D 3E 80 01 01 00 12 34 01 BB 16");
    ASK(DX, DX_OK);
    ASK("68 06 06 68 88 83 65 0A 3E 55 0D 16", ACK);
    ASK(DX, DX_OK);
    TEST_ASSERT_EQUAL_HEX8(0x55, got.data[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(an_SDA_is_acknowledged_and_given_to_the_application_once);
    RUN_TEST(an_SDN_is_given_to_the_application_and_not_answered);
    RUN_TEST(an_SRD_is_answered_from_what_was_updated_before);
    RUN_TEST(a_lost_answer_to_a_single_update_is_repeated);
    RUN_TEST(too_long_a_request_is_answered_RR);
    RUN_TEST(when_the_main_loop_does_not_come_RR_asks_the_master_to_wait);
    RUN_TEST(the_wrong_service_or_the_wrong_station_is_answered_RS);
    RUN_TEST(it_goes_on_beside_data_exchange);
    return UNITY_END();
}
