#include "dp_console.h"
#include "ddlm/ddlm.h"
#include "line_console.h"

#define MODULES 4u

static uint8_t XDATA process_in[MODULES] = {31, 0, 0, 0};
static uint8_t XDATA process_out[MODULES];

uint8_t dp_console_input(uint8_t module)
{
    return process_in[module];
}

void dp_console_output(uint8_t module, uint8_t value)
{
    process_out[module] = value;
}

/* ---- commands -------------------------------------------------------------------------------------------- */

static void cmd_status(void)
{
    static struct ddlm_info XDATA info;
    static struct ddlm_counters XDATA ddlm;
    static struct fdl_counters XDATA fdl;
    static const char CODE *const CODE states[] = {"POWER_ON", "WAIT_PRM", "WAIT_CFG", "DATA_EXCH"};

    ddlm_read_info(&info);
    ddlm_read_counters(&ddlm);
    fdl_read_counters(&fdl);
    console_say("state=");
    console_say(states[info.state]);
    console_say_pair(" address=", info.address);
    console_say_pair(" master=", info.master);
    console_say_pair(" groups=", info.groups);
    console_say_pair(" sync=", info.sync);
    console_say_pair(" freeze=", info.freeze);
    console_say_pair(" wd=", info.wd_on);
    console_say_pair(" data_exchange=", ddlm.data_exchange);
    console_say_pair(" requests=", fdl.requests);
    console_say_pair(" retries=", fdl.retries);
    console_say_pair(" parity=", fdl.parity);
    console_say_pair(" checksum=", fdl.checksum);
    console_say_pair(" format=", fdl.format);
    console_say_pair(" gap=", fdl.gap);
}

static void cmd_out(void)
{
    console_say_pair("out1=", process_out[1]);
    console_say_pair(" out2=", process_out[3]);
}

/* in M V: modules are counted from 1, as in the configuration. */
static void cmd_in(void)
{
    static uint8_t XDATA at;
    uint16_t module;
    uint16_t value;

    at = 3;
    module = console_number(&at);
    value = console_number(&at);
    if (module < 1 || module > MODULES || value > 0xFFu || console_line[at] != 0) {
        console_say("error=usage-in-module-value");
        return;
    }
    process_in[module - 1u] = (uint8_t)value;
    console_say_pair("in=", module);
    console_say_pair(" value=", value);
}

void dp_console_poll(void)
{
    if (!console_read())
        return;
    if (console_is("status"))
        cmd_status();
    else if (console_is("out"))
        cmd_out();
    else if (console_is("in"))
        cmd_in();
    else
        console_say("error=unknown-command");
    console_end();
}
