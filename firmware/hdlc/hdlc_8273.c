#include "hdlc/hdlc_8273.h"
#include "hal/hal.h"
#include "hal/hal_8273.h"

/* Status register (agreed by all sources). */
#define CBSY  0x80u /* a command is being given or carried out */
#define CPBF  0x20u /* the last parameter is not taken yet     */
#define CRBF  0x10u /* immediate result is there               */
#define RXINT 0x08u
#define TXINT 0x04u
#define RXIRA 0x02u /* with xINT: a result; without: a data octet is asked for or offered */
#define TXIRA 0x01u

#define SELECTIVE_RECEIVE 0xC1u /* B0 B1 A1 A2 */
#define GENERAL_RECEIVE   0xC0u /* B0 B1       */
#define RECEIVE_DISABLE   0xC5u
#define TRANSMIT_FRAME    0xC8u /* L0 L1 [A C when buffered] */
#define ABORT_TRANSMIT    0xCCu

#define RESULT_CODE  0x1Fu
#define WHOLE_OCTETS 0xE0u /* upper bits of RIC: the last octet has all eight bits. Other values are a [conflict] */

#define TRANSFER_BY_INTERRUPT 0x01u /* data transfer mode */
#define OPERATING_HDLC        0x20u /* an abort is seven ones, not eight */
#define OPERATING_EARLY       0x08u
#define OPERATING_BUFFERED    0x04u
#define OPERATING_PREFRAME    0x02u
#define OPERATING_FLAGS       0x01u
#define SERIAL_LOOP           0x04u /* serial I/O mode */
#define SERIAL_NRZI           0x01u

#define PARAMETERS_MAX 4u

/* Without DMA we drop what is too long ourselves, so that it can be answered FRMR when its FCS is good. */
#define UNLIMITED_LO 0xFFu
#define UNLIMITED_HI 0x0Fu

struct hdlc_frame XDATA hdlc_8273_out;
volatile struct hdlc_8273_counters XDATA hdlc_8273_counters;

/* One frame received, one being received: interrupts fill slot[filling], which is never full; main takes
 * slot[taking]. full[i] is set by interrupts only and cleared by main only, each as its last act on the slot. */
static struct hdlc_frame XDATA slot[2];
static volatile bool full[2];
static uint8_t filling, taking;

static uint8_t XDATA *HOT rx_at; /* where the next octet goes, while stored <= HDLC_FRAME_MAX */
static HOT uint8_t stored;       /* octets in slot[filling], saturates at HDLC_FRAME_MAX + 1  */
static HOT uint8_t offered;      /* octets the chip has handed over, modulo 256               */

static const uint8_t XDATA *HOT tx_at;
static HOT uint8_t tx_left;
static volatile bool sending;
static volatile bool deaf; /* the receiver is off because we send */
static uint16_t sending_since;

static uint8_t mode, address_1, address_2;
static volatile bool dead; /* the chip did not get ready in HDLC_8273_POLLS reads */

static inline bool by_dma(void)
{
    return (mode & HDLC_8273_DMA) != 0;
}

/* ---- commands ------------------------------------------------------------------------------------------ */

/* Until (status & mask) == want, but not for ever: after a failure no more waiting until the next reset. */
static bool wait_isr(uint8_t mask, uint8_t want) IN_ISR
{
    uint8_t left = HDLC_8273_POLLS;
    while (!dead) {
        if ((hal_8273_read(HAL_8273_STATUS) & mask) == want)
            return true;
        if (--left == 0)
            dead = true;
    }
    return false;
}

static void command_isr(uint8_t command) IN_ISR
{
    if (wait_isr(CBSY, 0))
        hal_8273_write(HAL_8273_COMMAND, command);
}

static void parameter_isr(uint8_t parameter) IN_ISR
{
    if (wait_isr(CPBF, 0))
        hal_8273_write(HAL_8273_PARAMETER, parameter);
}

/* ---- receiving ----------------------------------------------------------------------------------------- */

static void empty_slot_isr(void) IN_ISR
{
    const uint8_t head = mode & HDLC_8273_BUFFERED ? 2u : 0;

    rx_at = slot[filling].octets + head;
    stored = head;
    offered = 0;
}

/* The receiver starts over, hunting for a flag. After every error: whether it is still active is a [conflict]
 * for aborts, and it is off after idle, which on RS-485 follows every frame. */
static void listen_isr(void) IN_ISR
{
    uint8_t room;

    deaf = false;
    empty_slot_isr();
    room = (uint8_t)(sizeof slot[0].octets - stored);
    command_isr(RECEIVE_DISABLE);
    if (by_dma())
        hal_8273_dma_rx_isr(rx_at, room);
    command_isr(mode & HDLC_8273_ALL ? GENERAL_RECEIVE : SELECTIVE_RECEIVE);
    parameter_isr(by_dma() ? room : UNLIMITED_LO);
    parameter_isr(by_dma() ? 0 : UNLIMITED_HI);
    if (mode & HDLC_8273_ALL)
        return;
    parameter_isr(address_1);
    parameter_isr(address_2);
}

