/* Registers of a TMS320F2808 as its data sheets describe them: SCI-A with FIFOs, CPU timers 0 and 1, PIE groups 1 and 9, the
 * driver's pin. Time is counted CPU clocks; each access of a register takes two. Hostile where the data sheet leaves room:
 * an interrupt flag is set by the event, and not again by the state that remains.
 *
 * Interrupt functions run inside f2808_read/write/run/idle when interrupts are unmasked. */
#ifndef SIM_F2808_SCI_H
#define SIM_F2808_SCI_H

#include <stdbool.h>
#include <stdint.h>

#define F2808_LSPCLK_DIVIDER 4u

/* Power-up: interrupts masked, all registers at their reset values, time 0. */
void f2808_power_on(void);

/* A 16-bit register. Protected ones are written between f2808_allow(true) and (false) only. */
uint16_t f2808_read(uint16_t address);
void f2808_write(uint16_t address, uint16_t value);
void f2808_allow(bool on);

/* CPU: INTM; the vectors of TINT0, SCIRXINTA, SCITXINTA; IDLE until the next interrupt request. */
bool f2808_mask(void); /* -> they were on */
void f2808_unmask(void);
void f2808_vectors(void (*timer0)(void), void (*rx)(void), void (*tx)(void));
void f2808_idle(void);

/* Time goes on. */
void f2808_run(uint64_t clocks);
uint64_t f2808_now(void);

/* The other end of the line. octet: a start bit leaves now, the last stop bit is out at `end`; driver: level of the pin.
 * tick: called as time goes on, at least once a character. */
struct f2808_wire {
    void (*octet)(uint8_t octet, uint64_t end);
    void (*tick)(void);
};
void f2808_set_wire(const struct f2808_wire *wire);
bool f2808_driver(void);
uint32_t f2808_cut(void); /* octets that had not left whole when the driver was switched off */

/* What the receiver hears: an octet whose last stop bit ends now; errors as of SCIRXST bits 4 (framing) and 2 (parity). */
void f2808_hear(uint8_t octet, uint8_t errors);
void f2808_hear_break(void);

/* Clocks of one character as programmed. */
uint64_t f2808_char_clocks(void);

#endif
