/* Modbus serial line, ASCII mode.
 *
 *     ':'  address  function  data...  LRC  CR  LF       each octet as two of 0-9 A-F, high half first
 *
 * Layer    mb_line -> [mb_ascii], same context as mb_line
 * Source   [S] 2.5.2; LRC 2.5.2.2 and 6.2.1 (two's complement of the sum: over a good frame the sum is 0)
 */
#include "modbus/mb_line.h"

#define LRC_LEN   1u
#define FRAME_MIN 3u /* address, function code, LRC */
#define FRAME_MAX (1u + MB_PDU_MAX + LRC_LEN)
#define OCTET_MS  1000u /* [S] 2.5.2.1: "intervals of up to one second" */
#define NO_DIGIT  0xFFu

uint8_t XDATA mb_delimiter, mb_next_delimiter;

/* ---- interrupts ---------------------------------------------------------------------------------------- */

/* Our choice: small letters are not digits, [S] 2.5.2 allows 0-9 A-F only. */
static uint8_t digit_isr(uint8_t c) IN_ISR
{
    if ((uint8_t)(c - '0') <= 9u)
        return (uint8_t)(c - '0');
    if ((uint8_t)(c - 'A') <= 5u)
        return (uint8_t)(c - 'A' + 10u);
    return NO_DIGIT;
}

static uint8_t drop_isr(void) IN_ISR
{
    mb_frame_end_isr(0);
    return MB_COLON;
}

static uint8_t st_high_isr(uint8_t c) IN_ISR
{
    const uint8_t digit = digit_isr(c);
    if (c == '\r')
        return MB_END;
    if (digit == NO_DIGIT || mb_rx.n == FRAME_MAX)
        return drop_isr();
    mb_adu[mb_rx.n] = (uint8_t)(digit << 4);
    return MB_LOW;
}

static uint8_t st_low_isr(uint8_t c) IN_ISR
{
    const uint8_t digit = digit_isr(c);
    if (digit == NO_DIGIT)
        return drop_isr();
    mb_adu[mb_rx.n] |= digit;
    mb_rx.lrc = (uint8_t)(mb_rx.lrc + mb_adu[mb_rx.n]);
    mb_rx.n++;
    return MB_HIGH;
}

static uint8_t st_end_isr(uint8_t c) IN_ISR
{
    if (c != mb_delimiter || mb_rx.lrc || mb_rx.n < FRAME_MIN)
        return drop_isr();
    mb_frame_end_isr((uint8_t)(mb_rx.n - 1u - LRC_LEN));
    return mb_rx.state;
}

static uint8_t start_isr(void) IN_ISR
{
    if (mb_rx.state != MB_COLON)
        mb_frame_end_isr(0); /* a frame was broken off */
    mb_rx.n = 0;
    mb_rx.lrc = 0;
    return MB_HIGH;
}

void mb_ascii_octet_isr(uint8_t octet, uint8_t err) IN_ISR
{
    uint8_t next = MB_COLON;
    mb_rx.fresh = true;
    mb_rx.flaws = err;
    if (err)
        next = mb_rx.state == MB_COLON ? MB_COLON : drop_isr(); /* between frames it is noise */
    else if (octet == ':')
        next = start_isr();
    else if (mb_rx.state == MB_HIGH)
        next = st_high_isr(octet);
    else if (mb_rx.state == MB_LOW)
        next = st_low_isr(octet);
    else if (mb_rx.state == MB_END)
        next = st_end_isr(octet);
    mb_rx.state = next;
}

/* ---- main ---------------------------------------------------------------------------------------------- */

/* The time between two characters, to the accuracy of one pass of the main loop. */
void mb_ascii_poll(void)
{
    static uint16_t XDATA since;
    const uint16_t now = hal_ticks();
    const uint16_t limit = mb_port.octet_ms ? mb_port.octet_ms : OCTET_MS;
    const uint8_t irq = hal_irq_save();
    if (mb_rx.fresh || mb_rx.state < MB_HIGH || mb_rx.state > MB_END) {
        mb_rx.fresh = false;
        since = now;
    } else if ((uint16_t)(now - since) > limit) {
        mb_frame_end_isr(0);
    }
    hal_irq_restore(irq);
}

static uint8_t hex(uint8_t half)
{
    return (uint8_t)(half < 10 ? half + '0' : half - 10 + 'A');
}

/* From the back, so that no octet is overwritten before it is spelt: octet i goes to 1+2i and 2+2i. */
uint16_t mb_ascii_encode(void)
{
    uint16_t i;
    uint8_t XDATA *to;
    uint8_t sum = 0;
    for (i = 0; i <= mb_pdu_len; i++)
        sum = (uint8_t)(sum + mb_adu[i]);
    mb_adu[i++] = (uint8_t)(0u - sum);
    to = mb_adu + 2u * i;
    to[1] = '\r';
    to[2] = mb_delimiter;
    mb_delimiter = mb_next_delimiter;
    to++;
    while (i--) {
        const uint8_t octet = mb_adu[i];
        *--to = hex(octet & 15u);
        *--to = hex(octet >> 4);
    }
    *--to = ':';
    return (uint16_t)(2u * mb_pdu_len + 7u); /* ':' + 2 (address + PDU + LRC) + CR LF */
}
