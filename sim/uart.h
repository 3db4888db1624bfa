/* A receiver that listens to levels, for all that whole octets cannot express: a wrong rate, a flipped start
 * or stop bit. Samples once in the middle of a bit; after a missing stop bit it waits for the line to rise.
 */
#ifndef SIM_UART_H
#define SIM_UART_H

#include <stdbool.h>
#include <stdint.h>

/* n levels of one bit time each; the line is 1 before and after. */
struct uart_wave {
    const uint8_t *level;
    unsigned n;
    uint64_t bit;
};

struct uart_octet {
    uint8_t octet;
    bool parity_error, framing_error;
    uint64_t end;    /* of the stop bit as the receiver sees it, from the start of the wave */
    uint64_t resume; /* a next start bit may begin here                                     */
};

/* The 11 levels of an octet: start, 8 data bits from the lowest, even parity, stop. */
void uart_levels(uint8_t octet, uint8_t level[11]);

/* The first character whose start bit falls at or after `from`, as a receiver with bit time rx_bit hears it.
 * False: there is none. */
bool uart_next(const struct uart_wave *w, uint64_t from, uint64_t rx_bit, struct uart_octet *o);

#endif
