/* T19 - T25: frame count bit, retries, and services on SAPs. Rules: EN 50170-2 part 4, 4.1.3; facts 3.3 and
 * 0.4. */
#include "dp_fixture.h"

#include <string.h>

void setUp(void)
{
    dp_begin(8, PHY_BAUD_19K2);
}

void tearDown(void)
{
}

/* Data_Exchange from master 2 with outputs 11 22 / 33 44 under the three FCs of a sequence */
#define FIRST      "68 05 05 68 08 02 6D 11 22 AA 16" /* FCB 1 FCV 0 */
#define NEXT_0     "68 05 05 68 08 02 5D 33 44 DE 16" /* FCB 0 FCV 1 */
#define NEXT_1     "68 05 05 68 08 02 7D 33 44 FE 16" /* FCB 1 FCV 1 */
#define NEXT_0_NEW "68 05 05 68 08 02 5D 55 66 22 16"

static unsigned executed(void)
{
    static struct ddlm_counters c;
    ddlm_read_counters(&c);
    return c.data_exchange;
}

static void T19_the_first_request_with_FCV_0_is_executed_each_time(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(FIRST, DX_OK);
    TEST_ASSERT_EQUAL_UINT(2, executed());
}

static void T20_a_toggled_FCB_is_a_new_request(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(NEXT_0, DX_OK);
    ASK(NEXT_1, DX_OK);
    ASK(NEXT_0, DX_OK);
    TEST_ASSERT_EQUAL_UINT(4, executed());
    OUTPUTS(0x33, 0x44);
}

static void T21_a_retry_is_answered_from_store_and_not_executed_again(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(NEXT_0, DX_OK);
    const unsigned outs = dp_outs;
    dp_in[0] = 0x21;
    hv_run_for(10 * HV_MS);
    ASK(NEXT_0, DX_OK); /* the inputs of the first time, octet for octet */
    ASK(NEXT_0, DX_OK);
    TEST_ASSERT_EQUAL_UINT(2, executed());
    TEST_ASSERT_EQUAL_UINT(outs, dp_outs);
    ASK(NEXT_1, "68 05 05 68 02 08 08 21 00 33 16");
}

static void T21_a_retry_of_the_first_request_after_FCV_0_is_one_only_with_FCV(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(NEXT_1, DX_OK); /* FCB 1 as before, but not the same frame: new */
    TEST_ASSERT_EQUAL_UINT(2, executed());
}

static void T21_the_same_FCB_with_other_data_is_a_new_request(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(NEXT_0, DX_OK);
    ASK(NEXT_0_NEW, DX_OK);
    TEST_ASSERT_EQUAL_UINT(3, executed());
    OUTPUTS(0x55, 0x66);
}

static void T21_a_retried_refusal_is_repeated(void)
{
    ASK("68 05 05 68 08 02 5D 33 44 DE 16", "10 02 08 03 0D 16");
    ASK("68 05 05 68 08 02 5D 33 44 DE 16", "10 02 08 03 0D 16");
}

static void T21_an_FDL_status_or_a_broadcast_in_between_does_not_end_the_retry(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(NEXT_0, DX_OK);
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
    SILENT("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16"); /* Global_Control: Operate */
    SILENT("68 05 05 68 09 02 5D 33 44 DF 16");       /* the next station's */
    ASK(NEXT_0, DX_OK);
    TEST_ASSERT_EQUAL_UINT(2, executed());
}

