/* The line's side: one bit in, one bit out. */
#include "sim/hdlc_bits.h"
#include "sim/i8273.h"

#define FLAG 0x7Eu

/* ---- transmitter -------------------------------------------------------------------------------------- */

static void symbol(struct i8273_tx_side *tx, uint16_t bits, uint8_t n, bool stuff)
{
    tx->shift = bits;
    tx->bits = n;
    tx->stuff = stuff;
    if (!stuff)
        tx->ones = 0;
}

static void ask(struct i8273_tx_side *tx)
{
    if (tx->left == 0)
        return;
    tx->left--;
    tx->request = true;
}

void i8273_transmit(struct i8273 *chip)
{
    struct i8273_tx_side *tx = &chip->tx;
    tx->full = tx->request = tx->early_done = false;
    tx->fcs = 0xFFFF;
    tx->preframes = 0;
    if (tx->command == 0xCA)
        tx->state = TX_EOP;
    else if (tx->state != TX_FLAGS)
        tx->state = TX_CTS;
    else
        tx->state = TX_OPEN; /* flags are running: the frame follows the one that is going out */
    tx->auto_rts = true;
    ask(tx);
}

/* Nothing more to send: flags or silence. */
static void rest(struct i8273 *chip)
{
    const bool flags = (chip->operating & OP_FLAGS) != 0;
    chip->tx.state = flags ? TX_FLAGS : TX_IDLE;
    chip->tx.auto_rts = flags;
    chip->tx.request = chip->tx.full = false;
    chip->tx.left = 0;
    if (flags)
        symbol(&chip->tx, FLAG, 8, false);
}

static void send_abort(struct i8273 *chip, uint8_t result)
{
    chip->tx.state = TX_ABORT;
    chip->tx.request = chip->tx.full = false;
    chip->tx.abort_result = result;
    symbol(&chip->tx, 0xFF, 8, false);
}

void i8273_abort(struct i8273 *chip)
{
    if (chip->command == 0xCD || chip->tx.state == TX_IDLE || chip->tx.state == TX_CTS) {
        chip->tx.bits = 0;
        rest(chip);
        i8273_tx_result(chip, 0x10);
    } else {
        send_abort(chip, 0x10);
    }
}

static bool data_octet(struct i8273 *chip, uint8_t *octet)
{
    struct i8273_tx_side *tx = &chip->tx;
    if (tx->heads) {
        *octet = tx->head[2 - tx->heads--];
        return true;
    }
    if (!tx->full)
        return false;
    *octet = tx->holding;
    tx->full = false;
    ask(tx);
    if (!tx->request && (chip->operating & OP_EARLY) && !tx->early_done) {
        tx->early_done = true;
        i8273_tx_result(chip, 0x0C);
    }
    return true;
}

static void send_octet(struct i8273_tx_side *tx, uint8_t octet)
{
    for (unsigned i = 0; i < 8; i++)
        tx->fcs = hb_crc_bit(tx->fcs, (octet >> i) & 1u);
    symbol(tx, octet, 8, tx->command != 0xC9);
}

static void next_data(struct i8273 *chip)
{
    struct i8273_tx_side *tx = &chip->tx;
    uint8_t octet;
    if (data_octet(chip, &octet)) {
        send_octet(tx, octet);
    } else if (tx->request) {
        send_abort(chip, 0x0E);
    } else if (tx->command == 0xC9) {
        rest(chip);
        i8273_tx_result(chip, 0x0D);
    } else {
        symbol(tx, (uint16_t)~tx->fcs, 16, true);
        tx->state = TX_CLOSE;
    }
}

