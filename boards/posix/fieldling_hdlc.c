/* fieldling-hdlc: a remote module as a program: HDLC NRM secondary on a modelled 8273, on a pseudo terminal. */
#include "console.h"
#include "hal/hal.h"
#include "hal_host.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "hdlc_line.h"
#include "options.h"
#include "remote_module.h"
#include "rm_host_board.h"
#include "sim/hdlc_words.h"

#include <stdio.h>
#include <string.h>

#define BIT_PER_S 7200u

/* ---- command line -------------------------------------------------------------------------------- */

static struct hal_host host;
static uint8_t type;
static uint32_t address;
static enum hdlc_coding coding;

static const struct {
    const char *word;
    uint8_t type;
} types[] = {{"di", RM_DI}, {"do", RM_DO}, {"ai", RM_AI}, {"ao", RM_AO}};

static const char *take_line(const char *value)
{
    host.line = value;
    return *value ? NULL : "must be pty:PATH";
}

static const char *take_type(const char *value)
{
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i].word, value) == 0)
            type = types[i].type;
    return type ? NULL : "must be di, do, ai or ao";
}

static const char *take_address(const char *value)
{
    return option_number(value, 0, 30, &address) ? NULL : "must be 0..30";
}

static const char *take_coding(const char *value)
{
    if (strcmp(value, "octets") == 0)
        coding = HDLC_CODING_OCTETS;
    else if (strcmp(value, "bits") != 0)
        return "must be bits or octets";
    return NULL;
}

static const struct option_row options[] = {
    {"line", "LINE", "pty:PATH: a fresh pseudo terminal and a link to it at PATH", take_line},
    {"type", "TYPE", "di, do: 16 digital inputs, outputs; ai, ao: 6 analog inputs, outputs of 12 bits", take_type},
    {"address", "N", "of this module, 0..30; 0 when not given", take_address},
    {"coding", "CODING", "what octets on the pty are: bits (default) or octets, see below", take_coding},
    {0}};

static const char more[] =
    "\nOctets on the pseudo terminal:\n"
    "  bits    the line itself, eight bits an octet, first bit least significant: flags, inserted zeros, FCS;\n"
    "          each frame is padded with ones (idle). SNRM to station 5: 7E 05 93 ED AB FD FE\n"
    "  octets  one frame after another as on asynchronous HDLC (RFC 1662): 7E address control information FCS 7E,\n"
    "          7E and 7D inside as 7D 5E and 7D 5D. SNRM to station 5: 7E 05 93 ED D7 7E\n"
    "\nConsole, one line in, one line out:\n"
    "  status            state, outputs, diagnosis and all counters\n"
    "  in CH V           fix an input: digital CH 0..15, V 0 or 1; analog CH 1..6, V 0..4095\n"
    "  out               all outputs\n"
    "  busy on | off     the application takes no commands for now (RNR)\n"
    "  fault WHAT on|off WHAT = ram, program, converter, output: break it, or mend it\n"
    "  trace on | off    one line a frame\n"
    "  quit              end\n"
    "The end of the input does not end the module. SIGTERM and SIGINT do, with status 0.\n";

/* ---- console ------------------------------------------------------------------------------------- */

static bool analog(void)
{
    return type == RM_AI || type == RM_AO;
}

static void say_outputs(void)
{
    if (type == RM_DO)
        console_say("out=%04X", rm_host_outputs());
    else if (type == RM_AO)
        console_say("out=%u,%u,%u,%u,%u,%u", rm_host_dac(0), rm_host_dac(1), rm_host_dac(2), rm_host_dac(3),
                    rm_host_dac(4), rm_host_dac(5));
    else
        console_say("out=none");
}

static void say_inputs(void)
{
    if (type == RM_DI)
        console_say("in=%04X ", rm_host_inputs());
    else if (type == RM_AI)
        console_say("in=%u,%u,%u,%u,%u,%u ", rm_host_adc(0), rm_host_adc(1), rm_host_adc(2), rm_host_adc(3),
                    rm_host_adc(4), rm_host_adc(5));
}

static void cmd_status(char **words, uint8_t n)
{
    static const char *const states[] = {"NDM", "NRM", "FRMR"};
    const volatile struct hdlc_8273_counters *c = &hdlc_8273_counters;
    const struct hdlc_nrm_counters *s = &hdlc_nrm_counters;

    (void)words;
    if (n != 1) {
        console_error("no-argument-expected");
        return;
    }
    console_say("state=%s address=%u type=%u ", states[hdlc_nrm_state()], (unsigned)address, type);
    say_inputs();
    say_outputs();
    console_say(" faults=%02X faults_seen=%02X passes=%u", rm_faults(), rm_faults_seen(), rm_passes());
    console_say(" good=%u crc=%u abort=%u idle=%u short=%u overrun=%u partial=%u full=%u", c->rx[HDLC_RX_GOOD],
                c->rx[HDLC_RX_CRC], c->rx[HDLC_RX_ABORT], c->rx[HDLC_RX_IDLE], c->rx[HDLC_RX_SHORT],
                c->rx[HDLC_RX_OVERRUN], c->rx[HDLC_RX_PARTIAL], c->rx[HDLC_RX_FULL]);
    console_say(" sent=%u underrun=%u restarts=%u", c->tx[HDLC_TX_GOOD], c->tx[HDLC_TX_UNDERRUN],
                c->tx[HDLC_TX_RESTARTS]);
    console_say(" commands=%u responses=%u delivered=%u sequence=%u resent=%u rejected=%u unanswered=%u inactive=%u",
                s->commands, s->responses, s->delivered, s->sequence, s->resent, s->rejected, s->unanswered,
                s->inactive);
    console_say(" executed=%u refused=%u safe=%u", rm_counters.executed, rm_counters.refused, rm_counters.safe);
}

