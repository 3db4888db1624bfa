/* fieldling-dp: DP-TEST01 as a program, on a pseudo terminal or a serial port, with a console on standard
 * input and output. README.md shows it at work; `fieldling-dp --help` says the rest. */
#include "board.h"
#include "console.h"
#include "ddlm/ddlm.h"
#include "dp_test01_app.h"
#include "dp_trace.h"
#include "dp_words.h"
#include "hal/hal.h"
#include "hal_host.h"
#include "options.h"
#include "phy_uart/phy_uart.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the board: what is plugged into the four modules -------------------------------------------------- */

#define MODULE_ROW(name, in, out, ...) {in, out},
static const struct {
    uint8_t in, out; /* octets */
} modules[] = {DEV_MODULES(MODULE_ROW)};
#define MODULES (sizeof modules / sizeof *modules)

/* Process inputs until the console says otherwise: 31 degrees (spec A8: around 30 to 34), sensor off. */
static uint8_t process_in[MODULES] = {31};
static uint8_t process_out[MODULES];

uint8_t board_input(uint8_t module)
{
    return process_in[module];
}

void board_output(uint8_t module, uint8_t value)
{
    process_out[module] = value;
}

/* Management calls that failed (DDLM_Fault): of a running station only the non-volatile memory can. */
static unsigned faults;

void ddlm_fault_ind(uint8_t status)
{
    (void)status;
    faults++;
}

/* ---- command line -------------------------------------------------------------------------------------- */

static struct hal_host host = {.switches = FDL_UNADDRESSED};
static uint8_t baud = DDLM_BAUD_AUTO;
static const char *baud_asked;

static const char *take_line(const char *value)
{
    host.line = value;
    return *value ? NULL : "must be pty:PATH or the device of a serial port";
}

static const char *take_address(const char *value)
{
    uint32_t address;

    if (!option_number(value, 0, FDL_UNADDRESSED, &address))
        return "must be 0..125, or 126 for an address set by the master";
    host.switches = (uint8_t)address;
    return NULL;
}

static const char *take_baud(const char *value)
{
    uint32_t rate;

    baud_asked = value;
    if (option_number(value, 1, UINT32_MAX, &rate))
        for (baud = 0; baud < PHY_BAUDS; baud++)
            if (phy_bit_per_s(baud) == rate)
                return NULL;
    return "must be one of 9600 19200 38400 45450 93750 187500 500000 1500000 3000000 6000000 12000000";
}

static const char *take_nv(const char *value)
{
    host.nv = value;
    return NULL;
}

static const struct option_row options[] = {
    {"line", "LINE",
     "pty:PATH: a fresh pseudo terminal and a link to it at PATH; or the device of a serial port", take_line},
    {"address", "N", "what the address switches say: 0..125, or 126: set by the master (default)",
     take_address},
    {"baud", "R",
     "bit rate [bit/s]; without it the rate is searched (a pty has none: the first one tried fits)",
     take_baud},
    {"nv", "FILE", "keeps the address that a master has set; without it the address is lost at the end",
     take_nv},
    {0}};

static const char more[] =
    "\nConsole, one line in, one line out:\n"
    "  status            state of the station and all counters\n"
    "  in M V            input octet of module M (1 temperature, 3 sensor) is V, 0..255\n"
    "  out               all output octets\n"
    "  diag HEX | clear  extended diagnosis: whole blocks, reported as a fault until cleared\n"
    "  trace on | off    one line a telegram, layer by layer\n"
    "  quit              end\n"
    "The end of the input does not end the station. SIGTERM and SIGINT do, with status 0.\n";

/* ---- console ------------------------------------------------------------------------------------------- */

static void say_hex(const uint8_t *octets, size_t n)
{
    for (size_t i = 0; i < n; i++)
        console_say("%02X", octets[i]);
}

static void say_modules(const char *key, const uint8_t *octets, bool in)
{
    console_say("%s=", key);
    for (size_t i = 0; i < MODULES; i++)
        if (in ? modules[i].in : modules[i].out)
            say_hex(octets + i, 1);
}

static void say_fdl(void)
{
    static struct fdl_counters c;

    fdl_read_counters(&c);
    console_say(" sd_count=%u sd_error_count=%u parity=%u overrun=%u gap=%u format=%u checksum=%u foreign=%u",
                c.sd_count, c.sd_error_count, c.parity, c.overrun, c.gap, c.format, c.checksum, c.foreign);
    console_say(" requests=%u retries=%u answers=%u cancelled=%u refused=%u", c.requests, c.retries,
                c.answers, c.cancelled, c.refused);
}

static void say_ddlm(void)
{
    static struct ddlm_counters c;

    ddlm_read_counters(&c);
    console_say(
        " data_exchange=%u global_control=%u wrong_length=%u prm_rejected=%u cfg_rejected=%u not_processed=%u"
        " wd_expired=%u faults=%u",
        c.data_exchange, c.global_control, c.wrong_length, c.prm_rejected, c.cfg_rejected, c.not_processed,
        c.wd_expired, faults);
}

