/* fieldling-demo: DP-TEST01 and a DP master on a simulated RS-485 segment, live.
 *
 * Both ends, the segment and its judge run in virtual time, exact to 1/576 us, which is paced to go by as
 * fast as real time does: T_SDR and T_SYN below are those of the segment, not of this computer. The station
 * is the firmware, from the UART's interrupts upwards; the master shares no code with it. */
#include "board.h"
#include "ddlm/ddlm.h"
#include "dp_test01_app.h"
#include "dp_words.h"
#include "hal_virtual.h"
#include "options.h"
#include "phy_uart/phy_uart.h"
#include "sim/bus.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#define MASTER 2
#define SLAVE  8

#define FRAME_NS    50000000l /* the picture is renewed 20 times a second */
#define SHOWN_FIRST 3u        /* exchanges shown telegram by telegram     */

static uint32_t seconds; /* 0: until a signal, or 10 s where the output is no terminal */
static uint8_t baud = PHY_BAUD_93K75;
static bool live; /* the output is a terminal */
static volatile sig_atomic_t stopping;

/* ---- the station's board: a room that warms up and cools down, and a door switch ------------------------- */

static uint8_t station_out[4];

/* 30 .. 34 degrees and back within 8 s. */
static uint8_t temperature(void)
{
    unsigned step = (unsigned)(hv_now() / HV_S) % 8u;

    return (uint8_t)(30u + (step < 4u ? step : 8u - step));
}

static uint8_t door(void)
{
    return hv_now() / (700u * HV_MS) % 3u == 2u;
}

uint8_t board_input(uint8_t module)
{
    return module == 0 ? temperature() : door();
}

void board_output(uint8_t module, uint8_t value)
{
    station_out[module] = value;
}

static void boot(void)
{
    hal_init();
    dp_test01_init(hal_switches(), baud);
    hal_irq_restore(HAL_IRQ_ON);
}

/* ---- the master ------------------------------------------------------------------------------------------ */

/* Lock, Sync and Freeze wanted, watchdog 20 * 1 * 10 ms; report more than 33 degrees. */
static struct dp_slave slave = {
    .address = SLAVE,
    .ident = DEV_IDENT,
    .station_status = 0xB8,
    .wd1 = 20,
    .wd2 = 1,
    .min_t_sdr = 11,
    .group = 1,
    .user_prm_n = 3,
    .user_prm = {1, 33, 0},
    .cfg_n = 4,
    .cfg = {0x10, 0x20, 0x10, 0x20},
    .out_n = 2,
    .in_n = 2,
};

static void set_outputs(struct dp_master *m, struct dp_slave *s)
{
    (void)m;
    s->outputs[0] = (uint8_t)s->exchanges;                             /* a counter  */
    s->outputs[1] = (uint8_t)(1u << (hv_now() / (300u * HV_MS) % 8u)); /* a running light */
}

static struct bus_master master = {
    .dp = {.ini = {.address = MASTER, .retries = 1}, .slaves = &slave, .slaves_n = 1, .before = set_outputs}};

/* ---- what is shown --------------------------------------------------------------------------------------- */

static unsigned block_lines; /* of the live picture on the screen */
static hv_time sdr_last, sdr_min = HV_NEVER, sdr_max;
static hv_time bit;

static double t_bits(hv_time ticks)
{
    return (double)ticks / (double)bit;
}

#define WRAP_OFF "\033[?7l" /* the block is as many lines as it has, on a narrow terminal, too */
#define WRAP_ON  "\033[?7h"

static void erase_block(void)
{
    if (block_lines)
        printf("\033[%uF\033[J" WRAP_ON, block_lines);
    block_lines = 0;
}

/* A line for each telegram; on a terminal no wider than it is. */
static void say_line(char *text)
{
    struct winsize size;

    if (live && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col != 0 && size.ws_col < strlen(text))
        text[size.ws_col] = '\0';
    erase_block();
    puts(text);
}

