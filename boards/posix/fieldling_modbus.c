/* fieldling-modbus: a Modbus server as a program, on a pseudo terminal or a serial port: the inverter, or the
 * data of a text file. Console on standard input and output; `fieldling-modbus --help` says the rest. */
#include "console.h"
#include "hal/hal.h"
#include "hal_host.h"
#include "inverter.h"
#include "inverter_modbus.h"
#include "mb_image.h"
#include "mb_trace.h"
#include "options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Our choice: on a line that cannot show silence to the bit a frame has ended when nothing came for 5 ms: a
 * pty gives what was written at once, and a busy host is late by less. A USB adapter may want 20. */
#define GAP_MS 5u

/* ---- the device: inverter or image --------------------------------------------------------------------- */

static bool is_image;
const struct mb_block CODE *mb_map = inv_blocks;

uint8_t mb_check_ind(void)
{
    return is_image ? MB_OK : inv_check();
}

uint8_t mb_block_ind(void)
{
    return inv_block(); /* an image has data in all its blocks */
}

uint8_t mb_exception_status_ind(void)
{
    return is_image ? 0 : inv_inputs;
}

bool mb_busy_ind(void)
{
    return !is_image && inv_storing();
}

uint8_t mb_server_id_ind(uint8_t XDATA *octets)
{
    return is_image ? mb_image_server_id(octets) : inv_server_id(octets);
}

/* ---- command line -------------------------------------------------------------------------------------- */

static struct hal_host host = {.switches = 1};
static char parity = 'E';
static uint16_t gap_ms;

static const char *take_line(const char *value)
{
    host.line = value;
    return *value ? NULL : "must be pty:PATH or the device of a serial port";
}

static const char *take_mode(const char *value)
{
    mb_port.mode = strcmp(value, "ascii") == 0 ? MB_ASCII : MB_RTU;
    return mb_port.mode == MB_ASCII || strcmp(value, "rtu") == 0 ? NULL : "must be rtu or ascii";
}

static const char *take_address(const char *value)
{
    uint32_t address;
    if (!option_number(value, 1, 247, &address))
        return "must be 1..247";
    mb_port.address = (uint8_t)address;
    return NULL;
}

static const char *take_baud(const char *value)
{
    return option_number(value, 300, 4000000, &mb_port.bit_per_s) ? NULL : "must be a bit rate, 300..4000000";
}

static const char *take_parity(const char *value)
{
    parity = *value;
    return *value && strchr("NEO", *value) && !value[1] ? NULL : "must be N, E or O";
}

static const char *take_gap(const char *value)
{
    uint32_t ms;
    if (!option_number(value, 1, 500, &ms))
        return "must be 1..500 ms";
    gap_ms = (uint16_t)ms;
    return NULL;
}

static const char *take_map(const char *value)
{
    const char *const wrong = mb_image_read(value);
    is_image = true;
    mb_map = mb_image_blocks();
    return wrong;
}

static const char *take_nv(const char *value)
{
    host.nv = value;
    return NULL;
}

static const struct option_row options[] = {
    {"line", "LINE",
     "pty:PATH: a fresh pseudo terminal and a link to it at PATH; or the device of a serial port", take_line},
    {"mode", "rtu|ascii", "how frames are written (default rtu)", take_mode},
    {"address", "N", "1..247 (default 1)", take_address},
    {"baud", "R", "bit rate [bit/s] (default 19200)", take_baud},
    {"parity", "N|E|O", "none (two stop bits), even (default) or odd; RTU has 8 data bits, ASCII 7",
     take_parity},
    {"gap", "MS", "RTU: a silence of so many ms ends a frame (default 5)", take_gap},
    {"map", "FILE", "serve the data of FILE instead of the inverter (boards/posix/mb_image.h)", take_map},
    {"nv", "FILE", "keeps the parameters the inverter has stored; without it they are lost at the end",
     take_nv},
    {0}};

static const char more[] =
    "\nConsole, one line in, one line out; TABLE is coils, inputs, input-regs or holding-regs:\n"
    "  status                 the line, and every counter\n"
    "  get TABLE ADDR         one item\n"
    "  set TABLE ADDR VALUE   from the inside: inputs too, and nothing is refused\n"
    "  trace on | off         one line a frame\n"
    "  quit                   end\n"
    "The end of the input does not end the station. SIGTERM and SIGINT do, with status 0.\n";

/* ---- console ------------------------------------------------------------------------------------------- */

static void cmd_status(char **words, uint8_t n)
{
    static const char *const names[MB_COUNTERS] = {"bus_message", "bus_error", "exception", "slave_message",
                                                   "no_response", "nak",       "busy",      "overrun"};
    (void)words;
    if (n != 1) {
        console_error("no-argument-expected");
        return;
    }
    console_say("device=%s mode=%s address=%u baud=%lu parity=%c gap_ms=%u listen_only=%d events=%u",
                is_image ? "image" : "inverter", mb_port.mode == MB_ASCII ? "ascii" : "rtu", mb_port.address,
                (unsigned long)mb_port.bit_per_s, parity, gap_ms, mb_diag.listen_only, mb_diag.events);
    for (unsigned i = 0; i < MB_COUNTERS; i++)
        console_say(" %s=%u", names[i], mb_diag.counter[i]);
}

