/* The processor's side: registers, command phase, results. */
#include "sim/i8273.h"
#include "sim/hdlc_bits.h"

#include <string.h>

static void reset(struct i8273 *chip)
{
    const struct i8273 old = *chip;
    memset(chip, 0, sizeof *chip);
    chip->option = old.option;
    chip->cts = old.cts;
    chip->cd = old.cd;
    chip->pa = old.pa;
    chip->lost_commands = old.lost_commands;
    chip->lost_parameters = old.lost_parameters;
    chip->data_without_request = old.data_without_request;
    chip->port_b = 0x3F;
    chip->txd = chip->tx.level = chip->rx.level = chip->rx.delayed = true;
}

void i8273_power_on(struct i8273 *chip)
{
    memset(chip, 0, sizeof *chip);
    chip->cts = chip->cd = true;
    reset(chip);
}

/* ---- results and interrupts --------------------------------------------------------------------------- */

static bool dma(const struct i8273 *chip)
{
    return (chip->transfer & 1u) == 0;
}

static bool has(const struct i8273_results *r)
{
    return r->at < r->n;
}

static uint8_t take_result(struct i8273 *chip, struct i8273_results *r)
{
    if (!has(r) || r->wait)
        return 0;
    r->wait = r->at + 1u < r->n ? chip->option.result_reads : 0;
    return r->octet[r->at++];
}

void i8273_tx_result(struct i8273 *chip, uint8_t code)
{
    chip->tx.results = (struct i8273_results){.octet = {code}, .n = 1};
}

bool i8273_int_tx(const struct i8273 *chip)
{
    return has(&chip->tx.results) || (chip->tx.request && !dma(chip));
}

bool i8273_int_rx(const struct i8273 *chip)
{
    return has(&chip->rx.results) || (chip->rx.full && !dma(chip));
}

bool i8273_drq_tx(const struct i8273 *chip)
{
    return chip->tx.request && dma(chip);
}

bool i8273_drq_rx(const struct i8273 *chip)
{
    return chip->rx.full && dma(chip);
}

/* ---- commands (facts 1.4) ----------------------------------------------------------------------------- */

struct row {
    uint8_t command, parameters, buffered;
    void (*execute)(struct i8273 *chip);
};

static uint16_t length(const struct i8273 *chip)
{
    return (uint16_t)(chip->parameter[0] | chip->parameter[1] << 8);
}

static uint8_t *mode_register(struct i8273 *chip)
{
    switch (chip->command & 0x1Fu) { /* set and reset differ in the upper three bits only */
    case 0x11:
        return &chip->operating;
    case 0x17:
        return &chip->transfer;
    case 0x00:
        return &chip->serial_io;
    case 0x03:
        return &chip->port_b;
    default:
        return &chip->delay;
    }
}

static void set_bits(struct i8273 *chip)
{
    *mode_register(chip) |= chip->parameter[0];
}

static void reset_bits(struct i8273 *chip)
{
    *mode_register(chip) &= chip->parameter[0];
}

static void receive(struct i8273 *chip)
{
    struct i8273_rx_side *rx = &chip->rx;
    rx->enabled = true;
    rx->in_frame = rx->activity = rx->full = false; /* a result that was not read stays */
    rx->command = chip->command;
    rx->limit = length(chip);
    rx->a1 = chip->parameter[2];
    rx->a2 = chip->parameter[3];
}

static void receive_disable(struct i8273 *chip)
{
    chip->rx.enabled = false;
}

static void transmit(struct i8273 *chip)
{
    struct i8273_tx_side *tx = &chip->tx;
    tx->command = chip->command;
    tx->left = length(chip);
    tx->heads = 0;
    if (chip->need == 4) {
        tx->head[0] = chip->parameter[2];
        tx->head[1] = chip->parameter[3];
        tx->heads = 2;
    }
    i8273_transmit(chip);
}

static void abort_transmit(struct i8273 *chip)
{
    i8273_abort(chip);
}

/* Bits: RTL gives the pins as they are (0 = active), HAPN takes 1 as active. CTS bit 0, CD bit 1. */
static void read_port_a(struct i8273 *chip)
{
    uint8_t level = (uint8_t)((chip->cts ? 0 : 1u) | (chip->cd ? 0 : 2u));
    if (chip->option.ports_inverted)
        level ^= 3u;
    chip->result = (uint8_t)(level | (chip->pa & 0x1Cu));
    chip->result_full = true;
}

static void read_port_b(struct i8273 *chip)
{
    const uint8_t rts = chip->tx.auto_rts ? 1u : 0;
    chip->result = chip->option.ports_inverted ? (uint8_t)((chip->port_b & 0x3Eu) | rts) : chip->port_b & 0x3Fu;
    chip->result_full = true;
}