static void cmd_status(char **words, uint8_t n)
{
    static struct ddlm_info i;

    (void)words;
    if (n != 1) {
        console_error("no-argument-expected");
        return;
    }
    ddlm_read_info(&i);
    console_say("state=%s address=%u", dp_state_word(i.state), i.address);
    if (i.master == DDLM_NO_MASTER)
        console_say(" master=none");
    else
        console_say(" master=%u", i.master);
    console_say(" groups=%02X ident=%04X sync_supported=%d freeze_supported=%d sync_enabled=%d "
                "freeze_enabled=%d sync=%d"
                " freeze=%d",
                i.groups, DEV_IDENT, DEV_SYNC, DEV_FREEZE, i.sync_enabled, i.freeze_enabled, i.sync,
                i.freeze);
    console_say(" not_ready=%d wd=%s wd_ms=%lu wd_state=%s baud=%lu min_t_sdr=%u address_locked=%d ",
                i.not_ready, i.wd_on ? "on" : "off", (unsigned long)i.wd_ms, dp_wd_state_word(i.wd_state),
                (unsigned long)phy_bit_per_s(i.baud), i.min_t_sdr, i.address_locked);
    say_modules("in", process_in, true);
    say_modules(" out", process_out, false);
    say_fdl();
    say_ddlm();
}

static void cmd_in(char **words, uint8_t n)
{
    uint32_t module, value;

    if (n != 3)
        console_error("usage-in-module-value");
    else if (!option_number(words[1], 1, MODULES, &module) || modules[module - 1u].in == 0)
        console_error("no-such-input-module");
    else if (!option_number(words[2], 0, 255, &value))
        console_error("value-is-0-to-255");
    else {
        process_in[module - 1u] = (uint8_t)value;
        console_say("in=%u value=%u", module, value);
    }
}

static void cmd_out(char **words, uint8_t n)
{
    (void)words;
    if (n != 1)
        console_error("no-argument-expected");
    else
        say_modules("out", process_out, false);
}

/* Pairs of hexadecimal digits. -> number of octets, or -1. */
static int read_hex(const char *text, uint8_t *octets, int max)
{
    int n = 0;
    unsigned value;

    for (; text[0]; text += 2) {
        if (n == max || !isxdigit((unsigned char)text[0]) || !isxdigit((unsigned char)text[1]))
            return -1;
        sscanf(text, "%2x", &value);
        octets[n++] = (uint8_t)value;
    }
    return n;
}

static void cmd_diag(char **words, uint8_t n)
{
    uint8_t blocks[244] = {0};
    int len = 0;

    if (n != 2) {
        console_error("usage-diag-hex-or-clear");
        return;
    }
    if (strcmp(words[1], "clear") != 0)
        len = read_hex(words[1], blocks, sizeof blocks);
    if (len < 0)
        console_error("not-hexadecimal-octets");
    else if (!ddlm_diag(blocks, (uint8_t)len, len ? DDLM_EXT_DIAG : 0))
        console_error("not-whole-diagnosis-blocks");
    else if (len == 0)
        console_say("diag=none");
    else {
        console_say("diag=");
        say_hex(blocks, (size_t)len);
    }
}

static void cmd_trace(char **words, uint8_t n)
{
    bool on;

    if (console_switch(words, n, &on))
        dp_trace_set(on);
}

static const struct console_command commands[] = {
    {"status", cmd_status},
    {"in", cmd_in},
    {"out", cmd_out},
    {"diag", cmd_diag},
    {"trace", cmd_trace},
    {"quit", console_quit},
    {0},
};

/* ---- the program --------------------------------------------------------------------------------------- */

static void start(void)
{
    char text[128];
    const char *wrong;

    if (!host.line)
        options_unusable("--line is missing, see --help");
    wrong = hal_host_open(&host);
    if (wrong)
        options_unusable(wrong);
    hal_init();
    if (dp_test01_init(hal_switches(), baud) != DDLM_OK) {
        snprintf(text, sizeof text, "%s: the driver refuses 8E1 at %s bit/s", host.line,
                 baud_asked ? baud_asked : "any PROFIBUS rate in");
        options_unusable(text);
    }
    console_init(commands);
    hal_irq_restore(HAL_IRQ_ON);
}

int main(int argc, char **argv)
{
    static struct ddlm_info info;

    options_read(argc, argv, "fieldling-dp: the PROFIBUS-DP slave DP-TEST01 (ident 1234)", options, more);
    start();
    while (!console_ended() && !hal_host_stopping()) {
        dp_test01_poll();
        ddlm_read_info(&info);
        dp_trace_poll(info.state);
        console_poll();
        hal_wdog_kick();
        hal_idle();
    }
    return 0;
}
