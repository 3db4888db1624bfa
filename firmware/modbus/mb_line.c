/* Modbus serial line, what both modes share, and RTU.
 *
 * Layer    hal -> [mb_line, mb_ascii] -> mb_server; implements line_octet_isr, line_silence_isr,
 *          line_sent_isr
 * Source   [S] 2.5.1 RTU framing, figure 14 its states, 2.5.1.2 CRC, appendix A the counters
 *
 * A frame is what stands between two silences, whatever its contents: only that keeps a server in step on a
 * line with other servers, absent ones and noise. The CRC is worked out as the octets come, so that nothing
 * is left to do for it when the frame has ended.
 */
#include "modbus/mb_line.h"
#include "crc16.h"

struct mb_port XDATA mb_port;
struct mb_frame XDATA mb_frame;
HOT struct mb_rx mb_rx;

#define CHAR_TBIT 11u /* [S] 2.5.1: always, in RTU */
#define CRC_LEN   2u
#define FRAME_MIN 4u /* address, function code, CRC */

/* ---- main ---------------------------------------------------------------------------------------------- */

/* [S] 2.5.1.1: 1.5 and 3.5 characters up to 19200 bit/s, above it 750 us and 1.75 ms (worked out without a
 * division: 49/256 and 29/64 of the bits in 1/256 s). A port reports an octet when it is complete, so a gap
 * of 1.5 characters shows as 1.5 + 1 characters between two reports. */
static void set_gaps(void)
{
    const uint16_t k = (uint16_t)(mb_port.bit_per_s >> 8);
    uint16_t t15 = mb_port.gap_tbit;
    uint16_t t35 = t15;
    if (t35 == 0) {
        t15 = CHAR_TBIT + 17u;
        t35 = 39u;
        if (mb_port.bit_per_s > 19200u) {
            t15 = (uint16_t)(CHAR_TBIT + (k * 49u >> 8));
            t35 = (uint16_t)(1u + (k * 29u >> 6));
        }
    }
    mb_rx.t15 = hal_tbit(t15);
    mb_rx.t35 = hal_tbit(t35);
}

uint8_t mb_open(void)
{
    uint8_t line;
    uint8_t irq;
    if ((uint8_t)(mb_port.address - 1u) >= 247u || mb_port.mode > (MB_WITH_ASCII ? MB_ASCII : MB_RTU))
        return HAL_LINE_NO;
    irq = hal_irq_save();
    line = hal_line_open(mb_port.bit_per_s, mb_port.format);
    if (line != HAL_LINE_NO) {
        set_gaps();
        if (MB_WITH_ASCII && mb_port.mode == MB_ASCII) {
            mb_rx.state = mb_rx.idle = MB_COLON;
            mb_delimiter = mb_next_delimiter = '\n';
        } else {
            mb_rx.state = MB_INITIAL;
            mb_rx.idle = MB_IDLE;
            hal_silence(mb_rx.t35);
        }
    }
    hal_irq_restore(irq);
    return line;
}

/* -> octets of the frame */
static uint16_t append_crc(void)
{
    const uint_fast8_t n = (uint_fast8_t)(mb_pdu_len + 1u);
    crc16_append(mb_adu, n);
    return (uint16_t)(n + CRC_LEN);
}

/* Our choice: when something was heard after the request, its client has given up and is talking again; it is
 * not talked into. What comes then has lost its start: in RTU nothing is taken before t3.5 of silence (which,
 * if nothing was heard, is over). */
void mb_line_end(bool answered)
{
    const uint16_t n = mb_is_ascii ? mb_ascii_encode() : append_crc();
    const uint8_t irq = hal_irq_save();
    if (answered && !mb_rx.flaws) {
        mb_rx.state = MB_SENDING;
        hal_send(mb_adu, n);
    } else {
        mb_rx.state = mb_is_ascii ? MB_COLON : MB_INITIAL;
        hal_silence(mb_rx.t35);
    }
    hal_irq_restore(irq);
}

/* ---- interrupts ---------------------------------------------------------------------------------------- */

void mb_frame_end_isr(uint8_t pdu_len) IN_ISR
{
    mb_rx.state = mb_idle_state;
    if (pdu_len == 0) {
        if (MB_HAS_DIAGNOSTICS)
            mb_bad_frame_isr(mb_rx.flaws);
        return;
    }
    if (MB_HAS_DIAGNOSTICS)
        mb_diag.counter[MB_BUS_MESSAGE]++;
    if (mb_adu[0] == 0 || mb_adu[0] == mb_port.address) {
        mb_pdu_len = pdu_len;
        mb_rx.flaws = 0;
        mb_rx.state = MB_READY;
    }
}

/* Our choice, for lines that come in lumps: the answer of another station and the client's next request may
 * come without a silence to tell them apart. What is a whole good frame of another station ends there. (Not
 * so a frame to us: by its contents alone nothing is executed.) */
static bool foreign_frame_isr(void) IN_ISR
{
    return mb_port.gap_tbit != 0 && mb_rx.state == MB_RECEPTION && mb_rx.crc == 0 && mb_rx.flaws == 0 &&
           mb_rx.n >= FRAME_MIN && mb_adu[0] != 0 && mb_adu[0] != mb_port.address;
}

void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    if (MB_WITH_ASCII && mb_rx.state >= MB_COLON && mb_rx.state <= MB_END) {
        mb_ascii_octet_isr(octet, err);
        return;
    }
    if (MB_WITH_LUMPS && foreign_frame_isr())
        mb_frame_end_isr((uint8_t)(mb_rx.n - 1u - CRC_LEN));
    if (mb_rx.state == MB_IDLE) {
        mb_rx.state = MB_RECEPTION;
        mb_rx.n = 0;
        mb_rx.flaws = 0;
        mb_rx.crc = CRC16_START;
        hal_silence(mb_rx.t15);
    }
    if (mb_rx.state == MB_RECEPTION && mb_rx.n < MB_RTU_MAX) {
        mb_adu[mb_rx.n++] = octet;
        crc16_take(&mb_rx.crc, octet);
    } else {
        err |= MB_FLAW;
    }
    mb_rx.flaws |= err;
}

/* A gap between 1.5 and 3.5 characters spoils the frame; it ends when the line has been silent for 3.5 after
 * the last octet, whichever that was (the port measures from there). */
void line_silence_isr(void) IN_ISR
{
    switch (mb_rx.state) {
    case MB_RECEPTION:
        mb_rx.state = MB_CONTROL;
        hal_silence(mb_rx.t35);
        break;
    case MB_CONTROL:
        if (mb_rx.flaws || mb_rx.n < FRAME_MIN || mb_rx.crc)
            mb_frame_end_isr(0);
        else
            mb_frame_end_isr((uint8_t)(mb_rx.n - 1u - CRC_LEN));
        break;
    case MB_INITIAL:
        mb_rx.state = MB_IDLE;
        break;
    default: /* an idle line, the limit is still set */
        break;
    }
}

/* Our choice: the next frame may start at once, [S] figure 14 would wait t3.5 first. A client that keeps t3.5
 * sees no difference; one on a pty, that asks again as soon as it has its answer, is served. */
void line_sent_isr(void) IN_ISR
{
    mb_rx.state = mb_idle_state;
}