static void cmd_in(char **words, uint8_t n)
{
    uint32_t channel, value;

    if (n != 3)
        console_error("usage-in-channel-value");
    else if (type != RM_DI && type != RM_AI)
        console_error("module-has-no-inputs");
    else if (!option_number(words[1], analog() ? 1 : 0, analog() ? 6 : 15, &channel))
        console_error(analog() ? "channel-is-1-to-6" : "channel-is-0-to-15");
    else if (!option_number(words[2], 0, analog() ? RM_ANALOG_MAX : 1, &value))
        console_error(analog() ? "value-is-0-to-4095" : "value-is-0-or-1");
    else {
        if (analog())
            rm_host_fix_analog((uint8_t)(channel - 1u), (uint16_t)value);
        else
            rm_host_fix_digital((uint8_t)channel, value != 0);
        console_say("in=%u value=%u", (unsigned)channel, (unsigned)value);
    }
}

static void cmd_out(char **words, uint8_t n)
{
    (void)words;
    if (n != 1)
        console_error("no-argument-expected");
    else
        say_outputs();
}

/* -> 1 on, 0 off, -1 neither */
static int on_or_off(const char *word)
{
    return strcmp(word, "on") == 0 ? 1 : strcmp(word, "off") == 0 ? 0 : -1;
}

static void cmd_busy(char **words, uint8_t n)
{
    if (n != 2 || on_or_off(words[1]) < 0) {
        console_error("usage-busy-on-or-off");
        return;
    }
    hdlc_nrm_busy(on_or_off(words[1]) == 1);
    console_say("busy=%s", words[1]);
}

static void cmd_fault(char **words, uint8_t n)
{
    if (n != 3 || on_or_off(words[2]) < 0 || !rm_host_fault(words[1], on_or_off(words[2]) == 1))
        console_error("usage-fault-ram-program-converter-or-output-on-or-off");
    else
        console_say("fault=%s is=%s", words[1], words[2]);
}

static void trace(enum hb_event event, const uint8_t *octets, unsigned n, bool sent)
{
    static const char *const events[] = {"", "good", "bad-fcs", "short", "unaligned", "abort", "idle", "too-long"};
    char text[2 * HB_OCTETS + 100], words[40];
    size_t at;

    if (event == HB_IDLE)
        return;
    at = (size_t)snprintf(text, sizeof text, "trace=%s frame=%s", sent ? "tx" : "rx", events[event]);
    if (n >= 2) {
        at += (size_t)snprintf(text + at, sizeof text - at, " address=%u control=\"%s\" octets=", octets[0],
                               hdlc_control_words(octets[1], sent, words, sizeof words));
        for (unsigned i = 0; i < n; i++)
            at += (size_t)snprintf(text + at, sizeof text - at, "%02X", octets[i]);
    }
    console_line(text);
}

static void cmd_trace(char **words, uint8_t n)
{
    bool on;

    if (console_switch(words, n, &on))
        hdlc_line_tap = on ? trace : NULL;
}

static const struct console_command commands[] = {
    {"status", cmd_status}, {"in", cmd_in},       {"out", cmd_out},   {"busy", cmd_busy},
    {"fault", cmd_fault},   {"trace", cmd_trace}, {"quit", console_quit}, {0},
};

/* ---- the program --------------------------------------------------------------------------------- */

/* The sampling timer. hal_ticks() wraps: count the milliseconds here. A host that was stopped makes up for it. */
static void sample_when_due(void)
{
    static uint16_t last;
    static uint32_t ms;
    const uint16_t now = hal_ticks();
    uint8_t irq;

    if (now == last)
        return;
    rm_host_live(ms);
    irq = hal_irq_save();
    for (; last != now; last++, ms++)
        rm_tick_isr();
    hal_irq_restore(irq);
}

static void start(void)
{
    const char *wrong;

    if (!host.line)
        options_unusable("--line is missing, see --help");
    if (!type)
        options_unusable("--type is missing: di, do, ai or ao");
    wrong = hal_host_open(&host);
    if (wrong)
        options_unusable(wrong);
    hal_init();
    if (hdlc_line_open(BIT_PER_S, coding) == HAL_LINE_NO)
        options_unusable("the line cannot be opened at 7200 bit/s: use pty:PATH");
    rm_init(type, (uint8_t)address, 0);
    console_init(commands);
    hal_irq_restore(HAL_IRQ_ON);
}

int main(int argc, char **argv)
{
    options_read(argc, argv, "fieldling-hdlc: a remote module, HDLC NRM secondary on an Intel 8273", options, more);
    start();
    while (!console_ended() && !hal_host_stopping()) {
        rm_poll();
        hdlc_line_poll();
        sample_when_due();
        console_poll();
        hal_wdog_kick();
        hal_idle();
    }
    return 0;
}
