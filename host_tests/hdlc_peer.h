/* The primary's side of an HDLC line, for tests of the secondary and of what runs on it: frames in hexadecimal.
 *
 * Two lines implement the lower half: hdlc_peer_chip.c has the driver, the modelled 8273 and a line of bits below the
 * station; hdlc_peer_fake.c stands in for the driver and is portable like the stack, so that the same tests run on the targets'
 * simulators. No large locals here and in the tests: an 8051's stack has some 100 octets.
 */
#ifndef HDLC_PEER_H
#define HDLC_PEER_H

#include "check.h"
#include "unity.h"

#define PEER_OCTETS 300u /* longest frame */

/* What the station did. */
struct hdlc_peer {
    uint8_t answer[PEER_OCTETS];
    unsigned answer_n; /* octets of its last frame, A C I  */
    unsigned answers;  /* frames since peer_clear()        */
};
extern struct hdlc_peer peer;

/* ---- the line ---- */

/* Machine and chip as after power-up, 7200 bit/s; init runs with interrupts masked, loop is the main loop. */
void peer_begin(void (*init)(void), void (*loop)(void));

/* The station has used port, chip and line by the rules, or the test fails. At the end of a test. */
void peer_end(void);

/* So many bit times go by; the main loop comes round in each (in long silences less often). */
void peer_run(uint32_t bits);

/* Send a frame, A C I. */
void peer_say(const uint8_t *octets, unsigned n);

/* Send a frame, wait for the answer and until the line is idle. -> there was exactly one. */
bool peer_ask(const uint8_t *octets, unsigned n);

void peer_clear(void);

/* An interrupt of the board happens. */
void peer_interrupt(void (*isr)(void));

/* ---- "05 93" ---- */

/* -> octets */
unsigned peer_hex(const char *hex, uint8_t *octets);

/* The station answers a with one frame, which is the expected one / with nothing. */
#define ANSWERS(command, answer) peer_answers(command, answer, __LINE__)
#define SILENT(command)          peer_silent(command, __LINE__)
#define ANSWER_IS(answer)        peer_answer_is(answer, __LINE__)
void peer_answers(const char *command, const char *answer, UNITY_LINE_TYPE line);
void peer_silent(const char *command, UNITY_LINE_TYPE line);
void peer_answer_is(const char *answer, UNITY_LINE_TYPE line);

#endif