static void store_isr(uint8_t octet) IN_ISR
{
    offered++;
    if (stored > HDLC_FRAME_MAX)
        return;
    *rx_at++ = octet;
    stored++;
}

/* One more octet of a result. Whether RxIRA stays between them is a [conflict]: wait, a little. */
static bool more_isr(uint8_t XDATA *octet) IN_ISR
{
    uint8_t left = HDLC_8273_SETTLE;
    do {
        if (hal_8273_read(HAL_8273_STATUS) & RXIRA) {
            *octet = hal_8273_read(HAL_8273_RX_RESULT);
            return true;
        }
    } while (--left);
    return false;
}

/* R0 R1 octets handed over, and A C when buffered. -> a whole frame is in slot[filling]. */
static bool complete_isr(void) IN_ISR
{
    static uint8_t XDATA count[2];

    if (!more_isr(&count[0]) || !more_isr(&count[1]))
        return false;
    if (mode & HDLC_8273_BUFFERED)
        if (!more_isr(&slot[filling].octets[0]) || !more_isr(&slot[filling].octets[1]))
            return false;
    if (by_dma()) {
        if (count[1] || count[0] > sizeof slot[0].octets - stored)
            return false;
        stored = (uint8_t)(stored + count[0]);
    } else {
        if ((hal_8273_read(HAL_8273_STATUS) & (RXINT | RXIRA)) == RXINT) /* the result overtook the last octet */
            store_isr(hal_8273_read(HAL_8273_RX_DATA));
        if (count[0] != offered || (count[1] && stored <= HDLC_FRAME_MAX))
            return false;
    }
    return stored >= 2u; /* A and C */
}

/* A frame with good FCS, or what there is instead. -> enum hdlc_8273_rx. */
static uint8_t good_isr(uint8_t ric) IN_ISR
{
    if (!complete_isr())
        return HDLC_RX_COUNT;
    if ((ric & WHOLE_OCTETS) != WHOLE_OCTETS)
        return HDLC_RX_PARTIAL;
    if (full[filling ^ 1u])
        return HDLC_RX_FULL;
    slot[filling].n = stored;
    full[filling] = true;
    filling ^= 1u;
    return HDLC_RX_GOOD;
}

/* One octet or all of them after an error is a [conflict]: take what comes. One that comes later still is taken
 * for a result of its own and is none that could be a good frame. */
static void drain_isr(void) IN_ISR
{
    static uint8_t XDATA octet;
    uint8_t left = PARAMETERS_MAX;
    while (left && more_isr(&octet))
        left--;
}

void chip_rx_isr(void) IN_ISR
{
    const uint8_t status = hal_8273_read(HAL_8273_STATUS);
    uint8_t ric, code;

    if (!(status & RXINT))
        return;
    if (!(status & RXIRA)) {
        store_isr(hal_8273_read(HAL_8273_RX_DATA));
        return;
    }
    ric = hal_8273_read(HAL_8273_RX_RESULT);
    code = ric & RESULT_CODE;
    if (code <= 1u) {
        code = good_isr(ric);
    } else {
        drain_isr();
        if (code > HDLC_RX_RESULTS)
            code = HDLC_RX_UNKNOWN;
    }
    hdlc_8273_counters.rx[code]++;
    if (deaf)
        return;
    if (code == HDLC_RX_GOOD && !by_dma())
        empty_slot_isr(); /* all agree that it is active: the next frame may share this one's flag */
    else
        listen_isr();
}

const struct hdlc_frame XDATA *hdlc_8273_frame(void)
{
    return full[taking] ? &slot[taking] : NULL;
}

void hdlc_8273_release(void)
{
    ASSERT(full[taking]);
    full[taking] = false;
    taking ^= 1u;
}

/* ---- sending ------------------------------------------------------------------------------------------- */

static void transmit_isr(uint8_t n) IN_ISR
{
    const uint8_t head = mode & HDLC_8273_BUFFERED ? 2u : 0;

    tx_at = hdlc_8273_out.octets + head;
    tx_left = (uint8_t)(n - head);
    deaf = !(mode & HDLC_8273_LOOP);
    if (deaf)
        command_isr(RECEIVE_DISABLE);
    if (by_dma() && tx_left)
        hal_8273_dma_tx_isr(tx_at, tx_left);
    command_isr(TRANSMIT_FRAME);
    parameter_isr(tx_left);
    parameter_isr(0);
    if (head == 0)
        return;
    parameter_isr(hdlc_8273_out.octets[0]);
    parameter_isr(hdlc_8273_out.octets[1]);
}

void hdlc_8273_send(uint8_t n)
{
    uint8_t irq;

    ASSERT(n >= 2u && n <= HDLC_FRAME_MAX && !sending);
    sending_since = hal_ticks();
    irq = hal_irq_save();
    sending = true;
    transmit_isr(n);
    hal_irq_restore(irq);
}

bool hdlc_8273_sending(void)
{
    return sending;
}

void hdlc_8273_abort(void)
{
    const uint8_t irq = hal_irq_save();
    if (sending)
        command_isr(ABORT_TRANSMIT);
    hal_irq_restore(irq);
}

