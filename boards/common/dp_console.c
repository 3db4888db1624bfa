#include "dp_console.h"
#include "ddlm/ddlm.h"
#include "hal/hal.h"

#define LINE_MAX 24u
#define MODULES  4u

static uint8_t XDATA line[LINE_MAX + 1u];
static uint8_t line_len;
static bool too_long;
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

/* ---- words ------------------------------------------------------------------------------------------------------------ */

static void say(const char CODE *text)
{
    while (*text)
        hal_con_put((uint8_t)*text++);
}

/* Digits are made from the lowest up. */
static void say_pair(const char CODE *key, uint16_t value)
{
    static uint8_t XDATA digits[5];
    uint8_t n = 0;

    say(key);
    do {
        digits[n++] = (uint8_t)('0' + value % 10u);
        value /= 10u;
    } while (value);
    while (n)
        hal_con_put(digits[--n]);
}

/* An unsigned decimal word at *at, which is moved behind it and the blanks; 0xFFFF where there is none below 1000. */
#define NO_NUMBER 0xFFFFu

static uint16_t number(uint8_t XDATA *at)
{
    uint16_t n = 0;
    uint8_t i = *at;

    if (line[i] < '0' || line[i] > '9')
        return NO_NUMBER;
    while (line[i] >= '0' && line[i] <= '9' && n < 1000u)
        n = (uint16_t)(n * 10u + (line[i++] - '0'));
    while (line[i] == ' ')
        i++;
    *at = i;
    return n < 1000u ? n : NO_NUMBER;
}

/* ---- commands ------------------------------------------------------------------------------------------------------------ */

static void cmd_status(void)
{
    static struct ddlm_info XDATA info;
    static struct ddlm_counters XDATA ddlm;
    static struct fdl_counters XDATA fdl;
    static const char CODE *const CODE states[] = {"POWER_ON", "WAIT_PRM", "WAIT_CFG", "DATA_EXCH"};

    ddlm_read_info(&info);
    ddlm_read_counters(&ddlm);
    fdl_read_counters(&fdl);
    say("state=");
    say(states[info.state]);
    say_pair(" address=", info.address);
    say_pair(" master=", info.master);
    say_pair(" groups=", info.groups);
    say_pair(" sync=", info.sync);
    say_pair(" freeze=", info.freeze);
    say_pair(" wd=", info.wd_on);
    say_pair(" data_exchange=", ddlm.data_exchange);
    say_pair(" requests=", fdl.requests);
    say_pair(" retries=", fdl.retries);
    say_pair(" parity=", fdl.parity);
    say_pair(" checksum=", fdl.checksum);
    say_pair(" format=", fdl.format);
    say_pair(" gap=", fdl.gap);
}

static void cmd_out(void)
{
    say_pair("out1=", process_out[1]);
    say_pair(" out2=", process_out[3]);
}

/* in M V: modules are counted from 1, as in the configuration. */
static void cmd_in(void)
{
    static uint8_t XDATA at;
    uint16_t module;
    uint16_t value;

    at = 3;
    module = number(&at);
    value = number(&at);
    if (module < 1 || module > MODULES || value > 0xFFu || line[at] != 0) {
        say("error=usage-in-module-value");
        return;
    }
    process_in[module - 1u] = (uint8_t)value;
    say_pair("in=", module);
    say_pair(" value=", value);
}

static bool begins(const char CODE *word)
{
    uint8_t i = 0;

    while (word[i])
        if (line[i] != (uint8_t)word[i])
            return false;
        else
            i++;
    return line[i] == 0 || line[i] == ' ';
}

static void carry_out(void)
{
    line[line_len] = 0;
    if (too_long)
        say("error=line-too-long");
    else if (begins("status"))
        cmd_status();
    else if (begins("out"))
        cmd_out();
    else if (begins("in"))
        cmd_in();
    else
        say("error=unknown-command");
    say("\r\n");
}

void dp_console_poll(void)
{
    int16_t octet;

    while ((octet = hal_con_get()) >= 0) {
        if (octet == '\r' || octet == '\n') {
            if (line_len || too_long)
                carry_out();
            line_len = 0;
            too_long = false;
            return;
        }
        if (line_len < LINE_MAX)
            line[line_len++] = (uint8_t)octet;
        else
            too_long = true;
    }
}