static void T22_the_same_frame_from_another_master_is_no_retry(void)
{
    /* Slave_Diag under FCB 0 FCV 1 from master 2, then from master 3; both are answered to themselves */
    ASK("68 05 05 68 88 82 5D 3C 3E E1 16", "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
    ASK("68 05 05 68 88 83 5D 3C 3E E2 16", "68 0B 0B 68 83 88 08 3E 3C 02 05 00 FF 12 34 D9 16");
    struct fdl_counters c;
    fdl_read_counters(&c);
    TEST_ASSERT_EQUAL_UINT(0, c.retries);
}

static void T23_after_power_up_nothing_is_a_retry(void)
{
    TO_DATA_EXCH(SET_PRM);
    ASK(FIRST, DX_OK);
    ASK(NEXT_0, DX_OK);
    dp_power_cycle();
    ASK(NEXT_0, "10 02 08 03 0D 16"); /* RS: not in DATA_EXCH; the old answer is gone */
}

/* ---- T24: each Data_Exchange exactly once ---------------------------------------------------------------- */

/* The master numbers its outputs and checks that the application was given every number that the master knows
 * to have arrived, in order, and none twice. A number whose answer was lost for good may have been executed
 * or not. */
static struct model {
    struct bus_master bus;
    struct dp_slave slave;
    uint16_t number; /* of the outputs now being sent */
    unsigned confirmed;
    uint16_t last_seen;
    unsigned seen, wrong_order;
} model;

/* 1..65535 and again: 0 is the fail-safe state */
static uint16_t follows(uint16_t number)
{
    return number == 0xFFFF ? 1 : (uint16_t)(number + 1);
}

static void number_outputs(struct dp_master *m, struct dp_slave *s)
{
    (void)m;
    model.number = follows(model.number);
    s->outputs[0] = (uint8_t)(model.number >> 8);
    s->outputs[1] = (uint8_t)model.number;
}

static void confirm(struct dp_master *m, struct dp_slave *s)
{
    (void)m;
    (void)s;
    model.confirmed++;
}

/* After each pass of the main loop: did it get the next number? */
static void watching_loop(void)
{
    const unsigned outs = dp_outs;
    dp_station_poll();
    if (dp_outs == outs)
        return;
    const uint16_t number = (uint16_t)(dp_out[0] << 8 | dp_out[1]);
    if (number == 0)
        return; /* fail-safe */
    model.wrong_order += number != follows(model.last_seen);
    model.last_seen = number;
    model.seen++;
}

static void give_the_master(struct dp_slave *s)
{
    static const uint8_t cfg[] = {0x10, 0x20, 0x10, 0x20};
    *s = (struct dp_slave){.address = 8,
                           .ident = 0x1234,
                           .station_status = 0x80,
                           .wd1 = 1,
                           .wd2 = 1,
                           .min_t_sdr = 11,
                           .group = 1,
                           .cfg_n = 4,
                           .out_n = 2,
                           .in_n = 2};
    memcpy(s->cfg, cfg, sizeof cfg);
}

/* Requests and answers get lost and damaged, every third telegram of either; the master retries up to 30
 * times so that no slave is given up: then the model is exact. */
static void T24_each_Data_Exchange_is_executed_exactly_once_whatever_gets_lost(void)
{
    static const enum flt kinds[] = {FLT_LOST_REQUEST, FLT_LOST_ANSWER, FLT_ANSWER_BIT, FLT_ONE_BIT};
    const unsigned telegrams = dp_count(4000, 100000);
    struct fdl_counters c;
    unsigned sent = 0, lost_answers = 0;
    memset(&model, 0, sizeof model);
    dp_begin_at(8, PHY_BAUD_500K, 500000);
    give_the_master(&model.slave);
    model.bus.dp =
        (struct dp_master){.slaves = &model.slave, .slaves_n = 1, .before = number_outputs, .after = confirm};
    model.bus.dp.ini.address = 2;
    model.bus.dp.ini.retries = 30;
    bus_attach(&model.bus);
    hv_set_loop(watching_loop, NULL);
    for (unsigned i = 0; sent < telegrams; i++) {
        bus_fault(kinds[i % 4], 3, i + 1);
        hv_run_for(50 * HV_MS);
        sent = model.bus.dp.ini.sent;
        lost_answers += bus_faults();
    }
    bus_fault(FLT_NONE, 1, 1);
    hv_run_for(5 * HV_MS);
    fdl_read_counters(&c);
    const char *const verdict = seg_verdict();
    TEST_ASSERT_NULL_MESSAGE(verdict, verdict);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, model.wrong_order, "left out, doubled or out of order");
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, model.slave.starts, "never lost");
    TEST_ASSERT_UINT_WITHIN_MESSAGE(1, model.confirmed, model.seen, "the last one may be on its way");
    TEST_ASSERT_EQUAL_UINT16((uint16_t)model.confirmed, (uint16_t)model.slave.exchanges);
    TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(telegrams / 8, lost_answers, "faults did happen");
    TEST_ASSERT_GREATER_THAN_UINT16_MESSAGE(0, c.retries, "retries did happen");
}

