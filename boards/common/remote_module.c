#include "remote_module.h"
#include "bytes.h"
#include "hal/hal.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "remote_board.h"
#include "remote_check.h"
#include "remote_log.h"

struct rm_counters XDATA rm_counters;

static uint8_t type;
static uint16_t XDATA outputs[RM_DIGITAL_CHANNELS];
static volatile uint16_t XDATA inputs[RM_ANALOG_CHANNELS]; /* digital: all in inputs[0] */
static uint8_t tick; /* milliseconds since the last sample began */

STATIC_ASSERT(RM_SAMPLE_MS >= RM_ANALOG_CHANNELS && RM_SAMPLE_MS <= 250, a_sample_has_time_for_six_conversions);
STATIC_ASSERT(HDLC_INFO_MAX >= 36, an_answer_with_all_line_counters_fits);

/* The command being carried out, and its answer. index: of the channel, from 0. */
static struct {
    const uint8_t XDATA *info;
    uint8_t XDATA *answer;
    uint8_t n, answer_n, index;
} rq;

/* ---- values -------------------------------------------------------------------------------------------- */

static bool is_analog(void)
{
    return (type & (RM_AI | RM_AO)) != 0;
}

static void put_value(uint16_t value)
{
    if (is_analog()) {
        put_u16be(rq.answer + rq.answer_n, value);
        rq.answer_n = (uint8_t)(rq.answer_n + 2u);
    } else {
        rq.answer[rq.answer_n++] = value ? RM_ON : RM_OFF;
    }
}

static void put_u16(uint16_t value)
{
    put_u16be(rq.answer + rq.answer_n, value);
    rq.answer_n = (uint8_t)(rq.answer_n + 2u);
}

static uint16_t input_now(uint8_t index)
{
    const uint8_t irq = hal_irq_save();
    const uint16_t word = inputs[is_analog() ? index : 0];
    hal_irq_restore(irq);
    return is_analog() ? word : (uint16_t)((word >> index) & 1u);
}

static void drive(void)
{
    uint16_t all = 0;
    uint8_t i;

    if (type == RM_AO) {
        for (i = 0; i < RM_ANALOG_CHANNELS; i++)
            rm_board_analog(i, outputs[i]);
    } else if (type == RM_DO) {
        for (i = RM_DIGITAL_CHANNELS; i; i--)
            all = (uint16_t)(all << 1 | outputs[i - 1u]);
        rm_board_digital(all);
    }
}

static void outputs_safe(void)
{
    uint8_t i;

    for (i = 0; i < RM_DIGITAL_CHANNELS; i++)
        outputs[i] = 0;
    drive();
}

uint16_t rm_output(uint8_t index)
{
    return outputs[index];
}

/* One conversion a millisecond: six in a row would take an 8051 longer than an octet on the line. */
void rm_tick_isr(void) IN_ISR
{
    const uint8_t step = tick;

    tick = step + 1u < RM_SAMPLE_MS ? (uint8_t)(step + 1u) : 0;
    if (type == RM_DI && step == 0) {
        inputs[0] = rm_board_inputs_isr();
        rm_log_word_isr(inputs[0]);
    } else if (type == RM_AI && step < RM_ANALOG_CHANNELS) {
        inputs[step] = rm_board_adc_isr(step);
        rm_log_word_isr(inputs[step]);
    }
}

/* ---- functions ----------------------------------------------------------------------------------------- */

/* I2 -> rq.index: digital 00..0F, analog 01..06. */
static uint8_t take_channel(void)
{
    const uint8_t channel = rq.info[1];

    rq.index = is_analog() ? (uint8_t)(channel - 1u) : channel;
    return rq.index < (is_analog() ? RM_ANALOG_CHANNELS : RM_DIGITAL_CHANNELS) ? RM_OK : RM_CHANNEL;
}

static uint8_t request(void)
{
    if (take_channel() != RM_OK)
        return RM_CHANNEL;
    if (rm_faults() & RM_FAULT_CONVERTER)
        return RM_HARDWARE;
    put_value(input_now(rq.index));
    return RM_OK;
}

static uint8_t control(void)
{
    uint16_t value;

    if (take_channel() != RM_OK)
        return RM_CHANNEL;
    value = is_analog() ? get_u16be(rq.info + 2) : (uint16_t)(rq.info[2] - RM_OFF);
    if (value > (is_analog() ? RM_ANALOG_MAX : 1u))
        return RM_VALUE;
    outputs[rq.index] = value;
    drive();
    rm_counters.executed++;
    put_value(value);
    return RM_OK;
}

/*   04 ch max -> 04 ch  lost.16  first.16  k  sample_1 .. sample_k */
#define SAMPLES_HEAD 7u
static uint8_t samples(void)
{
    static uint16_t XDATA lost, first;
    const uint8_t width = is_analog() ? 2u : 1u;
    uint8_t k, word, waiting;

    if (take_channel() != RM_OK)
        return RM_CHANNEL;
    k = is_analog() ? (HDLC_INFO_MAX - SAMPLES_HEAD) / 2u : HDLC_INFO_MAX - SAMPLES_HEAD;
    if (rq.info[2] && rq.info[2] < k)
        k = rq.info[2];
    waiting = rm_log_find(rq.index, &lost, &first);
    if (waiting < k)
        k = waiting;
    put_u16(lost);
    put_u16(first);
    rq.answer[rq.answer_n++] = k;
    for (waiting = k; waiting; waiting--) {
        if (width == 2u) {
            put_value(rm_log_next(rq.index));
        } else {
            word = (uint8_t)((rm_log_next(0) >> rq.index) & 1u);
            put_value(word);
        }
    }
    rm_log_taken(rq.index, k);
    return RM_OK;
}