static void next_symbol(struct i8273 *chip)
{
    struct i8273_tx_side *tx = &chip->tx;
    switch (tx->state) {
    case TX_CTS:
        if (!chip->cts)
            return;
        tx->state = tx->command == 0xC9 ? TX_DATA : chip->operating & OP_PREFRAME ? TX_PREFRAME : TX_OPEN;
        next_symbol(chip);
        return;
    case TX_PREFRAME:
        symbol(tx, chip->serial_io & IO_NRZI ? 0x00 : 0x55, 8, false);
        if (++tx->preframes == 2)
            tx->state = TX_OPEN;
        return;
    case TX_OPEN:
        symbol(tx, FLAG, 8, false);
        tx->state = TX_DATA;
        return;
    case TX_DATA:
        next_data(chip);
        return;
    case TX_CLOSE:
        symbol(tx, FLAG, 8, false);
        tx->state = TX_END;
        return;
    case TX_END:
        rest(chip);
        i8273_tx_result(chip, 0x0D);
        return;
    case TX_ABORT:
        rest(chip);
        i8273_tx_result(chip, tx->abort_result);
        return;
    case TX_FLAGS:
        rest(chip);
        return;
    default:
        return;
    }
}

static bool next_bit(struct i8273 *chip)
{
    struct i8273_tx_side *tx = &chip->tx;
    bool bit;
    if (tx->stuff && tx->ones == 5u) {
        tx->ones = 0;
        return false;
    }
    if (tx->bits == 0)
        next_symbol(chip);
    if (tx->bits == 0)
        return true; /* idle, or waiting for CTS */
    bit = (tx->shift & 1u) != 0;
    tx->shift >>= 1;
    tx->bits--;
    tx->ones = bit ? tx->ones + 1u : 0;
    return bit;
}

void i8273_shift_out(struct i8273 *chip)
{
    struct i8273_tx_side *tx = &chip->tx;
    const bool sending = tx->state > TX_EOP && tx->state != TX_FLAGS && tx->state != TX_ABORT;
    bool bit;
    if (sending && !chip->cts)
        send_abort(chip, 0x0F);
    bit = next_bit(chip);
    chip->rts = tx->auto_rts;
    if (!chip->rts)
        tx->level = true;
    else if (chip->serial_io & IO_NRZI)
        tx->level ^= !bit;
    else
        tx->level = bit;
    chip->txd = tx->level;
    if ((chip->delay & 0x80u) && !chip->rts) /* a loop: what came in goes on, one bit later */
        chip->txd = chip->rx.delayed;
}

/* ---- receiver ----------------------------------------------------------------------------------------- */

static void rx_result(struct i8273 *chip, uint8_t ric, bool good)
{
    struct i8273_rx_side *rx = &chip->rx;
    const bool buffered = (chip->operating & OP_BUFFERED) != 0;
    if (rx->results.at < rx->results.n) { /* the last result has not been read */
        rx->enabled = false;
        rx->results = (struct i8273_results){.octet = {0x0B}, .n = 1};
        return;
    }
    rx->results = (struct i8273_results){
        .octet = {ric, (uint8_t)rx->count, (uint8_t)(rx->count >> 8), rx->a, rx->c},
        .n = !good && chip->option.one_error_result ? 1 : buffered ? 5 : 3,
    };
}

static void rx_stops(struct i8273 *chip, uint8_t code)
{
    chip->rx.enabled = chip->rx.in_frame = false;
    rx_result(chip, code, false);
}

/* Octet number k of the frame is certain not to be FCS. */
static void hand_over(struct i8273 *chip, uint32_t k, uint8_t octet)
{
    struct i8273_rx_side *rx = &chip->rx;
    if (chip->operating & OP_BUFFERED && k < 2) {
        if (k == 0)
            rx->a = octet;
        else
            rx->c = octet;
    } else if (rx->full) {
        rx_stops(chip, 0x08);
    } else if (rx->count == rx->limit) {
        rx_stops(chip, 0x09);
    } else {
        rx->count++;
        rx->data = octet;
        rx->full = true;
    }
}

/* Bits 7..5 of RIC: E0 = all eight bits; n = 1..7: n-1 with its bits reversed (RBIL), or as it is (RTL). */
static uint8_t partial_code(const struct i8273 *chip, unsigned n)
{
    const unsigned code = n == 0 ? 7u : n - 1u;
    const unsigned reversed = (code & 1u) << 2 | (code & 2u) | code >> 2;
    return (uint8_t)((chip->option.plain_partial ? code : reversed) << 5);
}

