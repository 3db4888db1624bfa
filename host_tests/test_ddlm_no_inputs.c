/* A device with outputs only: what answers a Data_Exchange that has nothing to bring.
 * Clause: EN 50170-2 part 4 (SC: no reply data), facts 3.9 (SD1 with DH where SC could not say "diagnosis pending"). */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    to_wait_cfg();
    ask_sap(8, 2, 62, "21");
}

void tearDown(void)
{
    fake_end();
}

#define EXCHANGE "68 05 05 68 08 02 6D 01 02 7A 16"

static void no_inputs_are_ready_at_once(void)
{
    STATE(DDLM_DATA_EXCH);
    INFO(0, input_len);
    DIAG("00 04 00 02 12 34");
}

static void data_exchange_is_answered_with_sc(void)
{
    request(EXCHANGE);
    ANSWERED("E5");
    OUTPUTS(DDLM_OUT_NEW, "01 02");
}

static void a_repeated_data_exchange_is_executed_once(void)
{
    request("68 05 05 68 08 02 7D 01 02 8A 16");
    ANSWERED("E5");
    OUTPUTS(DDLM_OUT_NEW, "01 02");
    request("68 05 05 68 08 02 7D 01 02 8A 16");
    ANSWERED("E5");
    OUTPUTS(DDLM_OUT_SAME, "01 02");
}

static void pending_diagnosis_is_an_sd1_until_it_has_been_read(void)
{
    static uint8_t XDATA block[2] = {0x02, 0x01};

    ddlm_diag(block, 2, DDLM_EXT_DIAG);
    request(EXCHANGE);
    ANSWERED("10 02 08 0A 14 16");
    request("68 05 05 68 88 82 6D 3C 3E F1 16");
    ANSWERED("68 0D 0D 68 82 88 08 3E 3C 08 04 00 02 12 34 02 01 E3 16");
    request(EXCHANGE);
    ANSWERED("E5");
}

static void rd_inp_has_nothing_to_bring(void)
{
    request("68 05 05 68 88 82 6D 38 3E ED 16");
    ANSWERED("E5");
}

static void freeze_changes_nothing(void)
{
    ask_sap(8, 2, 61, "90 00 00 0B 12 34 00");
    ask_sap(8, 2, 62, "21");
    ask("68 07 07 68 FF 82 46 3A 3E 08 00 47 16");
    INFO(true, freeze);
    request(EXCHANGE);
    ANSWERED("E5");
}

static void no_data_at_all_is_the_fail_safe_state(void)
{
    request("10 08 02 6D 77 16");
    ANSWERED("E5");
    OUTPUTS(DDLM_OUT_SAFE, "00 00");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(no_inputs_are_ready_at_once);
    RUN_TEST(data_exchange_is_answered_with_sc);
    RUN_TEST(a_repeated_data_exchange_is_executed_once);
    RUN_TEST(pending_diagnosis_is_an_sd1_until_it_has_been_read);
    RUN_TEST(rd_inp_has_nothing_to_bring);
    RUN_TEST(freeze_changes_nothing);
    RUN_TEST(no_data_at_all_is_the_fail_safe_state);
    return UNITY_END();
}
