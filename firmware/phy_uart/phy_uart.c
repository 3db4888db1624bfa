#include "phy_uart.h"
#include "hal/hal.h"

#define T_SDR_DEFAULT_TBIT 11u

/* our choice: a line that cannot show silence hands octets over in lumps (a USB adapter every millisecond, another
 * process when it is scheduled). 5 ms there, or 33 T_bit where that is longer, is the gap that ends a telegram. */
#define UNTIMED_GAPS_PER_S 200u

struct phy_rate {
    uint32_t bit_per_s;
    uint16_t max_t_sdr; /* T_bit */
    uint16_t gap;       /* T_bit, on an untimed line */
};

/* clang-format off */
#define RATE(bit_per_s, max_t_sdr) \
    {bit_per_s, max_t_sdr, (bit_per_s) / UNTIMED_GAPS_PER_S > PHY_T_SYN_TBIT ? (bit_per_s) / UNTIMED_GAPS_PER_S : PHY_T_SYN_TBIT}
/* clang-format on */
static const CODE struct phy_rate rates[PHY_BAUDS] = {
    [PHY_BAUD_9K6] = RATE(9600ul, 60u),     [PHY_BAUD_19K2] = RATE(19200ul, 60u),   [PHY_BAUD_93K75] = RATE(93750ul, 60u),
    [PHY_BAUD_187K5] = RATE(187500ul, 60u), [PHY_BAUD_500K] = RATE(500000ul, 100u), [PHY_BAUD_38K4] = RATE(38400ul, 60u),
    [PHY_BAUD_1M5] = RATE(1500000ul, 150u), [PHY_BAUD_45K45] = RATE(45450ul, 60u),  [PHY_BAUD_3M] = RATE(3000000ul, 250u),
    [PHY_BAUD_6M] = RATE(6000000ul, 450u),  [PHY_BAUD_12M] = RATE(12000000ul, 800u),
};

HOT volatile struct phy_rx phy_rx;
HOT struct phy_tx phy_tx;
IDATA uint8_t phy_model[PHY_MODEL];

/* Invariant: at most one of phy_rx.waiting and sending is set; but in the loop both may be, when we answer ourselves. */
static HOT volatile struct {
    uint8_t sending;
    uint8_t transmitter; /* Transmitter_output is enabled */
} line;

static uint16_t t_syn_tbit;
static hal_dur_t t_syn;
static HOT hal_dur_t t_sdr;

static uint8_t value_of[PHY_VARIABLES];
static uint8_t min_t_sdr;

#define BAUD_NONE 0xFFu

/* ---- octets ---------------------------------------------------------------------------------------------- */

static void send_isr(void) IN_ISR
{
    line.sending = true;
    hal_send(phy_tx.at, phy_tx.len);
}

/* With the transmitter disabled everything goes on as if the answer had been sent. */
void phy_answer_isr(void) IN_ISR
{
    if (!line.transmitter) {
        phy_done_ind_isr(true);
    } else if (hal_silent(t_sdr)) {
        send_isr();
    } else {
        phy_rx.waiting = true;
        hal_silence(t_sdr);
    }
}

static void cancel_answer_isr(void) IN_ISR
{
    phy_rx.waiting = false;
    hal_silence(t_syn);
    phy_done_ind_isr(false);
}

/* An octet is not the model's -> The chunk is over. */
static bool another_isr(void) IN_ISR
{
    const uint8_t less = phy_rx.less;
    const uint8_t head = (uint8_t)(phy_rx.left - less);

    phy_rx.model = PHY_MODEL_END;
    phy_rx.less = 0;
    if (phy_rx.left <= less)
        return true;
    phy_rx.left = head;
    if (head == PHY_HEAD) {
        phy_rx.left = 2u;
        phy_rx.at += PHY_HEAD - 1u;
    }
    return false;
}

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    if (phy_rx.waiting)
        cancel_answer_isr();
    if (err) {
        phy_rx.left = 0;
        phy_fault_ind_isr(err);
        return;
    }
    if (phy_rx.left == 0)
        return;
    *phy_rx.at = octet;
    phy_rx.at++;
    phy_rx.sum = (uint8_t)(phy_rx.sum + octet);
    if (phy_rx.model != PHY_MODEL_END && *phy_rx.model++ != octet && another_isr()) {
        phy_rx.left--;
        phy_chunk_ind_isr();
    } else if (--phy_rx.left == 0) {
        phy_chunk_ind_isr();
    }
}

void line_silence_isr(void) IN_ISR
{
    if (phy_rx.waiting) {
        phy_rx.waiting = false;
        if (phy_rx.left && value_of[PHY_LOOP] == PHY_DISABLED)
            phy_rx.left = 0; /* what is heard now is not for us */
        send_isr();
    } else if (!line.sending) {
        phy_syn_ind_isr();
    }
}