/*   03 00 -> 03 00  type channels faults faults_seen  stuck.16  passes.16  sample time [ms].16
 *   03 01 -> 03 01  good.16 crc.16 abort.16 idle.16 short.16 overrun.16 sent.16 underrun.16 restarts.16
 *                   delivered.16 sequence.16 resent.16 rejected.16 inactive.16 executed.16 refused.16 safe.16 */
static void page_module(void)
{
    rq.answer[2] = type;
    rq.answer[3] = is_analog() ? RM_ANALOG_CHANNELS : RM_DIGITAL_CHANNELS;
    rq.answer[4] = rm_faults();
    rq.answer[5] = rm_faults_seen();
    rq.answer_n = 6;
    put_u16(rm_check_stuck());
    put_u16(rm_passes());
    put_u16(RM_SAMPLE_MS);
}

static void page_line(void)
{
    static const CODE uint8_t rx[] = {HDLC_RX_GOOD, HDLC_RX_CRC, HDLC_RX_ABORT, HDLC_RX_IDLE, HDLC_RX_SHORT,
                                      HDLC_RX_OVERRUN};
    static const CODE uint8_t tx[] = {HDLC_TX_GOOD, HDLC_TX_UNDERRUN, HDLC_TX_RESTARTS};
    uint8_t irq, i;

    for (i = 0; i < sizeof rx; i++) {
        irq = hal_irq_save();
        put_u16(hdlc_8273_counters.rx[rx[i]]);
        hal_irq_restore(irq);
    }
    for (i = 0; i < sizeof tx; i++) {
        irq = hal_irq_save();
        put_u16(hdlc_8273_counters.tx[tx[i]]);
        hal_irq_restore(irq);
    }
    put_u16(hdlc_nrm_counters.delivered);
    put_u16(hdlc_nrm_counters.sequence);
    put_u16(hdlc_nrm_counters.resent);
    put_u16(hdlc_nrm_counters.rejected);
    put_u16(hdlc_nrm_counters.inactive);
    put_u16(rm_counters.executed);
    put_u16(rm_counters.refused);
    put_u16(rm_counters.safe);
}

static uint8_t diagnosis(void)
{
    switch (rq.info[1]) {
    case 0:
        page_module();
        return RM_OK;
    case 1:
        page_line();
        return RM_OK;
    default:
        return RM_CHANNEL;
    }
}

/* ---- the table ----------------------------------------------------------------------------------------- */

struct row {
    uint8_t function;
    uint8_t types;   /* enum rm_type or'ed: modules that have it */
    uint8_t octets;  /* of the command                           */
    bool documented; /* also with the document's control octet   */
    uint8_t (*handler)(void);
};

static const struct row CODE rows[] = {
    /* function     modules        octets document handler */
    {RM_REQUEST,   RM_DI | RM_AI,                 2, true,  request},
    {RM_CONTROL,   RM_DO,                         3, true,  control},
    {RM_CONTROL,   RM_AO,                         4, true,  control},
    {RM_DIAGNOSIS, RM_DI | RM_DO | RM_AI | RM_AO, 2, false, diagnosis},
    {RM_SAMPLES,   RM_DI | RM_AI,                 3, false, samples},
};
#define ROWS (sizeof rows / sizeof rows[0])

/* -> enum rm_reason; the answer, without I1 and I2, is only there for RM_OK. */
static uint8_t execute(bool in_document_mode)
{
    const struct row CODE *row = rows;
    uint8_t left = ROWS;

    while (rq.n == 0 || row->function != rq.info[0] || !(row->types & type)) {
        if (--left == 0 || rq.n == 0)
            return RM_FUNCTION;
        row++;
    }
    if (in_document_mode && !row->documented)
        return RM_FUNCTION;
    if (rq.n != row->octets)
        return RM_LENGTH;
    rq.answer_n = 2;
    return row->handler();
}

uint8_t rm_execute(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer, bool in_document_mode)
{
    uint8_t reason;

    rq.info = info;
    rq.n = n;
    rq.answer = answer;
    reason = execute(in_document_mode);
    answer[0] = n ? info[0] : 0;
    answer[1] = n > 1u ? info[1] : 0;
    if (reason == RM_OK)
        return rq.answer_n;
    rm_counters.refused++;
    if (in_document_mode)
        return 0;
    answer[0] |= RM_NEGATIVE;
    answer[2] = reason;
    return 3;
}

uint8_t hdlc_info_ind(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer)
{
    return rm_execute(info, n, answer, false);
}

/* ---- the module ---------------------------------------------------------------------------------------- */

/* our choice: nobody in charge, so the outputs are safe; in the document's mode nobody ever says he is, and they
 * keep what they were told. */
void hdlc_state_ind(uint8_t state)
{
    if (state != HDLC_NDM)
        return;
    rm_counters.safe++;
    outputs_safe();
}

/*   XID: type channels */
uint8_t hdlc_xid_ind(uint8_t XDATA *answer)
{
    answer[0] = type;
    answer[1] = is_analog() ? RM_ANALOG_CHANNELS : RM_DIGITAL_CHANNELS;
    return 2;
}

bool rm_init(uint8_t of, uint8_t address, uint8_t mode)
{
    const uint8_t irq = hal_irq_save();

    type = of;
    rm_log_init(is_analog() ? RM_LOG_CHANNELS_ANALOG : 1u);
    tick = 0;
    do /* the first sample */
        rm_tick_isr();
    while (tick);
    hal_irq_restore(irq);
    rm_counters.executed = rm_counters.refused = rm_counters.safe = 0;
    outputs_safe();
    rm_check_init(of);
    return hdlc_nrm_init(address, address, mode);
}

void rm_poll(void)
{
    hdlc_nrm_poll();
    rm_log_poll();
    rm_check_poll();
}