/* ---- T25: SAPs ------------------------------------------------------------------------------------------- */

static void T25_an_SRD_or_SDA_to_a_SAP_that_is_not_active_is_answered_RS(void)
{
    for (uint8_t sap = 0; sap <= 62; sap++) {
        uint8_t request[] = {0x68, 0x05, 0x05, 0x68, 0x88, 0x82, 0x6D, sap, 0x3E, (uint8_t)(0xB5 + sap),
                             0x16};
        if (sap >= 59) /* Get_Cfg, Slave_Diag, Set_Prm, Chk_Cfg are active */
            break;
        TEST_ASSERT_EQUAL_UINT(6, dp_ask_octets(request, sizeof request, __LINE__));
        TEST_ASSERT_EQUAL_HEX8(0x03, seg_said.octets[3]);
    }
    ASK("68 05 05 68 88 82 63 0B 3E B6 16", "10 02 08 03 0D 16"); /* SDA low to SAP 11 */
    ASK("68 05 05 68 88 82 65 0B 3E B8 16", "10 02 08 03 0D 16"); /* SDA high */
    ASK("68 05 05 68 88 82 6D 3F 3E F4 16", "10 02 08 03 0D 16"); /* SRD to 63, global access */
}

static void T25_an_SDN_is_never_answered(void)
{
    SILENT("68 05 05 68 88 82 44 0B 3E 97 16");
    SILENT("68 07 07 68 88 82 46 3A 3E 00 00 C8 16");
    SILENT("68 05 05 68 88 82 44 3C 3E C8 16"); /* SDN to Slave_Diag: an SRD service */
}

static void T25_SRD_of_either_priority_is_taken(void)
{
    ASK("68 05 05 68 88 82 6C 3C 3E F0 16", "68 0B 0B 68 82 88 08 3E 3C 02 05 00 FF 12 34 D8 16");
    ASK("68 05 05 68 88 82 6C 3B 3E EF 16", "68 09 09 68 82 88 08 3E 3B 10 20 10 20 EB 16");
}

static void T25_SDA_to_a_SAP_without_SDA_is_answered_RS(void)
{
    ASK("68 05 05 68 88 82 65 3C 3E E9 16", "10 02 08 03 0D 16");
}

static void T25_functions_a_responder_does_not_know_get_no_answer(void)
{
    SILENT("10 08 02 40 4A 16"); /* 0: time event */
    SILENT("10 08 02 47 51 16"); /* 7: multicast SRD, DP-V2 */
    SILENT("10 08 02 4A 54 16");
    SILENT("10 08 02 4B 55 16");
    SILENT("10 08 02 C9 D3 16"); /* bit 7 reserved */
    ASK("10 08 02 49 53 16", "10 02 08 00 0A 16");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(T19_the_first_request_with_FCV_0_is_executed_each_time);
    RUN_TEST(T20_a_toggled_FCB_is_a_new_request);
    RUN_TEST(T21_a_retry_is_answered_from_store_and_not_executed_again);
    RUN_TEST(T21_a_retry_of_the_first_request_after_FCV_0_is_one_only_with_FCV);
    RUN_TEST(T21_the_same_FCB_with_other_data_is_a_new_request);
    RUN_TEST(T21_a_retried_refusal_is_repeated);
    RUN_TEST(T21_an_FDL_status_or_a_broadcast_in_between_does_not_end_the_retry);
    RUN_TEST(T22_the_same_frame_from_another_master_is_no_retry);
    RUN_TEST(T23_after_power_up_nothing_is_a_retry);
    RUN_TEST(T24_each_Data_Exchange_is_executed_exactly_once_whatever_gets_lost);
    RUN_TEST(T25_an_SRD_or_SDA_to_a_SAP_that_is_not_active_is_answered_RS);
    RUN_TEST(T25_an_SDN_is_never_answered);
    RUN_TEST(T25_SRD_of_either_priority_is_taken);
    RUN_TEST(T25_SDA_to_a_SAP_without_SDA_is_answered_RS);
    RUN_TEST(T25_functions_a_responder_does_not_know_get_no_answer);
    return UNITY_END();
}