/* After our own answer the line has been silent for nobody yet: a request needs T_SYN, unless none can be seen. */
void line_sent_isr(void) IN_ISR
{
    if (!line.sending)
        return; /* the line was closed meanwhile */
    line.sending = false;
    hal_silence(t_syn);
    phy_done_ind_isr(true);
    if (phy_rx.untimed)
        phy_syn_ind_isr();
}

/* ---- management ------------------------------------------------------------------------------------------- */

static void set_times(void)
{
    hal_dur_t syn = hal_tbit(t_syn_tbit);
    hal_dur_t sdr = hal_tbit(min_t_sdr);
    uint8_t irq = hal_irq_save();

    t_syn = syn;
    t_sdr = sdr;
    hal_irq_restore(irq);
}

/* Open the line at the rate and loop in value_of[]; PHY_NO leaves it as it was. */
static uint8_t open_line(uint8_t baud, uint8_t loop)
{
    uint8_t format = HAL_8E1;
    uint8_t kind;
    uint8_t irq;

    if (loop == PHY_ENABLED)
        format |= HAL_LOOP;
    irq = hal_irq_save();
    kind = hal_line_open(phy_bit_per_s(baud), format);
    if (kind != HAL_LINE_NO) {
        phy_rx.untimed = kind == HAL_LINE_UNTIMED;
        phy_rx.waiting = false;
        line.sending = false;
        phy_rx.left = 0;
        t_syn_tbit = phy_rx.untimed ? rates[baud].gap : PHY_T_SYN_TBIT;
        set_times();
        hal_silence(t_syn);
    }
    hal_irq_restore(irq);
    return kind == HAL_LINE_NO ? PHY_NO : PHY_OK;
}

void phy_reset(void)
{
    uint8_t irq = hal_irq_save();

    hal_silence(0);
    phy_rx.left = 0;
    phy_rx.waiting = false;
    line.sending = false;
    line.transmitter = true;
    value_of[PHY_TRANSMITTER_OUTPUT] = PHY_ENABLED;
    value_of[PHY_RECEIVED_SIGNAL_SOURCE] = PHY_PRIMARY;
    value_of[PHY_LOOP] = PHY_DISABLED;
    value_of[PHY_BAUD_RATE] = BAUD_NONE;
    value_of[PHY_MEDIUM_RED] = PHY_NO_REDUNDANCY;
    min_t_sdr = T_SDR_DEFAULT_TBIT;
    hal_irq_restore(irq);
}

/* An answer that waits for T_SDR is not sent either. */
static void set_transmitter(uint8_t value)
{
    uint8_t irq = hal_irq_save();

    line.transmitter = value == PHY_ENABLED;
    if (!line.transmitter && phy_rx.waiting) {
        phy_rx.waiting = false;
        hal_silence(t_syn);
    }
    hal_irq_restore(irq);
}

static uint8_t set_loop(uint8_t value)
{
    if (value_of[PHY_BAUD_RATE] == BAUD_NONE)
        return PHY_OK;
    return open_line(value_of[PHY_BAUD_RATE], value);
}

uint8_t phy_set_value(uint8_t variable, uint8_t value)
{
    static const CODE uint8_t values[PHY_VARIABLES] = {
        [PHY_TRANSMITTER_OUTPUT] = PHY_ENABLED + 1,   [PHY_RECEIVED_SIGNAL_SOURCE] = PHY_RANDOM + 1,
        [PHY_LOOP] = PHY_ENABLED + 1,                 [PHY_BAUD_RATE] = PHY_BAUDS,
        [PHY_MEDIUM_RED] = PHY_BUS_B_HIGH + 1,
    };
    uint8_t status = PHY_OK;

    if (variable >= PHY_VARIABLES || value >= values[variable])
        return PHY_IV;
    switch (variable) {
    case PHY_TRANSMITTER_OUTPUT:
        set_transmitter(value);
        break;
    case PHY_LOOP:
        status = set_loop(value);
        break;
    case PHY_BAUD_RATE:
        status = open_line(value, value_of[PHY_LOOP]);
        break;
    default: /* one bus, one receiver */
        if (value != 0)
            status = PHY_NO;
        break;
    }
    if (status == PHY_OK && value_of[variable] != value) {
        value_of[variable] = value;
        phy_event_ind(variable, value);
    }
    return status;
}

uint8_t phy_read_value(uint8_t variable)
{
    return variable < PHY_VARIABLES ? value_of[variable] : 0xFFu;
}

void phy_set_min_t_sdr(uint8_t tbit)
{
    min_t_sdr = tbit;
    if (value_of[PHY_BAUD_RATE] != BAUD_NONE)
        set_times();
}

uint8_t phy_min_t_sdr(void)
{
    return min_t_sdr;
}

uint32_t phy_bit_per_s(uint8_t baud)
{
    return baud < PHY_BAUDS ? rates[baud].bit_per_s : 0;
}

uint16_t phy_max_t_sdr(uint8_t baud)
{
    return baud < PHY_BAUDS ? rates[baud].max_t_sdr : 0;
}
