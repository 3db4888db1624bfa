/* The CPU of the F2808, as TI's compiler knows it (SPRU514: intrinsics, asm statements, cregister, interrupt). */
#ifndef F2808_CPU_H
#define F2808_CPU_H

#include "check.h"

#define ST1_INTM 0x0001u /* 1: masked */

/* -> interrupts were on. __disable_interrupts() gives ST1 as it was. */
#define cpu_mask()    ((__disable_interrupts() & ST1_INTM) == 0u)
#define cpu_unmask()  ((void)__enable_interrupts())
#define cpu_allow()   __asm(" EALLOW")
#define cpu_protect() __asm(" EDIS")

/* An interrupt between the two has run before IDLE and does not end it: then the wake timer does, 10 ms later at most. */
#define cpu_idle()                                                                                                   \
    do {                                                                                                             \
        cpu_unmask();                                                                                                \
        __asm(" IDLE");                                                                                              \
    } while (0)

/* The vectors of TINT0, SCIRXINTA and SCITXINTA into the table of the PIE, whose addresses have 32 bits; the rest of the
 * table is as the start-up code left it. Interrupts 1 and 9 of the CPU are enabled. */
void cpu_vectors(void (*timer0)(void), void (*rx)(void), void (*tx)(void));

/* Reset by the watchdog: a wrong check value resets at once. The reason is lost. */
void cpu_restart(uint8_t why);

/* Clocks of BOARD_CPU_HZ and BOARD_LSPCLK_HZ; the watchdog stays off. First thing in main(), before hal_init(). */
void cpu_clocks(void);

#endif