void chip_tx_isr(void) IN_ISR
{
    const uint8_t status = hal_8273_read(HAL_8273_STATUS);
    uint8_t index;

    if (!(status & TXINT))
        return;
    if (!(status & TXIRA)) {
        hal_8273_write(HAL_8273_TX_DATA, *tx_at);
        if (tx_left > 1u) { /* what is asked for beyond our own length repeats the last octet */
            tx_left--;
            tx_at++;
        }
        return;
    }
    index = (uint8_t)((hal_8273_read(HAL_8273_TX_RESULT) & RESULT_CODE) - 0x0Cu);
    if (index > HDLC_TX_ABORTED)
        index = HDLC_TX_UNKNOWN;
    hdlc_8273_counters.tx[index]++;
    if (index == HDLC_TX_EARLY || !sending)
        return;
    sending = false;
    listen_isr();
}

/* ---- setting up ---------------------------------------------------------------------------------------- */

/* 01 then 00 into the reset register. Its offset is a [conflict], 2 or 1. So offset 2 is written; only a chip that
 * stays in the middle of a command gets the same at offset 1, where it is a reset, or the parameters that the
 * command still waits for. What else a reset does is done again by commands below. */
static void reset_isr(void) IN_ISR
{
    uint8_t i;

    dead = false;
    hal_8273_write(HAL_8273_RESET, 1);
    for (i = 0; i < HDLC_8273_SETTLE; i++)
        (void)hal_8273_read(HAL_8273_STATUS);
    hal_8273_write(HAL_8273_RESET, 0);
    for (i = 0; i < PARAMETERS_MAX && !wait_isr(CBSY, 0); i++) {
        hal_8273_write(HAL_8273_PARAMETER, 1);
        hal_8273_write(HAL_8273_PARAMETER, 0);
        dead = false;
    }
    (void)hal_8273_read(HAL_8273_TX_RESULT);
    (void)hal_8273_read(HAL_8273_RX_RESULT);
}

/* Set commands or their mask to a register, reset commands and it. */
static void program_isr(uint8_t reset, uint8_t set, uint8_t value) IN_ISR
{
    command_isr(reset);
    parameter_isr(0);
    command_isr(set);
    parameter_isr(value);
}

static void set_up_isr(void) IN_ISR
{
    uint8_t operating = OPERATING_HDLC;

    if (mode & HDLC_8273_FLAGS)
        operating |= OPERATING_FLAGS;
    if (mode & HDLC_8273_PREFRAME)
        operating |= OPERATING_PREFRAME;
    if (mode & HDLC_8273_BUFFERED)
        operating |= OPERATING_BUFFERED;
    if (mode & HDLC_8273_EARLY)
        operating |= OPERATING_EARLY;
    reset_isr();
    program_isr(HDLC_8273_RESET_OPERATING, HDLC_8273_SET_OPERATING, operating);
    program_isr(HDLC_8273_RESET_TRANSFER, HDLC_8273_SET_TRANSFER, by_dma() ? 0 : (uint8_t)TRANSFER_BY_INTERRUPT);
    program_isr(HDLC_8273_RESET_SERIAL, HDLC_8273_SET_SERIAL,
                (uint8_t)((mode & HDLC_8273_NRZI ? SERIAL_NRZI : 0) | (mode & HDLC_8273_LOOP ? SERIAL_LOOP : 0)));
    program_isr(HDLC_8273_RESET_DELAY, HDLC_8273_SET_DELAY, 0);
    if (sending)
        command_isr(ABORT_TRANSMIT); /* where the reset was none */
    sending = false;
    listen_isr();
}

bool hdlc_8273_open(uint8_t how, uint8_t a1, uint8_t a2)
{
    const uint8_t irq = hal_irq_save();
    uint8_t i;

    mode = how;
    address_1 = a1;
    address_2 = a2;
    full[0] = full[1] = false;
    filling = taking = 0;
    for (i = 0; i < HDLC_RX_COUNTERS; i++)
        hdlc_8273_counters.rx[i] = 0;
    for (i = 0; i < HDLC_TX_COUNTERS; i++)
        hdlc_8273_counters.tx[i] = 0;
    set_up_isr();
    hal_irq_restore(irq);
    return !dead;
}

void hdlc_8273_poll(void)
{
    uint8_t irq;

    if (!dead && !(sending && (uint16_t)(hal_ticks() - sending_since) > HDLC_SEND_MS))
        return;
    irq = hal_irq_save();
    hdlc_8273_counters.tx[HDLC_TX_RESTARTS]++;
    set_up_isr();
    hal_irq_restore(irq);
}

bool hdlc_8273_mask(uint8_t command, uint8_t mask)
{
    const uint8_t irq = hal_irq_save();
    command_isr(command);
    parameter_isr(mask);
    hal_irq_restore(irq);
    return !dead;
}

int16_t hdlc_8273_port(uint8_t command)
{
    int16_t value = -1;
    const uint8_t irq = hal_irq_save();
    command_isr(command);
    if (wait_isr(CRBF, CRBF))
        value = hal_8273_read(HAL_8273_RESULT);
    hal_irq_restore(irq);
    return value;
}