static const struct row rows[] = {
    {0xA4, 1, 1, set_bits},        {0x64, 1, 1, reset_bits},     {0x97, 1, 1, set_bits},
    {0x57, 1, 1, reset_bits},      {0x91, 1, 1, set_bits},       {0x51, 1, 1, reset_bits},
    {0xA0, 1, 1, set_bits},        {0x60, 1, 1, reset_bits},     {0xA3, 1, 1, set_bits},
    {0x63, 1, 1, reset_bits},      {0xC0, 2, 2, receive},        {0xC1, 4, 4, receive},
    {0xC2, 4, 4, receive},         {0xC5, 0, 0, receive_disable}, {0xC8, 2, 4, transmit},
    {0xCA, 2, 4, transmit},        {0xC9, 2, 2, transmit},       {0xCC, 0, 0, abort_transmit},
    {0xCE, 0, 0, abort_transmit},  {0xCD, 0, 0, abort_transmit}, {0x22, 0, 0, read_port_a},
    {0x23, 0, 0, read_port_b},
};

static const struct row *find(uint8_t command)
{
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (rows[i].command == command)
            return &rows[i];
    return NULL;
}

static void execute_when_complete(struct i8273 *chip)
{
    if (chip->given < chip->need)
        return;
    chip->in_command = false;
    find(chip->command)->execute(chip);
}

static void write_command(struct i8273 *chip, uint8_t command)
{
    const struct row *row = find(command);
    if (chip->in_command || chip->busy_reads || !row) {
        chip->lost_commands++;
        return;
    }
    chip->command = command;
    chip->need = chip->operating & OP_BUFFERED ? row->buffered : row->parameters;
    chip->given = 0;
    chip->in_command = true;
    chip->busy_reads = chip->option.hold_reads;
    execute_when_complete(chip);
}

static void write_parameter(struct i8273 *chip, uint8_t value)
{
    if (!chip->in_command || chip->parameter_reads) {
        chip->lost_parameters++;
        return;
    }
    chip->parameter[chip->given++] = value;
    chip->parameter_reads = chip->option.hold_reads;
    chip->busy_reads = chip->option.hold_reads;
    execute_when_complete(chip);
}

/* ---- registers ---------------------------------------------------------------------------------------- */

static uint8_t count_down(uint8_t *reads, uint8_t bit)
{
    if (*reads == 0)
        return 0;
    (*reads)--;
    return bit;
}

/* xIRA shows after the pause between two result octets; xINT stays all the time. */
static uint8_t result_status(struct i8273_results *r, uint8_t ira)
{
    if (!has(r) || r->wait) {
        r->wait = (uint8_t)(r->wait ? r->wait - 1u : 0);
        return 0;
    }
    return ira;
}

static uint8_t status(struct i8273 *chip)
{
    uint8_t s = count_down(&chip->busy_reads, I8273_CBSY);
    s |= chip->in_command ? I8273_CBSY : 0;
    s |= count_down(&chip->parameter_reads, I8273_CPBF);
    s |= chip->result_full ? I8273_CRBF : 0;
    s |= i8273_int_rx(chip) ? I8273_RXINT : 0;
    s |= i8273_int_tx(chip) ? I8273_TXINT : 0;
    s |= result_status(&chip->rx.results, I8273_RXIRA);
    s |= result_status(&chip->tx.results, I8273_TXIRA);
    return s;
}

uint8_t i8273_read(struct i8273 *chip, uint8_t reg)
{
    switch (reg) {
    case I8273_COMMAND:
        return status(chip);
    case I8273_PARAMETER:
        chip->result_full = false;
        return chip->result;
    case I8273_RESET:
        return take_result(chip, &chip->tx.results);
    case I8273_RX_RESULT:
        return take_result(chip, &chip->rx.results);
    case I8273_RX_DATA:
        chip->data_without_request += !chip->rx.full;
        chip->rx.full = false;
        return chip->rx.data;
    default:
        return 0xFF;
    }
}

void i8273_write(struct i8273 *chip, uint8_t reg, uint8_t value)
{
    const uint8_t reset_reg = chip->option.reset_at_1 ? I8273_PARAMETER : I8273_RESET;
    if (reg == I8273_COMMAND) {
        write_command(chip, value);
    } else if (reg == I8273_PARAMETER && chip->in_command) {
        write_parameter(chip, value);
    } else if (reg == reset_reg) {
        if (value & 1u)
            reset(chip);
    } else if (reg == I8273_TX_DATA) {
        chip->data_without_request += !chip->tx.request;
        chip->tx.full |= chip->tx.request;
        chip->tx.request = false;
        chip->tx.holding = value;
    } else if (reg == I8273_PARAMETER) {
        chip->lost_parameters++;
    }
}
