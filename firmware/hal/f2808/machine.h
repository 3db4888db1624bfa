/* The machine around the line on the F2808. "cpu.h" gives what the compiler knows of the CPU: cpu_mask() -> whether
 * interrupts were on, cpu_unmask(), cpu_idle(), cpu_allow() and cpu_protect() (EALLOW, EDIS), cpu_vectors(timer0, rx, tx),
 * cpu_restart(why): part/cpu.h on the part, the model's in tests. */
#ifndef FIELDLING_F2808_MACHINE_H
#define FIELDLING_F2808_MACHINE_H

#include "check.h"

#define PIEACK_GROUP1 0x0001u
#define PIEACK_GROUP9 0x0100u

/* Interrupt functions, for the vector table of the PIE: SCIRXINTA (9.1), SCITXINTA (9.2), TINT0 (1.7). */
void f2808_sci_rx_isr(void);
void f2808_sci_tx_isr(void);
void f2808_timer0_isr(void);

/* An interrupt has come since hal_idle() looked. */
extern volatile bool f2808_interrupted;

#endif
