#include "hdlc_line.h"
#include "hal/hal.h"
#include "hal/posix/hal_8273_model.h"

/* our choice: longer than any pause a host makes inside a frame; and bits enough to be idle (15). */
#define SILENCE_TBIT 360u
#define IDLE_BITS    16u

#define RFC1662_FLAG   0x7Eu
#define RFC1662_ESCAPE 0x7Du
#define RFC1662_XOR    0x20u

uint64_t hdlc_line_bits;
void (*hdlc_line_tap)(enum hb_event event, const uint8_t *octets, unsigned n, bool sent);

static struct {
    enum hdlc_coding coding;
    struct hb_decoder heard, said;
    uint8_t frame[HB_OCTETS + 2u]; /* octets coding: the frame being received */
    unsigned n;
    bool in_frame, escaped;
    uint8_t out[HB_BITS / 8u];
    uint16_t out_n;
    bool busy; /* the port is sending out[] */
} line;

static void note(struct hb_decoder *d, unsigned bit, bool sent)
{
    const enum hb_event event = hb_decode(d, bit);

    hdlc_line_bits++;
    if (event != HB_NOTHING && hdlc_line_tap)
        hdlc_line_tap(event, d->octets, event == HB_FRAME || event == HB_BAD_FCS ? d->n : 0, sent);
}

/* ---- receiving ----------------------------------------------------------------------------------- */

static void hear_bit_isr(bool bit) IN_ISR
{
    note(&line.heard, bit, false);
    i8273_shift_out(&hal_8273_chip);
    i8273_shift_in(&hal_8273_chip, bit);
    hal_8273_serve_isr();
}

static void hear_frame_isr(void) IN_ISR
{
    static struct hb_line bits;

    bits.n = bits.ones = bits.inserted = 0;
    hb_flag(&bits);
    hb_stuffed(&bits, line.frame, line.n);
    hb_flag(&bits);
    for (unsigned i = 0; i < bits.n; i++)
        hear_bit_isr(bits.bit[i]);
}

static void hear_coded_isr(uint8_t octet) IN_ISR
{
    if (octet == RFC1662_FLAG) {
        if (line.in_frame && line.n > 0 && !line.escaped)
            hear_frame_isr();
        line.in_frame = true;
        line.escaped = false;
        line.n = 0;
    } else if (octet == RFC1662_ESCAPE) {
        line.escaped = true;
    } else if (line.in_frame) {
        if (line.n == sizeof line.frame) {
            line.in_frame = false;
            return;
        }
        line.frame[line.n++] = line.escaped ? octet ^ RFC1662_XOR : octet;
        line.escaped = false;
    }
}

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    (void)err; /* a pty makes none; the FCS tells */
    if (line.coding == HDLC_CODING_OCTETS)
        hear_coded_isr(octet);
    else
        for (unsigned i = 0; i < 8u; i++)
            hear_bit_isr((octet >> i) & 1u);
}

void line_silence_isr(void) IN_ISR
{
    const uint64_t bits = hdlc_line_bits;

    for (unsigned i = 0; i < IDLE_BITS; i++)
        hear_bit_isr(true);
    hdlc_line_bits = bits; /* nobody drove them */
}

void line_sent_isr(void) IN_ISR
{
    line.busy = false;
}

/* ---- sending ------------------------------------------------------------------------------------- */

static void put_octet(uint8_t octet)
{
    if (line.out_n < sizeof line.out)
        line.out[line.out_n++] = octet;
}

static void put_coded(uint8_t octet)
{
    if (octet == RFC1662_FLAG || octet == RFC1662_ESCAPE) {
        put_octet(RFC1662_ESCAPE);
        octet ^= RFC1662_XOR;
    }
    put_octet(octet);
}

static void put_frame(const struct hb_decoder *d)
{
    put_octet(RFC1662_FLAG);
    for (unsigned i = 0; i < d->n + 2u; i++) /* with FCS */
        put_coded(d->octets[i]);
    put_octet(RFC1662_FLAG);
}

/* Let the chip send all it has to; -> bits. In octets coding only whole good frames go out. */
static unsigned run_chip(struct hb_line *bits)
{
    static struct hb_decoder whole;
    bits->n = 0;

    do {
        i8273_shift_out(&hal_8273_chip);
        if (hal_8273_chip.rts) {
            note(&line.said, hal_8273_chip.txd, true);
            hb_raw(bits, hal_8273_chip.txd, 1);
            if (hb_decode(&whole, hal_8273_chip.txd) == HB_FRAME && line.coding == HDLC_CODING_OCTETS)
                put_frame(&whole);
        }
        i8273_shift_in(&hal_8273_chip, true);
        hal_8273_serve_isr();
    } while (hal_8273_chip.tx.state != TX_IDLE && bits->n < HB_BITS);
    return bits->n;
}

static void pack(const struct hb_line *bits)
{
    for (unsigned i = 0; i < bits->n; i += 8u) {
        uint8_t octet = 0xFF;
        for (unsigned k = 0; k < 8u && i + k < bits->n; k++)
            if (!bits->bit[i + k])
                octet &= (uint8_t)~(1u << k);
        put_octet(octet);
    }
}

void hdlc_line_poll(void)
{
    static struct hb_line bits;
    uint8_t irq;

    if (line.busy || hal_8273_chip.tx.state == TX_IDLE)
        return;
    irq = hal_irq_save();
    line.out_n = 0;
    run_chip(&bits);
    if (line.coding == HDLC_CODING_BITS)
        pack(&bits);
    if (line.out_n) {
        line.busy = true;
        hal_send(line.out, line.out_n);
    }
    hal_irq_restore(irq);
}

uint8_t hdlc_line_open(uint32_t bit_per_s, enum hdlc_coding coding)
{
    uint8_t how;

    i8273_power_on(&hal_8273_chip);
    line.coding = coding;
    how = hal_line_open(bit_per_s, HAL_8N1);
    if (how != HAL_LINE_NO) {
        const uint8_t irq = hal_irq_save();
        hal_silence(hal_tbit(SILENCE_TBIT));
        hal_irq_restore(irq);
    }
    return how;
}