static void show_telegram(const uint8_t *octets, unsigned n, hv_time start, bool answer)
{
    static uint8_t asked; /* FC of the last request */
    char hex[3u * TG_MAX + 1u] = "", words[120] = "fdl=invalid", sdr[24] = "", text[sizeof hex + 220u];
    const char *service = "invalid";
    int width = -1;
    struct tg t;

    for (unsigned i = 0; i < n; i++)
        sprintf(hex + 3u * i, "%02X ", octets[i]);
    if (tg_decode(octets, n, &t) == TG_GOOD) {
        dp_fdl_words(&t, words, sizeof words);
        service = dp_service(&t, asked);
        if (t.fc & TG_REQUEST)
            asked = t.fc;
    }
    if (strcmp(service, "none") == 0) { /* FDL's own: the word behind "fdl=" */
        service = words + 4;
        width = (int)strcspn(service, " ");
    }
    if (answer)
        snprintf(sdr, sizeof sdr, " t_sdr=%.1f", t_bits(seg_said.t_sdr));
    snprintf(text, sizeof text, "%10.6f %s %-18.*s %-51s %s%s", (double)start / HV_S, answer ? "<-" : "->", width,
             service, hex, words, sdr);
    say_line(text);
}

static void note_telegram(const char *who, hv_time start, const uint8_t *octets, unsigned n)
{
    bool answer = strcmp(who, "master") != 0;
    struct tg t;
    bool cyclic = tg_decode(octets, n, &t) == TG_GOOD && t.dsap == TG_NO_SAP && t.n == 2;

    if (answer) {
        sdr_last = seg_said.t_sdr;
        sdr_min = sdr_last < sdr_min ? sdr_last : sdr_min;
        sdr_max = sdr_last > sdr_max ? sdr_last : sdr_max;
    }
    if (!cyclic || slave.exchanges < SHOWN_FIRST)
        show_telegram(octets, n, start, answer);
}

static const char *with_judge(void)
{
    static char text[200] = "no rule of the line broken";
    const char *verdict = seg_verdict();

    if (verdict)
        snprintf(text, sizeof text, "%s", verdict);
    return text;
}

static unsigned violations(void)
{
    unsigned n = 0;

    for (unsigned rule = 0; rule < SEG_RULES; rule++)
        n += seg_count((enum seg_rule)rule);
    return n;
}

static unsigned errors(const struct fdl_counters *c)
{
    return (unsigned)c->parity + c->overrun + c->gap + c->format + c->checksum + c->sd_error_count;
}

/* Returns the number of lines that are to be erased later. */
static unsigned show_state(void)
{
    static struct ddlm_info i;
    static struct fdl_counters c;

    ddlm_read_info(&i);
    fdl_read_counters(&c);
    printf("%8.1f s  %-9s  outputs %02X %02X ->  <- %u degrees, door %s  exchanges %-6u", (double)hv_now() / HV_S,
           dp_state_word(i.state), station_out[1], station_out[3], slave.inputs[0],
           slave.inputs[1] ? "open  " : "closed", slave.exchanges);
    if (!live) {
        printf(" T_SDR %.1f T_bit  errors %u\n", t_bits(sdr_last), errors(&c));
        return 0;
    }
    putchar('\n');
    printf("  slave    owner %u, groups %02X, watchdog %lu ms %s, sync %s, freeze %s, diagnosis %u octets\n",
           i.master, i.groups, (unsigned long)i.wd_ms, i.wd_on ? "on" : "off",
           i.sync_enabled ? "enabled" : "off", i.freeze_enabled ? "enabled" : "off", slave.diag_n);
    printf("  T_SDR    %.1f bit times (%.1f .. %.1f; allowed %u .. %u) at %lu bit/s on the virtual segment\n",
           t_bits(sdr_last), t_bits(sdr_min), t_bits(sdr_max), i.min_t_sdr, seg_max_t_sdr(),
           (unsigned long)phy_bit_per_s(baud));
    printf("  errors   parity %u, gap %u, format %u, FCS %u, retries %u, lost %u; judge: %s\n", c.parity,
           c.gap, c.format, c.checksum, master.dp.ini.resent, slave.lost, with_judge());
    return 4;
}

static void show_start(void)
{
    printf("DP-TEST01 (slave %u) and a DP master (%u) on a simulated RS-485 segment, %lu bit/s.\n"
           "Virtual time, paced to real time: T_SDR (in bit times) and all times are the segment's.%s\n\n",
           SLAVE, MASTER, (unsigned long)phy_bit_per_s(baud), live ? " Ctrl-C ends." : "");
}

