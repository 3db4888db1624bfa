/* What has waited while main held the lock.
 *
 * Order: silence, octets, error, silence. A silence before the octets and one behind them are kept apart; there is no
 * third one, because no lock lasts for two telegrams. All of it is written and read in interrupts; main only opens
 * the lock and rings.
 */
#include <8052.h>

#include "hal/mcs51/mcs51.h"

volatile __bit held_any;
static volatile __bit silence_first;
static volatile __bit silence_last;
static volatile __bit sent;

/* Invariant: held_out <= held_in <= HELD_MAX. */
IDATA uint8_t held[HELD_MAX];
IDATA uint8_t held_in;
IDATA uint8_t held_out;
static IDATA uint8_t err; /* behind the octets; what follows it is not kept */

/* A silence that was reported late and cut short by this octet was none. */
void hold_octet_isr(void) __using(2)
{
    held_any = 1;
    silence_last = 0;
    if (err)
        return;
    if (octet_err) {
        err = octet_err;
    } else if (held_in == HELD_MAX) {
        err = HAL_ERR_OVERRUN;
    } else {
        held[held_in] = octet;
        held_in++;
    }
}

void hold_silence_isr(void) __using(2)
{
    held_any = 1;
    if (held_in || err)
        silence_last = 1;
    else
        silence_first = 1;
}

void hold_sent_isr(void) __using(2)
{
    held_any = 1;
    sent = 1;
}

void held_drop_isr(void) IN_ISR
{
    held_any = 0;
    silence_first = 0;
    silence_last = 0;
    sent = 0;
    held_in = 0;
    held_out = 0;
    err = 0;
}

/* Octets go on arriving meanwhile. */
bool held_octet_isr(void) __using(2)
{
    if (RI) {
        receive_isr();
        hold_octet_isr();
    }
    if (held_out != held_in) {
        octet = held[held_out];
        held_out++;
        octet_err = 0;
        return true;
    }
    octet_err = err;
    err = 0;
    held_in = 0;
    held_out = 0;
    return octet_err != 0;
}

static void silence_isr(void) __using(2)
{
    armed = 0;
    line_silence_isr();
}

void held_serve_isr(void) __using(2)
{
    if (sent) {
        sent = 0;
        line_sent_isr();
    }
    if (silence_first) {
        silence_first = 0;
        silence_isr();
    }
    serve_octets_isr();
    held_any = 0;
    if (silence_last) {
        silence_last = 0;
        silence_isr();
    }
    look_isr();
}
