/* A device with inputs only: Data_Exchange without data is a poll, not a Clear.
 * Clause: EN 50170-2 part 8, Data_Exchange; spec A6. */
#include "ddlm_unit.h"

void setUp(void)
{
    app.prm_good = true;
    app.adapts = false;
    station_begin(8);
    to_wait_cfg();
    ask_sap(8, 2, 62, "11");
    inputs("A1 A2");
    STATE(DDLM_DATA_EXCH);
}

void tearDown(void)
{
    fake_end();
}

static void a_poll_brings_the_inputs(void)
{
    request("10 08 02 6D 77 16");
    ANSWERED("68 05 05 68 02 08 08 A1 A2 55 16");
    COUNTED(1, data_exchange);
    INFO(0, output_len);
}

static void polls_are_numbered_like_any_request(void)
{
    request("10 08 02 7D 87 16");
    inputs("B1 B2");
    request("10 08 02 7D 87 16");
    ANSWERED("68 05 05 68 02 08 08 A1 A2 55 16");
    request("10 08 02 5D 67 16");
    ANSWERED("68 05 05 68 02 08 08 B1 B2 75 16");
    COUNTED(2, data_exchange);
}

static void outputs_it_does_not_have_are_a_configuration_fault(void)
{
    ask("68 04 04 68 08 02 6D 01 78 16");
    ANSWERED("10 02 08 03 0D 16");
    STATE(DDLM_WAIT_PRM);
    DIAG("06 05 00 FF 12 34");
}

static void the_application_is_told_of_the_fail_safe_state_and_of_no_outputs(void)
{
    OUTPUTS(DDLM_OUT_SAFE, "");
    request("10 08 02 6D 77 16");
    OUTPUTS(DDLM_OUT_SAME, "");
}

static void rd_outp_has_nothing_to_bring(void)
{
    request("68 05 05 68 88 82 6D 39 3E EE 16");
    ANSWERED("E5");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(a_poll_brings_the_inputs);
    RUN_TEST(polls_are_numbered_like_any_request);
    RUN_TEST(outputs_it_does_not_have_are_a_configuration_fault);
    RUN_TEST(the_application_is_told_of_the_fail_safe_state_and_of_no_outputs);
    RUN_TEST(rd_outp_has_nothing_to_bring);
    return UNITY_END();
}
