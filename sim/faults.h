/* What goes wrong on a line: one entry a fault, with its real-world reason. Every end-to-end test runs under
 * each.
 *
 * A fault is described to whoever carries the octets (sim/bus.c in virtual time, sim/segment_main.c over
 * ptys).
 */
#ifndef SIM_FAULTS_H
#define SIM_FAULTS_H

#include "sim/telegram.h"

#define FLT_LIST(F)                                                                                          \
    F(NONE, "a good line")                                                                                   \
    F(ONE_BIT, "a spike on a long cable turns one bit: parity tells")                                        \
    F(TWO_BITS, "a longer spike turns two bits of an octet: parity does not tell, FCS does")                 \
    F(PARITY, "noise margin lost at the end of an octet: only its parity bit")                               \
    F(FRAMING, "a sender's clock is off: the stop bit is missed")                                            \
    F(LOST_OCTET, "a repeater's receiver overruns: one octet is missing")                                    \
    F(DOUBLED_OCTET, "a converter's buffer is read twice: one octet comes again")                            \
    F(TRUNCATED, "the sender is reset: the rest is missing")                                                 \
    F(STRETCHED, "a USB converter pauses between two packets: idle inside the telegram")                     \
    F(NOISE_BEFORE, "the driver glitches when enabled: an octet just before the telegram")                   \
    F(NOISE_AFTER, "the line rings when the driver is disabled: octets just behind")                         \
    F(LOST_REQUEST, "a bad contact: the request does not arrive")                                            \
    F(LOST_ANSWER, "a bad contact: the answer does not arrive")                                              \
    F(ANSWER_BIT, "a spike turns one bit of the answer")                                                     \
    F(ANSWER_CUT, "the answer breaks off")                                                                   \
    F(LATE_ANSWER, "another station answers its last request now, too late")                                 \
    F(FOREIGN, "another master polls another station in between")                                            \
    F(COLLISION, "a second station with a wrong address talks at the same time")                             \
    F(OTHER_RATE, "a station is set to another rate and talks in between")                                   \
    F(BREAK, "a short circuit holds the line low for a while")

enum flt {
#define FLT_NAME(name, reason) FLT_##name,
    FLT_LIST(FLT_NAME)
#undef FLT_NAME
        FLT_KINDS
};

const char *flt_reason(enum flt kind);

/* One character as it really arrives: idle T_bit before it, octet, HAL_ERR_PARITY/FRAMING. */
struct flt_char {
    uint16_t idle;
    uint8_t octet, err;
};
#define FLT_CHARS (TG_MAX + 8)

/* What becomes of a request octets[0..n-1]: chars to send instead (may be none). -> how many; -1: it passes
 * as it is. */
int flt_request(enum flt kind, uint64_t *random, const uint8_t *octets, unsigned n,
                struct flt_char out[FLT_CHARS]);

/* Somebody else's octets before the request (LATE_ANSWER, FOREIGN, OTHER_RATE) or with it (COLLISION). -> how
 * many. */
unsigned flt_stranger(enum flt kind, uint64_t *random, uint8_t octets[TG_MAX]);

/* Octet i of an answer of about n. False: it does not arrive. */
bool flt_answer(enum flt kind, unsigned hit, unsigned i, uint8_t *octet, uint8_t *err);

/* Does the fault touch the answer rather than the request? */
bool flt_hits_answer(enum flt kind);

#endif