/* words: verb TABLE ADDR. The block of the item and its place; NULL: an error was said. */
static const struct mb_block *find(char **words, uint32_t *place)
{
    static const char *const names[] = {NULL, "coils", "inputs", "holding-regs", "input-regs"};
    uint8_t table = 1;
    while (table <= MB_INPUT_REGS && strcmp(words[1], names[table]) != 0)
        table++;
    if (table > MB_INPUT_REGS || !option_number(words[2], 0, 0xFFFF, place)) {
        console_error(table > MB_INPUT_REGS ? "no-such-table" : "address-is-0-to-65535");
        return NULL;
    }
    for (const struct mb_block *b = mb_map; b->table; b++)
        if (b->table == table && *place >= b->first && *place - b->first < b->count) {
            *place -= b->first;
            return b;
        }
    console_error("no-such-address");
    return NULL;
}

static uint16_t item(const struct mb_block *b, uint32_t place)
{
    if (b->table <= MB_INPUTS)
        return ((const uint8_t *)b->data)[place / 8u] >> place % 8u & 1u;
    return ((const uint16_t *)b->data)[place];
}

static void cmd_get(char **words, uint8_t n)
{
    uint32_t place;
    const struct mb_block *b;
    if (n != 3)
        console_error("usage-get-table-address");
    else if ((b = find(words, &place)) != NULL)
        console_say("%s=%s value=%u", words[1], words[2], item(b, place));
}

static void cmd_set(char **words, uint8_t n)
{
    uint32_t place, value;
    const struct mb_block *b;
    if (n != 4) {
        console_error("usage-set-table-address-value");
        return;
    }
    b = find(words, &place);
    if (!b)
        return;
    if (!option_number(words[3], 0, b->table <= MB_INPUTS ? 1 : 0xFFFF, &value)) {
        console_error(b->table <= MB_INPUTS ? "value-is-0-or-1" : "value-is-0-to-65535");
        return;
    }
    if (b->table > MB_INPUTS)
        ((uint16_t *)b->data)[place] = (uint16_t)value;
    else if (value)
        ((uint8_t *)b->data)[place / 8u] |= (uint8_t)(1u << place % 8u);
    else
        ((uint8_t *)b->data)[place / 8u] &= (uint8_t) ~(1u << place % 8u);
    console_say("%s=%s value=%u", words[1], words[2], item(b, place));
}

static void cmd_trace(char **words, uint8_t n)
{
    bool on;

    if (console_switch(words, n, &on))
        mb_trace_set(on);
}

static const struct console_command commands[] = {
    {"status", cmd_status}, {"get", cmd_get}, {"set", cmd_set}, {"trace", cmd_trace}, {"quit", console_quit}, {0},
};

/* ---- the program --------------------------------------------------------------------------------------- */

static uint8_t format(void)
{
    const bool ascii = mb_port.mode == MB_ASCII;
    if (parity == 'N')
        return ascii ? HAL_7N2 : HAL_8N2;
    if (parity == 'O')
        return ascii ? HAL_7O1 : HAL_8O1;
    return ascii ? HAL_7E1 : HAL_8E1;
}

/* Every line of a host is one that cannot show silence to the bit (hal_realtime.c): there the gap counts in
 * ms. */
static void set_gap(void)
{
    uint32_t tbit;
    if (!gap_ms)
        gap_ms = GAP_MS;
    tbit = mb_port.bit_per_s / 1000u * gap_ms + mb_port.bit_per_s % 1000u * gap_ms / 1000u;
    mb_port.gap_tbit = (uint16_t)(tbit > 0xFFFFu ? 0xFFFFu : tbit);
}

static void start(void)
{
    char text[256];
    const char *wrong;
    if (!host.line)
        options_unusable("--line is missing, see --help");
    wrong = hal_host_open(&host);
    if (wrong)
        options_unusable(wrong);
    hal_init();
    mb_port.format = format();
    set_gap();
    if (mb_open() == HAL_LINE_NO) {
        snprintf(text, sizeof text, "%.128s: the driver refuses %lu bit/s with parity %c", host.line,
                 (unsigned long)mb_port.bit_per_s, parity);
        options_unusable(text);
    }
    inv_init();
    console_init(commands);
    hal_irq_restore(HAL_IRQ_ON);
}

int main(int argc, char **argv)
{
    mb_port.bit_per_s = 19200;
    mb_port.address = 1;
    options_read(argc, argv, "fieldling-modbus: a Modbus server, RTU or ASCII", options, more);
    start();
    while (!console_ended() && !hal_host_stopping()) {
        mb_poll();
        if (!is_image)
            inv_poll();
        mb_trace_poll(mb_port.mode == MB_ASCII, gap_ms);
        console_poll();
        hal_wdog_kick();
        hal_idle();
    }
    return 0;
}
