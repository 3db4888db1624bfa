/* The responder: who is meant, which service, which SAP, what answer.
 * Clauses: EN 50170-2 part 4, 4.7.3 (addresses), 4.7.4 (FC), 4.1.3 (answers of the responder); spec A3, A4, D2.
 * Station 8, asked by station 2: FC 4C SRD low, 4D SRD high, 44/46 SDN, 43/45 SDA, FCB and FCV 0. */
#include "fdl_unit.h"

void setUp(void)
{
    unit_begin();
}

void tearDown(void)
{
    fake_end();
}

/* ---- FDL status ---- */

static void fdl_status_is_answered_ok_by_a_slave(void)
{
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
    COUNTED(1, requests);
    COUNTED(1, answers);
}

static void every_station_that_asks_is_answered_by_its_address(void)
{
    request("10 08 7E 49 CF 16");
    ANSWERED("10 7E 08 00 86 16");
    request("10 08 00 49 51 16");
    ANSWERED("10 00 08 00 08 16");
}

static void the_answer_leaves_from_the_address_that_is_set(void)
{
    fma_set_value(FMA_TS, 126);
    request("10 08 02 49 53 16");
    NOT_ANSWERED();
    request("10 7E 02 49 C9 16");
    ANSWERED("10 02 7E 00 80 16");
}

/* ---- who is meant ---- */