static void close_frame(struct i8273 *chip)
{
    struct i8273_rx_side *rx = &chip->rx;
    const uint32_t bits = rx->bits - 6u; /* the flag's 0 and five ones were taken for data */
    const unsigned partial = bits % 8u;
    if (bits < 32u) {
        if (!(chip->operating & OP_BUFFERED) || chip->option.short_when_buffered)
            rx_result(chip, 0xE7, false);
        return;
    }
    if (partial) /* the newest bits but six for the flag and 16 for the FCS are the last octet */
        hand_over(chip, (bits - 16u) / 8u,
                  (uint8_t)((rx->window >> (64u - 6u - 16u - partial)) & ((1u << partial) - 1u)));
    if (!rx->enabled)
        return;
    if (rx->crc == HB_RESIDUE)
        rx_result(chip, (uint8_t)(partial_code(chip, partial) | rx->match), true);
    else
        rx_result(chip, partial_code(chip, partial) | 0x03u, false);
}

static void flag(struct i8273 *chip)
{
    struct i8273_rx_side *rx = &chip->rx;
    const bool selective = rx->command != 0xC0;
    if (rx->in_frame && rx->bits > 6u && (!selective || rx->bits >= 8u + 6u))
        close_frame(chip);
    rx->in_frame = rx->enabled;
    rx->activity = true;
    rx->bits = 0;
    rx->count = 0;
    rx->crc = 0xFFFF;
}

static void select_frame(struct i8273_rx_side *rx)
{
    const uint8_t address = (uint8_t)(rx->window >> 56);
    rx->match = 0;
    if (rx->command == 0xC0)
        return;
    if (address == rx->a2 && address != rx->a1)
        rx->match = 1;
    else if (address != rx->a1)
        rx->in_frame = false;
}

static void data_bit(struct i8273 *chip, bool bit)
{
    struct i8273_rx_side *rx = &chip->rx;
    rx->window = rx->window >> 1 | (uint64_t)bit << 63;
    rx->bits++;
    if (rx->bits > 6u)
        rx->crc = hb_crc_bit(rx->crc, (rx->window >> 57) & 1u);
    if (rx->bits == 8u)
        select_frame(rx);
    if (rx->in_frame && rx->bits >= 24u + 6u && rx->bits % 8u == 6u) /* FCS and flag may be behind it already */
        hand_over(chip, rx->bits / 8u - 3u, (uint8_t)(rx->window >> 34));
}

static void sixth_one_and_more(struct i8273 *chip)
{
    struct i8273_rx_side *rx = &chip->rx;
    const bool inside = rx->in_frame && rx->bits > 5u;
    if (rx->ones == 7u && (chip->operating & OP_EOP) && rx->activity) {
        rx_stops(chip, 0x06);
    } else if (rx->ones == (chip->operating & OP_HDLC ? 7u : 8u)) {
        rx->in_frame = false;
        if (inside) {
            rx_result(chip, 0x04, false);
            rx->enabled &= !chip->option.abort_disables;
        }
    } else if (rx->ones == 15u && rx->activity) {
        rx_stops(chip, 0x05);
    }
}

void i8273_shift_in(struct i8273 *chip, bool level)
{
    struct i8273_rx_side *rx = &chip->rx;
    const uint8_t ones = rx->ones;
    bool bit = level;
    if (chip->serial_io & IO_DATA_LOOP)
        bit = level = chip->txd;
    if (chip->serial_io & IO_NRZI)
        bit = level == rx->level;
    rx->level = rx->delayed = level;
    rx->ones = bit ? (uint8_t)(ones < 16u ? ones + 1u : 16u) : 0;
    if (rx->ones == 7u && chip->tx.state == TX_EOP)
        chip->tx.state = TX_OPEN; /* the go-ahead of a loop */
    if (!rx->enabled)
        return;
    if (!chip->cd && rx->in_frame)
        rx_stops(chip, 0x0A);
    else if (rx->ones > 5u)
        sixth_one_and_more(chip);
    else if (!bit && ones == 6u)
        flag(chip);
    else if (rx->in_frame && !(!bit && ones == 5u)) /* not an inserted zero */
        data_bit(chip, bit);
}
