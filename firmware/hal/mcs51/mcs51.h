/* The port for 8052 cores, inside. Who uses what:
 *
 *   serial port, mode 3 or 1    the line                              serial.c (registers), chunk.c or octet.c
 *   Timer 2                     its bit rate: fosc / (32 * N)
 *   Timer 0, 16 bits            the clock of silence                  silence.c
 *   Timer 1, 16 bits            milliseconds                          machine.c
 *   register bank 0 main, 1 upcalls and the services they call (IN_ISR), 2 the interrupt functions themselves
 *
 * The lock does not mask interrupts, it holds back upcalls. An octet at 187.5 kbit/s lasts 59 machine cycles at
 * 12 MHz, and no main loop of C keeps its locked sections that short. So the interrupts run on: what is being sent
 * is sent without a gap, octets wait in a small store, and the upcalls follow when the lock is opened. That is why
 * the interrupt functions have a register bank of their own: main may be inside bank 1 when they come.
 *
 * A board says in wiring.h: FOSC_HZ, DRIVER_ON(), DRIVER_OFF(), SWITCHES(), WDOG_KICK().
 */
#ifndef FIELDLING_MCS51_H
#define FIELDLING_MCS51_H

#include "hal/hal.h"
#include "wiring.h"

#define CYCLES_PER_S (FOSC_HZ / 12u)

/* The vectors. The file that holds main() must see these, or SDCC emits no vectors. */
void silence_timer_isr(void) __interrupt(1) __using(2);
void tick_timer_isr(void) __interrupt(3) __naked;
void serial_isr(void) __interrupt(4) __naked;

/* ---- machine.c ---- */
extern volatile __bit locked; /* main holds upcalls back */

/* ---- serial.c: octets in and out ---- */
extern volatile __bit sending;
extern volatile __bit burst;        /* octets are so short that the interrupt stays for the whole telegram  */
extern volatile __bit polled;       /* bits are so short that the interrupt stays for the whole answer       */
extern volatile __bit deaf;         /* nobody wants octets: each one only sets back the clock of silence    */
extern volatile __bit eager;        /* the next octet begins a burst                                         */
extern HOT uint8_t octet;           /* the octet received last                                              */
extern HOT uint8_t octet_err;       /* HAL_ERR_* of it                                                      */
extern IDATA uint16_t octet_cycles; /* duration of one octet                                                */
void serial_work_isr(void) __interrupt __using(2);
void receive_isr(void) __using(2);    /* SBUF to octet and octet_err, clock of silence set back             */
void send_next_isr(void) __using(2);  /* TI: the next octet                                                 */
void send_burst_isr(void) __using(2); /* all that are left, waiting for each TI                             */
void send_end_isr(void) __using(2);   /* the last stop bit is on the line                                   */

/* ---- silence.c: Timer 0 ---- */
extern volatile __bit armed;   /* the limit has not been reported since the last octet */
extern volatile __bit endless; /* silent for longer than Timer 0 counts                */
extern HOT uint8_t reload_low; /* Timer 0 after an octet                               */
extern HOT uint8_t reload_high;
void silence_open(void);
void silence_restart_isr(void) __using(2) __naked;
void silence_now_isr(void) __using(2); /* the limit may have passed during an upcall */
bool silence_cut_isr(void) __using(2); /* the octet being received began before the silence was complete */

/* ---- held.c: what has waited while main held the lock ---- */
extern volatile __bit held_any;
void hold_octet_isr(void) __using(2);   /* octet, octet_err             */
void hold_silence_isr(void) __using(2); /* line_silence_isr() is due    */
void hold_sent_isr(void) __using(2);    /* line_sent_isr() is due       */
void held_drop_isr(void) IN_ISR;
bool held_octet_isr(void) __using(2);   /* the next one into octet, octet_err; false: no more */
#define HELD_MAX 24u
extern IDATA uint8_t held[HELD_MAX];    /* for chunk.c: octets held_out..held_in-1 wait       */
extern IDATA uint8_t held_in;
extern IDATA uint8_t held_out;
void held_serve_isr(void) __using(2);

/* ---- chunk.c (phy_uart) or octet.c (any other stack): who takes octets ---- */
void take_isr(void) __using(2); /* octet, octet_err: to the stack                         */
void serve_octets_isr(void) __using(2); /* all that held_octet_isr() gives */
void burst_isr(void) __using(2); /* RI is set: this octet and those that follow, until there is no more to do */
void look_isr(void) __using(2); /* after any other upcall: does the stack want octets now?          */

#endif
