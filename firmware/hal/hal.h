/* THE PORT: everything the stacks need from a machine, and nothing else.
 *
 *     stack  --- services below --->  firmware/hal/<arch>/   registers, interrupts
 *     stack  <-- upcalls (line_*) --                          numbers come from boards/<board>/
 *
 * The line is half duplex RS-485. The port owns three things that hardware does best: sending a run of octets
 * without a gap, the driver enable around it, and the clock of silence on the line. Everything else, and all
 * protocol, is above.
 *
 * Contexts
 *   main   the background loop
 *   isr    interrupt functions and the upcalls they make: bounded, they never wait. All upcalls run at ONE
 *          priority; none interrupts another.
 *   lock   main with interrupts masked by hal_irq_save()
 * A service that may run in isr takes no lock and neither multiplies nor divides (SDCC's helpers are not
 * reentrant); bit times are turned into timer counts beforehand, in main, by hal_tbit().
 */
#ifndef FIELDLING_HAL_H
#define FIELDLING_HAL_H

#include "check.h"
#include "hal_arch.h" /* hal_dur_t: timer counts; uint16_t on 8-bit parts, uint32_t elsewhere */

/* Character format. 8E1 is PROFIBUS (EN 50170-2 part 2); the others are Modbus serial line 2.5.1, 2.5.2. */
enum hal_format { HAL_8E1, HAL_8O1, HAL_8N2, HAL_8N1, HAL_7E1, HAL_7O1, HAL_7N2, HAL_FORMATS };
#define HAL_LOOP 0x80u /* or'ed in: the transmitter feeds our own receiver; nothing reaches the line or comes from it */

/* What hal_line_open() answers. */
enum hal_line {
    HAL_LINE_NO,      /* this board cannot do that rate or format: nothing was changed                    */
    HAL_LINE_TIMED,   /* silence is measured to a fraction of a bit time: idle rules can be enforced      */
    HAL_LINE_UNTIMED, /* a pty, a USB adapter: octets come in lumps, two telegrams may come without a gap */
};

/* Error flags of one received octet. */
#define HAL_ERR_PARITY  0x01u
#define HAL_ERR_FRAMING 0x02u
#define HAL_ERR_OVERRUN 0x04u /* this octet is good, at least one before it was lost */
#define HAL_ERR_BREAK   0x08u

/* Why hal_reset() was called. */
enum hal_reset_why { HAL_RESET_ASKED = 0, HAL_RESET_ASSERT = 255 };

/* ---- machine ------------------------------------------------------------------------------------------ */

/* Clocks, pins, vectors, timers; driver off, interrupts still masked. First call of main(). main. */
void hal_init(void);

/* Mask interrupts / put them back as they were. hal_irq_restore(HAL_IRQ_ON) unmasks for the first time. main. */
#define HAL_IRQ_ON 1u
uint8_t hal_irq_save(void);
void hal_irq_restore(uint8_t state);

/* Milliseconds since start, wraps at 65536; monotonic, at most 1 ms late. main. */
uint16_t hal_ticks(void);

/* One octet of non-volatile memory, index 0..HAL_NV_SIZE-1; erased cells read as 0xFF. hal_nv_write waits
 * until the value is stored, and says whether it reads back. main. */
#define HAL_NV_SIZE 16u
uint8_t hal_nv_read(uint8_t index);
bool hal_nv_write(uint8_t index, uint8_t value);

/* Address switches as the board has them, 0..127; 126 means "address is set by the master". main. */
uint8_t hal_switches(void);

/* Kick the hardware watchdog. Sleep until the next interrupt, or return at once. Both are main. */
void hal_wdog_kick(void);
void hal_idle(void);

/* Start over as after power-up (a test machine may end with status `why` instead). Does not return. Any context. */
void hal_reset(uint8_t why);

/* ---- the line ----------------------------------------------------------------------------------------- */

/* Set rate [bit/s] and format (enum hal_format, may be or'ed with HAL_LOOP), stop a transmission, drop the
 * driver, empty the receiver, start listening. The silence limit is switched off. -> enum hal_line. main.
 * 45.45 kbit/s is asked for as 45450. */
uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format);

/* n bit times at the open rate as timer counts, rounded up, saturated at the largest hal_dur_t. main. */
hal_dur_t hal_tbit(uint16_t n);

/* Set the silence limit d (0 = none). Whenever the line has been silent for d since the end (last stop bit) of
 * the last octet received or sent, or since hal_line_open(), line_silence_isr() is called, once per silence
 * and limit: a new octet or a new call of hal_silence() re-arms it. If the line has already been silent for d,
 * line_silence_isr() follows at once (as an interrupt of its own, never from inside this call). The limit
 * stays set until changed, so the port may restart a hardware timer by itself at each octet. A pending
 * line_silence_isr() is cancelled by an octet that has been received: the port looks at the receiver first.
 * isr, lock. */
void hal_silence(hal_dur_t d) IN_ISR;

/* The line has been silent for d already, and nothing has been received that is still to be told: line_silence_isr() would
 * follow at once if hal_silence() were called now. A port that is not in a hurry may always say no. isr. */
bool hal_silent(hal_dur_t d) IN_ISR;

/* Enable the driver and send octets[0..n-1], n >= 1, each after the other without a gap; drop the driver when
 * the last stop bit is out, then line_sent_isr(). octets must stay unchanged until then. Our own octets are
 * not received (except with HAL_LOOP). Must not be called while sending. The first start bit leaves within
 * one bit time plus the port's latency (which its budget states). isr, lock. */
void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR;

/* ---- upcalls: the stack implements them, bound by name at link time; isr ------------------------------- */

/* One octet has been received; err = HAL_ERR_* flags, 0 = good. Called at or after mid stop bit. */
void line_octet_isr(uint8_t octet, uint8_t err) IN_ISR;

/* The line has been silent for the limit set by hal_silence(). */
void line_silence_isr(void) IN_ISR;

/* The last stop bit of hal_send() is on the line and the driver is off. */
void line_sent_isr(void) IN_ISR;

/* ---- console, optional (boards without one: get = -1, put = nothing) ------------------------------------ */

/* Next console octet or -1. / One octet to the console; may drop it when the device is full. main. */
int16_t hal_con_get(void);
void hal_con_put(uint8_t octet);

#endif
