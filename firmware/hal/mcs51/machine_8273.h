/* 8052 with an 8273, inside. The file that holds main() must see the vectors, or SDCC emits none.
 * A board says in wiring.h: FOSC_HZ, CHIP_ADDRESS, SWITCHES(), WDOG_KICK(). */
#ifndef FIELDLING_MACHINE_8273_H
#define FIELDLING_MACHINE_8273_H

#include "check.h"
#include "wiring.h"

void rx_interrupt_isr(void) __interrupt(0) __using(1);
void timer_interrupt_isr(void) __interrupt(1) __using(1);
void tx_interrupt_isr(void) __interrupt(2) __using(1);

/* Implemented by the board: a millisecond has passed. isr. */
void board_tick_isr(void) IN_ISR;

#endif
