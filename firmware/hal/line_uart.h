/* The line of hal.h over a plain UART and a one-shot timer: what a port with such hardware has to supply, and what it
 * gets for it.
 *
 * Most UARTs tell when a character has come and when there is room for the next, but not when the last stop bit is out.
 * line_uart.c makes of that and of one timer the line that hal.h promises: silence measured from the last octet, the
 * receiver looked at before a silence is reported, sending without a gap, the driver dropped by the timer when the shift
 * register is empty. A port is then the functions below, in a header "uart.h" of its architecture (static inline, so
 * that an interrupt pays for no call), and its interrupt handlers.
 *
 * An octet costs a look at the clock, not a restart of the timer: the timer runs on, and when it fires too early for the
 * last octet it is started again for the rest. So it may always fire early, and a timer of few bits will do.
 */
#ifndef FIELDLING_HAL_LINE_UART_H
#define FIELDLING_HAL_LINE_UART_H

#include "hal/hal.h"

/* What "uart.h" defines. All isr, lock unless it says main.
 *
 *   bool uart_open(uint32_t bit_per_s, uint8_t format)   main, lock. Set rate and format (HAL_LOOP or'ed in), receiver
 *                      and its interrupt on and empty, transmitter interrupt and driver off; false: cannot, nothing
 *                      changed. Refuses what is off by more than 0.3 % (EN 50170-2 part 2).
 *   bool uart_rx(uint8_t *octet, uint8_t *err)           take one received octet; false: there is none
 *   uint16_t uart_tx_room(void)                          octets that fit now, at least 1 in a transmitter interrupt
 *   void uart_tx(uint8_t octet)                          one octet into the transmitter
 *   void uart_tx_irq(bool on)                            the interrupt that says there is room; it must come too when there
 *                      was room before it was switched on (a UART that tells it by an edge: request it here by software)
 *   bool uart_tx_idle(void)                              the last stop bit is out
 *   void uart_driver(bool on)                            RS-485 driver enable; not called in a loop
 *
 *   hal_dur_t timer_now(void)                            free running, counts of hal_dur_t, wraps at 32 bits
 *   void timer_start(hal_dur_t counts)                   one-shot, counts >= 1; restarts if running. Fires `counts` from
 *                      now or a little later; where it cannot count so far, earlier. counts is at most 10 ms
 *   void timer_stop(void)                                an interrupt that still comes does no harm
 *   TIMER_HZ                                             counts a second; hal_ticks() is made from it, too
 */

/* To be called by the interrupt handlers: the UART has an octet; the UART has room; the timer has run out. isr. */
void line_uart_rx_isr(void);
void line_uart_tx_isr(void);
void line_uart_timer_isr(void);

/* From hal_idle(), before it sleeps: there will be a timer interrupt within 10 ms, so that the main loop sees time go by.
 * At least once in 2^30 counts, so that a silence never grows too old to be told from a young one. lock. */
void line_uart_wake(void);

/* What divisor gives a rate, rounded; 0 where the rate is then off by more than 0.3 % or the divisor is above `most`.
 * clock [1/s] is the rate at divisor 1, below 2^32 - bit_per_s / 2. main. */
uint32_t line_uart_divisor(uint32_t clock, uint32_t bit_per_s, uint32_t most);

#endif