static void telegrams_for_others_are_heard_and_not_answered(void)
{
    unit_default_sap(FDL_TO_MAIN);
    request("10 09 02 49 54 16");
    NOT_ANSWERED();
    request("68 05 05 68 07 02 4D 11 22 89 16");
    NOT_ANSWERED();
    request("A2 09 02 4D 01 02 03 04 05 06 07 08 7C 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
    COUNTED(3, foreign);
    COUNTED(0, requests);
}

static void answers_of_others_and_tokens_are_not_answered(void)
{
    request("10 02 09 00 0B 16");
    NOT_ANSWERED();
    request("E5");
    NOT_ANSWERED();
    request("DC 08 02");
    NOT_ANSWERED();
    COUNTED(3, foreign);
}

static void an_answer_sent_to_us_is_no_request(void)
{
    request("10 08 02 00 0A 16");
    NOT_ANSWERED();
    COUNTED(1, foreign);
}

static void a_broadcast_sdn_is_indicated_and_not_answered(void)
{
    fma_sap_activate(58, FDL_ALL, FDL_SDN, 2, FDL_TO_MAIN);
    request("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
    TEST_ASSERT_EQUAL(58, ind.last.dsap);
    COUNTED(1, requests);
}

static void a_broadcast_that_wants_an_answer_is_a_format_error(void)
{
    unit_default_sap(FDL_TO_MAIN);
    request("10 7F 02 49 CA 16");
    NOT_ANSWERED();
    request("68 05 05 68 7F 02 4D 11 22 01 16");
    NOT_ANSWERED();
    request("68 05 05 68 7F 02 45 11 22 F9 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
    COUNTED(3, format);
    COUNTED(0, requests);
}

/* 127 is the global address: nobody sends from it, and as an owner it would be everybody. */
static void a_request_from_the_global_address_is_a_format_error(void)
{
    unit_default_sap(FDL_TO_MAIN);
    request("68 05 05 68 08 7F 4D 11 22 07 16");
    NOT_ANSWERED();
    request("10 08 7F 49 D0 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
    COUNTED(2, format);
}

static void the_reserved_bit_of_fc_is_a_format_error(void)
{
    request("10 08 02 C9 D3 16");
    NOT_ANSWERED();
    COUNTED(1, format);
    COUNTED(0, requests);
}

static void functions_a_responder_does_not_know_are_not_answered(void)
{
    unit_default_sap(FDL_TO_MAIN);
    request("10 08 02 40 4A 16"); /* 0 */
    request("10 08 02 41 4B 16");
    request("10 08 02 42 4C 16");
    request("10 08 02 47 51 16"); /* 7: reserved, request diagnostic data */
    request("10 08 02 48 52 16");
    request("10 08 02 4A 54 16");
    request("10 08 02 4B 55 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
    TEST_ASSERT_EQUAL(0, fake.sends);
    COUNTED(7, format);
}

/* ---- address extension ---- */

static void saps_stand_behind_fc_destination_first(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    request("68 07 07 68 88 82 4D 0A 3E 11 22 D2 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(10, ind.last.dsap);
    TEST_ASSERT_EQUAL(62, ind.last.ssap);
    TEST_ASSERT_EQUAL(2, ind.last.sa);
    TEST_ASSERT_EQUAL(2, ind.last.len);
    OCTETS("11 22", ind.lsdu, 2);
}

static void without_extension_the_default_sap_is_meant(void)
{
    unit_default_sap(FDL_TO_MAIN);
    request("68 05 05 68 08 02 4D 11 22 8A 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(FDL_SAP_NIL, ind.last.dsap);
    TEST_ASSERT_EQUAL(FDL_SAP_NIL, ind.last.ssap);
    OCTETS("11 22", ind.lsdu, 2);
}

static void either_sap_may_stand_alone(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    unit_default_sap(FDL_TO_MAIN);
    request("68 05 05 68 88 02 4D 0A 11 F2 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(10, ind.last.dsap);
    TEST_ASSERT_EQUAL(FDL_SAP_NIL, ind.last.ssap);
    request("68 05 05 68 08 82 4D 0A 11 F2 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(FDL_SAP_NIL, ind.last.dsap);
    TEST_ASSERT_EQUAL(10, ind.last.ssap);
    TEST_ASSERT_EQUAL(1, ind.last.len);
    TEST_ASSERT_EQUAL(2, ind.count);
}

static void sd3_carries_saps_among_its_eight_octets(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    request("A2 88 82 4D 0A 3E 01 02 03 04 05 06 B4 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(6, ind.last.len);
    OCTETS("01 02 03 04 05 06", ind.lsdu, 6);
}

static void announced_saps_that_are_not_there_are_a_format_error(void)
{
    request("10 88 02 4D D7 16");
    request("10 08 82 4D D7 16");
    request("68 04 04 68 88 82 4D 0A 61 16"); /* DAE and no SAE */
    request("10 88 2B 4D 00 16"); /* the FCS would be a SAP */
    request("68 04 04 68 88 FE 4D 2D 00 16");
    TEST_ASSERT_EQUAL(0, fake.sends);
    COUNTED(5, format);
}

/* Bit 7 another extension octet, bit 6 region or segment address. */
static void extensions_other_than_saps_are_a_format_error(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    request("68 05 05 68 88 82 4D 8A 3E 1F 16");
    request("68 05 05 68 88 82 4D 4A 3E DF 16");
    request("68 05 05 68 88 82 4D 0A BE 1F 16");
    request("68 05 05 68 88 82 4D 0A 7E DF 16");
    TEST_ASSERT_EQUAL(0, fake.sends);
    COUNTED(4, format);
}

/* ---- services ---- */

static void both_priorities_of_srd_are_answered(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    unit_update(10, "AB", FDL_UPDATE_LOW);
    request("68 05 05 68 88 82 4C 0A 3E 9E 16");
    ANSWERED("68 06 06 68 82 88 08 3E 0A AB 05 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(FDL_SRD, ind.last.service);
    TEST_ASSERT_FALSE(ind.last.high);
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 06 06 68 82 88 08 3E 0A AB 05 16");
    fdl_poll();
    TEST_ASSERT_TRUE(ind.last.high);
}

static void both_priorities_of_sdn_are_indicated_and_not_answered(void)
{
    fma_sap_activate(20, FDL_ALL, FDL_SDN, 4, FDL_TO_MAIN);
    request("68 06 06 68 88 82 44 14 3E 01 A1 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(FDL_SDN, ind.last.service);
    TEST_ASSERT_FALSE(ind.last.high);
    request("68 06 06 68 88 82 46 14 3E 02 A4 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(2, ind.count);
    TEST_ASSERT_TRUE(ind.last.high);
}

static void both_priorities_of_sda_are_acknowledged_with_sc(void)
{
    fma_sap_activate(20, FDL_ALL, FDL_SDA | FDL_SDN, 4, FDL_TO_MAIN);
    request("68 06 06 68 88 82 43 14 3E 01 A0 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(FDL_SDA, ind.last.service);
    TEST_ASSERT_FALSE(ind.last.high);
    request("68 06 06 68 88 82 45 14 3E 02 A3 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(2, ind.count);
    TEST_ASSERT_TRUE(ind.last.high);
}

/* CSRD polls with SRD telegrams without data. */
static void a_poll_without_data_is_answered_from_the_buffer(void)
{
    unit_default_sap(FDL_ANSWER_ONLY);
    unit_update(FDL_SAP_NIL, "01 02", FDL_UPDATE_LOW);
    request("10 08 02 4D 57 16");
    ANSWERED("68 05 05 68 02 08 08 01 02 15 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
}

static void an_srd_sap_without_a_buffer_answers_sc(void)
{
    fma_rsap_activate(20, FDL_ALL, 4, FDL_TO_MAIN, 0);
    request("68 06 06 68 88 82 4D 14 3E 01 AA 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
}

/* ---- refusals ---- */

static void a_sap_that_is_not_active_is_refused_rs(void)
{
    request("68 05 05 68 88 82 6D 3C 3E F1 16");
    ANSWERED("10 02 08 03 0D 16");
    request("10 08 02 4D 57 16");
    ANSWERED("10 02 08 03 0D 16");
    request("68 05 05 68 88 82 4D 3F 3E D4 16"); /* 63: the global access address */
    ANSWERED("10 02 08 03 0D 16");
    request("68 06 06 68 88 82 43 14 3E 01 A0 16");
    ANSWERED("10 02 08 03 0D 16");
    COUNTED(4, refused);
}

static void an_sdn_to_a_sap_that_is_not_active_is_dropped(void)
{
    request("68 06 06 68 88 82 44 14 3E 01 A1 16");
    NOT_ANSWERED();
    COUNTED(0, refused);
    COUNTED(1, requests);
}

static void a_service_the_sap_does_not_offer_is_refused_rs(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    fma_sap_activate(20, FDL_ALL, FDL_SDN, 4, FDL_TO_MAIN);
    request("68 06 06 68 88 82 43 0A 3E 01 96 16"); /* SDA to an SRD SAP */
    ANSWERED("10 02 08 03 0D 16");
    request("68 06 06 68 88 82 4C 14 3E 01 A9 16"); /* SRD to an SDN SAP */
    ANSWERED("10 02 08 03 0D 16");
    request("68 06 06 68 88 82 44 0A 3E 01 97 16"); /* SDN to an SRD SAP */
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(0, ind.count);
}

static void a_station_without_access_is_refused_rs(void)
{
    fma_rsap_activate(10, 3, 16, FDL_TO_MAIN, 0);
    request("68 06 06 68 88 82 4D 0A 3E 01 A0 16");
    ANSWERED("10 02 08 03 0D 16");
    request("68 06 06 68 88 83 4D 0A 3E 01 A1 16");
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
    TEST_ASSERT_EQUAL(3, ind.last.sa);
}

static void more_data_than_the_sap_takes_are_refused_rr(void)
{
    fma_rsap_activate(20, FDL_ALL, 2, FDL_TO_MAIN, 0);
    request("68 07 07 68 88 82 4D 14 3E 01 02 AC 16");
    ANSWERED("E5");
    request("68 08 08 68 88 82 4D 14 3E 01 02 03 AF 16");
    ANSWERED("10 02 08 02 0C 16");
    COUNTED(1, refused);
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
}

static void a_sap_for_requests_without_data_refuses_data_rr(void)
{
    fma_rsap_activate(20, FDL_ALL, 0, FDL_ANSWER_ONLY, 0);
    request("68 05 05 68 88 82 4D 14 3E A9 16");
    ANSWERED("E5");
    request("68 06 06 68 88 82 4D 14 3E 01 AA 16");
    ANSWERED("10 02 08 02 0C 16");
}

static void what_the_layer_above_refuses_at_once_is_refused_so(void)
{
    unit_srd_sap(FDL_TO_ISR);
    unit_update(10, "AB", FDL_UPDATE_LOW);
    isr.result = FDL_RS;
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("10 02 08 03 0D 16");
    isr.result = FDL_RR;
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("10 02 08 02 0C 16");
    isr.result = FDL_UE;
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("10 02 08 01 0B 16");
    isr.result = FDL_OK;
    request("68 05 05 68 88 82 4D 0A 3E 9F 16");
    ANSWERED("68 06 06 68 82 88 08 3E 0A AB 05 16");
    TEST_ASSERT_EQUAL(4, isr.count);
    COUNTED(3, refused);
}

/* ---- boxes ---- */

static void ask_10(uint8_t n)
{
    fake.sent_len = 0;
    fake_silence();
    hear("68 06 06 68 88 82 4D 0A 3E");
    fake_octet(n, 0);
    fake_octet((uint8_t)(0x9F + n), 0); /* 88 + 82 + 4D + 0A + 3E = 19F */
    fake_octet(0x16, 0);
    finish_request();
}

static void three_indications_wait_and_the_fourth_is_refused_rr(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    ask_10(1);
    ANSWERED("E5");
    ask_10(2);
    ANSWERED("E5");
    ask_10(3);
    ANSWERED("E5");
    ask_10(4);
    ANSWERED("10 02 08 02 0C 16");
    fdl_poll();
    TEST_ASSERT_EQUAL(3, ind.count);
    OCTETS("03", ind.lsdu, 1);
    ask_10(5);
    ANSWERED("E5");
    fdl_poll();
    TEST_ASSERT_EQUAL(4, ind.count);
    OCTETS("05", ind.lsdu, 1);
}

static void an_sdn_without_a_free_box_is_lost_as_the_service_allows(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    fma_sap_activate(20, FDL_ALL, FDL_SDN, 4, FDL_TO_MAIN);
    ask_10(1);
    ask_10(2);
    ask_10(3);
    request("68 06 06 68 88 82 44 14 3E 01 A1 16");
    NOT_ANSWERED();
    fdl_poll();
    TEST_ASSERT_EQUAL(3, ind.count);
}

static void boxes_turn_many_times_without_losing_one(void)
{
    uint8_t i;

    unit_srd_sap(FDL_TO_MAIN);
    for (i = 0; i < 50; i++) {
        ask_10(i);
        ask_10((uint8_t)(i + 100));
        fdl_poll();
        TEST_ASSERT_EQUAL(2 * (i + 1), ind.count);
        TEST_ASSERT_EQUAL(i + 100, ind.lsdu[0]);
    }
}

static void a_request_comes_in_while_the_last_is_being_handed_over(void)
{
    ask_10(9);
    fake_at_unlock = 0;
}

/* Bounded: a master that asks at every moment does not keep the main loop in fdl_poll(). */
static void fdl_poll_hands_over_what_waited_when_it_was_called(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    ask_10(1);
    fake_at_unlock = a_request_comes_in_while_the_last_is_being_handed_over;
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
    fdl_poll();
    TEST_ASSERT_EQUAL(2, ind.count);
    OCTETS("09", ind.lsdu, 1);
}

static void what_waits_is_known_in_the_interrupt_by_sap_and_station(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    TEST_ASSERT_FALSE(fdl_waiting_isr(10));
    ask_10(1);
    TEST_ASSERT_TRUE(fdl_waiting_isr(10));
    TEST_ASSERT_FALSE(fdl_waiting_isr(11));
    request("10 08 03 49 54 16");
    TEST_ASSERT_FALSE(fdl_waiting_isr(10)); /* another station's */
    fdl_poll();
    request("10 08 02 49 53 16");
    TEST_ASSERT_FALSE(fdl_waiting_isr(10));
}

/* ---- kept buffers ---- */

static void a_kept_l_sdu_stays_while_others_come_and_go(void)
{
    const uint8_t XDATA *first;

    unit_srd_sap(FDL_TO_ISR);
    isr.keep = true;
    ask_10(0x77);
    first = isr.lsdu;
    isr.keep = false;
    ask_10(0x78);
    ask_10(0x79);
    TEST_ASSERT_EQUAL_HEX8(0x77, *first);
    isr.keep = true; /* exchanged for the first one */
    ask_10(0x7A);
    TEST_ASSERT_EQUAL_HEX8(0x7A, *isr.lsdu);
    fdl_give_back(isr.kept);
    isr.kept = 0;
}

static void three_kept_and_three_waiting_leave_one_to_receive_with(void)
{
    uint8_t XDATA *kept[3];
    uint8_t i;

    unit_srd_sap(FDL_TO_ISR);
    isr.keep = true;
    for (i = 0; i < 3; i++) {
        isr.kept = 0;
        ask_10(i);
        kept[i] = isr.kept;
    }
    isr.keep = false;
    unit_srd_sap(FDL_TO_MAIN);
    ask_10(3);
    ask_10(4);
    ask_10(5);
    ask_10(6);
    ANSWERED("10 02 08 02 0C 16");
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
    for (i = 0; i < 3; i++)
        fdl_give_back(kept[i]);
    fdl_poll();
    TEST_ASSERT_EQUAL(3, ind.count);
}

/* ---- Ident, LSAP status ---- */

static void ident_is_answered_with_four_lengths_and_four_strings(void)
{
    static uint8_t XDATA data[64];

    request("10 08 02 4E 58 16");
    ANSWERED("E5"); /* nothing set yet */
    TEST_ASSERT_EQUAL(23, fma_ident(data));
    fdl_set_ident(data, 23);
    request("10 08 02 4E 58 16");
    /* Fieldling UNIT H1 S2.3 */
    ANSWERED("68 1A 1A 68 02 08 08 09 04 02 04 46 69 65 6C 64 6C 69 6E 67 55 4E 49 54 48 31 53 32 2E 33 52 16");
}

static void ident_has_at_most_64_octets(void)
{
    static uint8_t XDATA data[70];

    fdl_set_ident(data, 70);
    request("10 08 02 4E 58 16");
    TEST_ASSERT_EQUAL(64 + 9, fake.sent_len);
    OCTETS("68 43 43 68 02 08 08 00", fake.sent, 8);
}

/* Access and its extension, then SDA SDN SRD CSRD: role in bits 7..4 (1 responder, 3 not activated), type below. */
static void lsap_status_says_what_a_sap_offers(void)
{
    unit_srd_sap(FDL_TO_MAIN);
    fma_sap_activate(20, 5, FDL_SDA, 4, FDL_TO_MAIN);
    fma_sap_activate(21, 5, FDL_SDN, 4, FDL_TO_MAIN);
    request("68 05 05 68 88 82 4F 0A 3E A1 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 0A 7F 00 30 31 13 15 62 16");
    request("68 05 05 68 88 82 4F 14 3E AB 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 14 05 00 10 31 33 35 12 16");
    request("68 05 05 68 88 82 4F 15 3E AC 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 15 05 00 30 11 33 35 13 16");
}

static void lsap_status_says_how_the_sap_is_activated_now(void)
{
    fma_sap_activate(20, 5, FDL_SDA, 4, FDL_TO_MAIN);
    request("68 05 05 68 88 82 4F 14 3E AB 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 14 05 00 10 31 33 35 12 16");
    fma_sap_activate(20, FDL_ALL, FDL_SDN, 4, FDL_TO_MAIN);
    request("68 05 05 68 88 82 4F 14 3E AB 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 14 7F 00 30 11 33 35 8C 16");
    fma_sap_deactivate(20);
    request("68 05 05 68 88 82 4F 14 3E AB 16");
    ANSWERED("10 02 08 03 0D 16");
    fma_sap_activate(20, 5, FDL_SDA, 4, FDL_TO_MAIN);
    request("68 05 05 68 88 82 4F 14 3E AB 16");
    ANSWERED("68 0B 0B 68 82 88 08 3E 14 05 00 10 31 33 35 12 16");
}

static void lsap_status_without_a_sap_means_the_default_sap(void)
{
    unit_default_sap(FDL_TO_MAIN);
    request("10 08 02 4F 59 16");
    ANSWERED("68 09 09 68 02 08 08 7F 00 30 31 13 15 1A 16");
}

static void lsap_status_of_a_sap_that_is_not_active_is_refused_rs(void)
{
    request("68 05 05 68 88 82 4F 0A 3E A1 16");
    ANSWERED("10 02 08 03 0D 16");
    COUNTED(1, refused);
}

/* ---- what was heard ---- */

static void heard_tells_any_own_and_owner_apart_and_forgets(void)
{
    fdl_watch(2);
    TEST_ASSERT_EQUAL_HEX8(0, fdl_heard());
    request("10 09 02 49 54 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY, fdl_heard());
    TEST_ASSERT_EQUAL_HEX8(0, fdl_heard());
    request("10 08 03 49 54 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY | FDL_HEARD_OWN, fdl_heard());
    request("10 08 02 49 53 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY | FDL_HEARD_OWN | FDL_HEARD_OWNER, fdl_heard());
}

static void what_was_heard_for_us_is_not_forgotten_over_others(void)
{
    request("10 08 02 49 53 16");
    request("10 09 02 49 54 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY | FDL_HEARD_OWN, fdl_heard());
}

static void a_broadcast_and_bad_telegrams_are_not_for_us(void)
{
    fdl_watch(2);
    request("68 07 07 68 FF 82 46 3A 3E 00 00 3F 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY, fdl_heard());
    request("10 08 02 49 54 16"); /* FCS */
    request("E5");
    request("DC 08 02");
    TEST_ASSERT_EQUAL_HEX8(0, fdl_heard());
    request("10 08 02 C9 D3 16");
    TEST_ASSERT_EQUAL_HEX8(FDL_HEARD_ANY, fdl_heard());
}

/* ---- the line ---- */

static void an_octet_before_t_sdr_cancels_the_answer_and_is_counted(void)
{
    fake_silence();
    hear("10 08 02 49 53 16");
    hear("10");
    fake_silence();
    TEST_ASSERT_EQUAL(0, fake.sends);
    COUNTED(1, answers);
    COUNTED(1, cancelled);
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
}

static void telegrams_back_to_back_on_an_untimed_line_are_all_heard_and_the_last_is_answered(void)
{
    fake.line = HAL_LINE_UNTIMED;
    fma_set_value(FMA_BAUD_RATE, 1);
    unit_default_sap(FDL_TO_MAIN);
    fake.sent_len = 0;
    fake_silence();
    hear("68 04 04 68 08 02 5D 01 68 16");
    hear("68 04 04 68 08 02 5D 01 68 16");
    hear("68 04 04 68 08 02 5D 01 68 16");
    hear("10 03 02 49 4E 16");
    hear("10 08 02 49 53 16");
    finish_request();
    ANSWERED("10 02 08 00 0A 16");
    TEST_ASSERT_EQUAL(1, fake.sends);
    fdl_poll();
    TEST_ASSERT_EQUAL(1, ind.count);
    COUNTED(2, retries);
    COUNTED(3, cancelled);
    hear("10 08 02 49 53 16"); /* at once after our answer */
    finish_request();
    TEST_ASSERT_EQUAL(2, fake.sends);
}

static void a_reset_forgets_the_telegram_on_its_way(void)
{
    fake_silence();
    hear("10 08 02");
    fdl_reset(8);
    hear("49 53 16");
    finish_request();
    TEST_ASSERT_EQUAL(0, fake.sends);
    request("10 08 02 49 53 16");
    ANSWERED("10 02 08 00 0A 16");
}

static void counters_begin_at_zero(void)
{
    uint8_t i;
    const uint8_t XDATA *octet = (const uint8_t XDATA *)&counters;

    request("10 08 02 49 53 16");
    request("10 08 02 49 54 16");
    fdl_reset(8);
    unit_count();
    for (i = 0; i < sizeof counters; i++)
        TEST_ASSERT_EQUAL(0, octet[i]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(fdl_status_is_answered_ok_by_a_slave);
    RUN_TEST(every_station_that_asks_is_answered_by_its_address);
    RUN_TEST(the_answer_leaves_from_the_address_that_is_set);
    RUN_TEST(telegrams_for_others_are_heard_and_not_answered);
    RUN_TEST(answers_of_others_and_tokens_are_not_answered);
    RUN_TEST(an_answer_sent_to_us_is_no_request);
    RUN_TEST(a_broadcast_sdn_is_indicated_and_not_answered);
    RUN_TEST(a_broadcast_that_wants_an_answer_is_a_format_error);
    RUN_TEST(a_request_from_the_global_address_is_a_format_error);
    RUN_TEST(the_reserved_bit_of_fc_is_a_format_error);
    RUN_TEST(functions_a_responder_does_not_know_are_not_answered);
    RUN_TEST(saps_stand_behind_fc_destination_first);
    RUN_TEST(without_extension_the_default_sap_is_meant);
    RUN_TEST(either_sap_may_stand_alone);
    RUN_TEST(sd3_carries_saps_among_its_eight_octets);
    RUN_TEST(announced_saps_that_are_not_there_are_a_format_error);
    RUN_TEST(extensions_other_than_saps_are_a_format_error);
    RUN_TEST(both_priorities_of_srd_are_answered);
    RUN_TEST(both_priorities_of_sdn_are_indicated_and_not_answered);
    RUN_TEST(both_priorities_of_sda_are_acknowledged_with_sc);
    RUN_TEST(a_poll_without_data_is_answered_from_the_buffer);
    RUN_TEST(an_srd_sap_without_a_buffer_answers_sc);
    RUN_TEST(a_sap_that_is_not_active_is_refused_rs);
    RUN_TEST(an_sdn_to_a_sap_that_is_not_active_is_dropped);
    RUN_TEST(a_service_the_sap_does_not_offer_is_refused_rs);
    RUN_TEST(a_station_without_access_is_refused_rs);
    RUN_TEST(more_data_than_the_sap_takes_are_refused_rr);
    RUN_TEST(a_sap_for_requests_without_data_refuses_data_rr);
    RUN_TEST(what_the_layer_above_refuses_at_once_is_refused_so);
    RUN_TEST(three_indications_wait_and_the_fourth_is_refused_rr);
    RUN_TEST(an_sdn_without_a_free_box_is_lost_as_the_service_allows);
    RUN_TEST(boxes_turn_many_times_without_losing_one);
    RUN_TEST(fdl_poll_hands_over_what_waited_when_it_was_called);
    RUN_TEST(what_waits_is_known_in_the_interrupt_by_sap_and_station);
    RUN_TEST(a_kept_l_sdu_stays_while_others_come_and_go);
    RUN_TEST(three_kept_and_three_waiting_leave_one_to_receive_with);
    RUN_TEST(ident_is_answered_with_four_lengths_and_four_strings);
    RUN_TEST(ident_has_at_most_64_octets);
    RUN_TEST(lsap_status_says_what_a_sap_offers);
    RUN_TEST(lsap_status_says_how_the_sap_is_activated_now);
    RUN_TEST(lsap_status_without_a_sap_means_the_default_sap);
    RUN_TEST(lsap_status_of_a_sap_that_is_not_active_is_refused_rs);
    RUN_TEST(heard_tells_any_own_and_owner_apart_and_forgets);
    RUN_TEST(what_was_heard_for_us_is_not_forgotten_over_others);
    RUN_TEST(a_broadcast_and_bad_telegrams_are_not_for_us);
    RUN_TEST(an_octet_before_t_sdr_cancels_the_answer_and_is_counted);
    RUN_TEST(telegrams_back_to_back_on_an_untimed_line_are_all_heard_and_the_last_is_answered);
    RUN_TEST(a_reset_forgets_the_telegram_on_its_way);
    RUN_TEST(counters_begin_at_zero);
    return UNITY_END();
}
