/* The port for 8052 cores, inside. Who uses what:
 *
 *   serial port, mode 3 or 1    the line                              serial.c (both directions), chunk.c or octet.c
 *   Timer 2                     its bit rate: fosc / (32 * N)
 *   Timer 0, 16 bits            the clock of silence                  silence.c
 *   Timer 1, 16 bits            milliseconds                          machine.c
 *   external interrupt 1        the service: nothing else pulls at it serial.c
 *   register bank 0 main, 1 the service and its upcalls (IN_ISR), 2 the two interrupts above it
 *
 * Two levels. An octet at 187.5 kbit/s lasts 59 machine cycles at 12 MHz, no upcall and no locked section of main is
 * that short. So the serial port and Timer 0 interrupt everything (high priority, assembly, a few dozen cycles): they
 * put octets where they belong, send the next one, note that the line is silent, and ask for the service by setting
 * IE1. The service (low priority, C) makes the upcalls, one after the other. The lock masks the service alone: while
 * main holds it, octets wait in a store and nothing is lost.
 *
 * A board says in wiring.h: FOSC_HZ, DRIVER_ON(), DRIVER_OFF(), SWITCHES(), WDOG_KICK(); P3.3 (INT1) is an input that
 * never falls, or not connected.
 */
#ifndef FIELDLING_MCS51_H
#define FIELDLING_MCS51_H

#include "hal/hal.h"
#include "wiring.h"

#define CYCLES_PER_S (FOSC_HZ / 12u)

/* The vectors. The file that holds main() must see these, or SDCC emits no vectors. */
void silence_timer_isr(void) __interrupt(1) __using(2) __naked; /* high */
void service_isr(void) __interrupt(2) __using(1);               /* low  */
void tick_timer_isr(void) __interrupt(3) __naked;               /* low  */
void serial_isr(void) __interrupt(4) __using(2) __naked;        /* high */

/* ---- serial.c ---- */
extern volatile __bit sending;
extern volatile __bit hear;   /* chunk.c: not deaf */
extern volatile __bit burst;  /* octets are so short that the service stays for the whole telegram */
extern HOT uint8_t few;       /* it stays for a chunk of so many octets                             */
void send_next_isr(void) __naked; /* high: where serial_isr() goes when no octet has been received  */
void sent_isr(void) IN_ISR;       /* the service while sending: all that are left, line_sent_isr()  */

/* ---- silence.c: Timer 0 ---- */
extern volatile __bit due;     /* silence is complete and has not been reported; or the last stop bit is out */
extern HOT uint8_t reload_low; /* Timer 0 after an octet */
extern HOT uint8_t reload_high;
void silence_open_isr(void) IN_ISR;
void silence_restart_isr(void) IN_ISR __naked;

/* ---- register bank 2, for chunk.c and octet.c ---- */
static volatile HOT uint8_t __at(0x10) in;    /* R0: where the next octet goes                                  */
static volatile HOT uint8_t __at(0x15) mark;  /* R5: due: silence was complete before what was kept from here on */
static volatile HOT uint8_t __at(0x17) taken; /* R7: what was kept up to here has been told                      */

/* ---- chunk.c (phy_uart) or octet.c (any other stack): serial_isr() and service_isr() ---- */
bool receive_open(uint16_t n, uint8_t format); /* can follow this divisor and format; SCON is set, nothing is heard  */
void receive_off_isr(void) IN_ISR __naked;     /* what has been heard and not been told is forgotten                 */
void ninth_isr(void) __naked;                  /* A gets its parity, in TB8 or in itself; uses no other register     */
void mark_isr(void) __naked;                   /* high, by ljmp: silence was complete before what is heard next      */
void silent_isr(void) IN_ISR __naked;          /* low, Timer 0 and the receiver masked: silent for longer than that  */

#endif
