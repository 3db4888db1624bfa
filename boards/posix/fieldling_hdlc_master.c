/* fieldling-hdlc-master: the master station: an HDLC primary over a modelled 8273 in DMA mode, as a PC card
 * has it (spec C4). Full screen, or for scripts. */
#include "hal/hal.h"
#include "hal_host.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc_line.h"
#include "master_commands.h"
#include "master_config.h"
#include "master_screen.h"
#include "options.h"
#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BIT_PER_S 7200u
#define LOAD_MS   1000u

static struct hp primary;

/* ---- command line -------------------------------------------------------------------------------- */

static struct hal_host host;
static enum hdlc_coding coding;
static const char *config;
static bool batch, json;
static uint32_t batch_s;

static const char *take_line(const char *value)
{
    host.line = value;
    return *value ? NULL : "must be pty:PATH, or the path of a pseudo terminal";
}

static const char *take_config(const char *value)
{
    config = value;
    return *value ? NULL : "must be a file";
}

static const char *take_coding(const char *value)
{
    if (strcmp(value, "octets") == 0)
        coding = HDLC_CODING_OCTETS;
    else if (strcmp(value, "bits") != 0)
        return "must be bits or octets";
    return NULL;
}

static const char *take_batch(const char *value)
{
    batch = true;
    return option_number(value, 0, 1000000, &batch_s) ? NULL : "must be seconds, 0: until quit";
}

static const char *take_json(const char *value)
{
    (void)value;
    json = true;
    return NULL;
}

static const struct option_row options[] = {
    {"line", "LINE", "a module's pseudo terminal, or pty:PATH: a fresh one for fieldling-hdlc-cable", take_line},
    {"config", "FILE",
     "the modules: boards/posix/hdlc_demo.conf is an example, boards/posix/master_config.h the manual", take_config},
    {"coding", "CODING", "what octets on the pty are: bits (default) or octets, see fieldling-hdlc --help",
     take_coding},
    {"batch", "SECONDS", "no screen: events on standard output, commands from standard input, end after so long",
     take_batch},
    {"json", NULL, "with --batch: each event a JSON object", take_json},
    {0}};

static const char more[] =
    "\nCommands (M is a module's name or address):\n"
    "  set M CH V      control now: digital V 0 or 1, analog V 0..4095\n"
    "  get M CH        request data now\n"
    "  samples M CH    fetch the whole sample log of a channel\n"
    "  diag M          diagnosis and counters of the module\n"
    "  on M, off M     poll a module, or no longer\n"
    "  status          everything known\n"
    "  wait MS         (batch) the next line waits so long\n"
    "  quit            end\n"
    "In batch each line waits for the answer to the one before. Exit status: 0 if all modules that are not off are\n"
    "online at the end, 1 if not, 2 if something cannot be used.\n";

/* ---- time and load ------------------------------------------------------------------------------- */

static uint64_t now_ms(void)
{
    static uint16_t last;
    static uint64_t ms;
    const uint16_t now = hal_ticks();

    ms += (uint16_t)(now - last);
    last = now;
    return ms;
}

/* Bits on the line in the last second, in percent of what fits. */
static double line_load(uint64_t now)
{
    static uint64_t since_ms, bits;
    static double load;

    if (now - since_ms >= LOAD_MS) {
        load = 100.0 * 1000.0 * (double)(hdlc_line_bits - bits) / (double)(now - since_ms) / BIT_PER_S;
        since_ms = now;
        bits = hdlc_line_bits;
    }
    return load;
}

/* ---- the card ------------------------------------------------------------------------------------ */

static void send(struct hp *p, const uint8_t *octets, unsigned n)
{
    (void)p;
    memcpy(hdlc_8273_out.octets, octets, n);
    hdlc_8273_send((uint8_t)n);
}

static void card_poll(uint64_t now)
{
    const struct hdlc_frame *frame;

    hdlc_8273_poll();
    while ((frame = hdlc_8273_frame()) != NULL) {
        hp_frame(&primary, frame->octets, frame->n, now);
        hdlc_8273_release();
    }
    if (!hdlc_8273_sending())
        hp_poll(&primary, now);
    hdlc_line_poll();
}

/* ---- commands ------------------------------------------------------------------------------------ */

static bool quit;

static void carry_out(const char *line, uint64_t now)
{
    const char *wrong = commands_line(line, now);

    if (wrong) {
        report_begin("error");
        report_text("command", line);
        report_text("what", wrong);
        report_end();
    }
}

static void read_batch(uint64_t now)
{
    static char line[200];
    static size_t n;
    int16_t key;

    while (!commands_busy(now) && (key = hal_con_get()) >= 0) {
        if (key == '\n') {
            line[n] = '\0';
            n = 0;
            carry_out(line, now);
        } else if (n < sizeof line - 1u && key >= ' ' && key <= '~') {
            line[n++] = (char)key;
        }
    }
}

static void read_keys(uint64_t now)
{
    const char *line;
    int16_t key;

    while ((key = hal_con_get()) >= 0) {
        line = screen_key(key, &quit);
        if (line)
            carry_out(line, now);
    }
}

/* ---- the program --------------------------------------------------------------------------------- */

static void start(void)
{
    const char *wrong;

    if (!host.line || !config)
        options_unusable("--line and --config are needed, see --help");
    hp_init(&primary);
    wrong = master_config_read(config, &primary);
    if (!wrong)
        wrong = hal_host_open(&host);
    if (!wrong && !batch)
        wrong = screen_open();
    if (wrong)
        options_unusable(wrong);
    report_to(json, batch ? NULL : screen_log);
    commands_init(&primary);
    primary.send = send;
    hal_init();
    if (hdlc_line_open(BIT_PER_S, coding) == HAL_LINE_NO)
        options_unusable("the line cannot be opened at 7200 bit/s: use a pseudo terminal");
    hdlc_8273_open(HDLC_8273_DMA | HDLC_8273_ALL, 0, 0);
    hal_irq_restore(HAL_IRQ_ON);
}

/* -> all are online. */
static bool summary(uint64_t now)
{
    unsigned wanted = 0, online = 0;

    for (unsigned i = 0; i < primary.modules; i++) {
        wanted += primary.module[i].state != HP_DISABLED;
        online += primary.module[i].state == HP_ONLINE;
    }
    if (batch) {
        commands_status();
        report_begin("summary");
        report_number("seconds", (double)now / 1000.0);
        report_number("online", online);
        report_number("modules", wanted);
        report_number("load_percent", now ? 100.0 * 1000.0 * (double)hdlc_line_bits / (double)now / BIT_PER_S : 0);
        report_end();
    }
    return online == wanted;
}

int main(int argc, char **argv)
{
    uint64_t now;

    options_read(argc, argv, "fieldling-hdlc-master: master station of HDLC remote modules", options, more);
    start();
    do {
        now = now_ms();
        card_poll(now);
        if (batch)
            read_batch(now);
        else
            read_keys(now);
        if (!batch)
            screen_draw(&primary, line_load(now), now);
        hal_idle();
        quit |= commands_quit() || (batch && batch_s && now >= (uint64_t)batch_s * 1000u);
    } while (!quit && !hal_host_stopping());
    return summary(now) ? 0 : 1;
}
