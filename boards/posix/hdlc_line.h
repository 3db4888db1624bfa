/* The modelled 8273 of a host program on hal.h's line: what its bits look like as octets of a pseudo terminal.
 *
 *   bits    the line itself: eight bits an octet, the first one least significant, flags and inserted zeros
 *           and FCS included, padded with ones (idle) to a whole octet
 *   octets  one frame after another as on asynchronous HDLC (RFC 1662): 7E, address, control, information,
 *           FCS, 7E; 7E and 7D inside go out as 7D 5E and 7D 5D
 *
 * Time on the line goes by with what is received and sent; silence is idle. Context: main, but for line_*_isr.
 */
#ifndef FIELDLING_HDLC_LINE_H
#define FIELDLING_HDLC_LINE_H

#include "sim/hdlc_bits.h"

enum hdlc_coding { HDLC_CODING_BITS, HDLC_CODING_OCTETS };

/* Power the chip up, open the line and listen. After hal_init(), before the station's init. -> enum hal_line. */
uint8_t hdlc_line_open(uint32_t bit_per_s, enum hdlc_coding coding);

/* Each pass of the main loop, after the station's: put on the line what the chip sends. */
void hdlc_line_poll(void);

/* Bits on the line so far, both directions. */
extern uint64_t hdlc_line_bits;

/* For a trace; NULL: nobody listens. Everything the decoder sees on the line; octets[0..n-1] without FCS where
 * event is HB_FRAME or HB_BAD_FCS. */
extern void (*hdlc_line_tap)(enum hb_event event, const uint8_t *octets, unsigned n, bool sent);

#endif