static int show_end(void)
{
    static struct fdl_counters c;
    bool good = slave.starts > 0 && slave.exchanges > SHOWN_FIRST && violations() == 0;

    fdl_read_counters(&c);
    erase_block();
    printf("\n%s: %u exchanges in %.1f s, T_SDR %.1f .. %.1f bit times, %u line errors, %u retries, %u "
           "answers lost, "
           "%u rules of the line broken%s\n",
           good ? "ok" : "FAILED", slave.exchanges, (double)hv_now() / HV_S,
           sdr_min == HV_NEVER ? 0.0 : t_bits(sdr_min), t_bits(sdr_max), errors(&c), master.dp.ini.resent,
           slave.lost, violations(), slave.exchanges > SHOWN_FIRST ? "" : "; data exchange was not reached");
    return good ? 0 : 1;
}

/* ---- the keyboard ---------------------------------------------------------------------------------------- */

static struct termios cooked;

static void keys_off(void)
{
    tcsetattr(STDIN_FILENO, TCSANOW, &cooked);
}

/* On a terminal Ctrl-C comes as a key: a signal would go to make, too, which then ends with an error. */
static bool keys_on(void)
{
    struct termios raw;

    if (!live || tcgetpgrp(STDIN_FILENO) != getpgrp() || tcgetattr(STDIN_FILENO, &cooked) != 0)
        return false;
    raw = cooked;
    raw.c_lflag &= (tcflag_t) ~(ISIG | ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    return tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0 && atexit(keys_off) == 0;
}

static void read_keys(void)
{
    char key;

    while (read(STDIN_FILENO, &key, 1) == 1)
        if (key == cooked.c_cc[VINTR] || key == 'q')
            stopping = 1;
}

/* ---- pace ------------------------------------------------------------------------------------------------ */

static hv_time real_time(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (hv_time)t.tv_sec * HV_S + (hv_time)t.tv_nsec * HV_US / 1000u;
}

/* Run until virtual time `end`; a computer that cannot follow shows a slower bus, not a wrong one. */
static void run(hv_time end)
{
    const struct timespec frame = {.tv_nsec = FRAME_NS};
    hv_time start = real_time() - hv_now();
    hv_time next_line = HV_S;
    bool keys = keys_on();

    while (!stopping && hv_now() < end) {
        hv_time target = real_time() - start;

        if (target > hv_now() + HV_S / 5u) {
            start += target - hv_now() - HV_S / 5u;
            target = hv_now() + HV_S / 5u;
        }
        hv_run_until(target > hv_now() ? target : hv_now());
        if (live || hv_now() >= next_line) {
            erase_block();
            if (live)
                printf(WRAP_OFF);
            block_lines = show_state();
            next_line += HV_S;
        }
        fflush(stdout);
        nanosleep(&frame, NULL);
        if (keys)
            read_keys();
    }
}

/* ---- the program ----------------------------------------------------------------------------------------- */

static const char *take_seconds(const char *value)
{
    return option_number(value, 1, 86400, &seconds) ? NULL : "must be 1..86400";
}

static const char *take_baud(const char *value)
{
    uint32_t rate;

    if (option_number(value, 1, UINT32_MAX, &rate))
        for (baud = 0; baud < PHY_BAUDS; baud++)
            if (phy_bit_per_s(baud) == rate && rate <= 1500000u)
                return NULL;
    return "must be one of 9600 19200 38400 45450 93750 187500 500000 1500000";
}

static const struct option_row options[] = {
    {"seconds", "N",
     "end after so long; without it at a signal, or after 10 s where the output is no terminal",
     take_seconds},
    {"baud", "R", "bit rate of the segment [bit/s], 9600..1500000; 93750 when not given", take_baud},
    {0}};

static void note_signal(int number)
{
    (void)number;
    stopping = 1;
}

int main(int argc, char **argv)
{
    struct sigaction note = {.sa_handler = note_signal};

    options_read(argc, argv, "fieldling-demo: a DP slave and a DP master on a simulated segment, live",
                 options, "");
    live = isatty(STDOUT_FILENO) != 0;
    if (!live && seconds == 0)
        seconds = 10;
    sigaction(SIGINT, &note, NULL);
    sigaction(SIGTERM, &note, NULL);

    show_start();
    hv_begin();
    hv_set_switches(SLAVE);
    seg_begin(phy_bit_per_s(baud), SLAVE);
    seg_trace = note_telegram;
    hv_set_boot(boot);
    hv_set_loop(dp_test01_poll, NULL);
    hv_power_on();
    bit = hv_bit();
    hv_run_for(10u * HV_MS);
    bus_attach(&master);
    run(seconds ? (hv_time)seconds * HV_S : HV_NEVER);
    return show_end();
}
