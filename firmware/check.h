/* Checks and memory spaces, the only place that knows the compiler's name.
 *
 * ASSERT        our own bug, never something that came over the wire (DESIGN.md, "three kinds of fault").
 *               Calls hal_reset() with HAL_RESET_ASSERT; compiled out with -DNDEBUG.
 * STATIC_ASSERT a rule the compiler can prove; name is an identifier that says what went wrong.
 *
 * Memory spaces and calling rules, empty everywhere but under SDCC for the 8051:
 *   XDATA    external RAM: buffers, and pointers to them (a plain pointer there costs three times as much)
 *   HOT      internal RAM, direct: the few variables an octet interrupt touches
 *            (flags in a HOT struct are uint8_t: of `hot.flag = a == b` with a bool flag, SDCC 4.2 forgets the store)
 *   IDATA    internal RAM, indirect
 *   PAGED    the 256 octets of external RAM whose pointers are one octet: tables that interrupts walk
 *   CODE     program memory: constant tables and strings
 *   IN_ISR   ends the declaration AND the definition of every function whose name ends in _isr
 *   REENTRANT  locals on the stack: for a function reached through a pointer with two or more arguments. Not for
 *            a function that main and interrupts both call: its registers would still be main's
 */
#ifndef FIELDLING_CHECK_H
#define FIELDLING_CHECK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__SDCC_mcs51)
#define XDATA     __xdata
#define HOT       __data
#define IDATA     __idata
#define PAGED     __pdata
#define CODE      __code
#ifndef IN_ISR /* test images, in which main() calls interrupt code itself, have one register bank: -DIN_ISR= */
#define IN_ISR __using(1)
#endif
#define REENTRANT __reentrant
#else
#define XDATA
#define HOT
#define IDATA
#define PAGED
#define CODE
#define IN_ISR
#define REENTRANT
#endif

#define STATIC_ASSERT(condition, name) typedef char static_assert_##name[(condition) ? 1 : -1]

#ifdef NDEBUG
#define ASSERT(condition) ((void)0)
#else
void hal_reset(uint8_t why);
#define ASSERT(condition) ((condition) ? (void)0 : hal_reset(255u))
#endif

#endif
