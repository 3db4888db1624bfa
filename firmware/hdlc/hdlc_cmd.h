/* Control octet of HDLC, modulo 8. Source: ISO 13239 5.3, tables of commands and responses.
 *
 *            b7 b6 b5   b4    b3 b2 b1   b0
 *   I        N(R)       P/F   N(S)       0
 *   S        N(R)       P/F   S  S  0    1
 *   U        M  M  M    P/F   M  M  1    1      (b0 goes out first)
 */
#ifndef FIELDLING_HDLC_CMD_H
#define FIELDLING_HDLC_CMD_H

#include "check.h"

#define HDLC_PF 0x10u /* poll in a command, final in a response */

/* Control octets without P/F, N(R) and N(S) 0. */
#define HDLC_C_I    0x00u
#define HDLC_C_RR   0x01u
#define HDLC_C_RNR  0x05u
#define HDLC_C_REJ  0x09u
#define HDLC_C_UI   0x03u
#define HDLC_C_DM   0x0Fu
#define HDLC_C_DISC 0x43u
#define HDLC_C_UA   0x63u
#define HDLC_C_SNRM 0x83u
#define HDLC_C_FRMR 0x87u
#define HDLC_C_XID  0xAFu
#define HDLC_C_TEST 0xE3u

enum hdlc_kind {
    HDLC_I,
    HDLC_RR,
    HDLC_RNR,
    HDLC_REJ,
    HDLC_UI,
    HDLC_SNRM,
    HDLC_DISC,
    HDLC_TEST,
    HDLC_XID,
    HDLC_UNDEFINED, /* not a command of ours */
};

static inline uint8_t hdlc_nr(uint8_t control)
{
    return (uint8_t)(control >> 5);
}

static inline uint8_t hdlc_ns(uint8_t control)
{
    return (uint8_t)((control >> 1) & 7u);
}

/* The command a control octet is -> enum hdlc_kind. Any context but interrupts. */
uint8_t hdlc_kind(uint8_t control);

/* May that command carry an information field? Of an undefined one nothing is known: yes. */
bool hdlc_may_carry_info(uint8_t kind);

/* Does that command carry N(R)? */
bool hdlc_has_nr(uint8_t kind);

#endif
