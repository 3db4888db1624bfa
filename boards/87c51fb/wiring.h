/* 87C51FB with 32 kB of battery-backed RAM: how it is wired (README.md has the drawing). */
#ifndef WIRING_H
#define WIRING_H

#include <8052.h>
#include <stdint.h>

#ifndef FOSC_HZ
#define FOSC_HZ 12000000ul
#endif

/* P3.2 -|>o- driver enable of the transceiver: a port is high during reset, and the driver off. P3.5 watchdog input of the
 * supervisor: an edge kicks. */
#define DRIVER_ENABLE P3_2
#define WATCHDOG      P3_5
#define DRIVER_ON()  (DRIVER_ENABLE = 0)
#define DRIVER_OFF() (DRIVER_ENABLE = 1)
#define WDOG_KICK()  (WATCHDOG = !WATCHDOG)

/* P1.0..P1.6 address switches: closed = 1 */
#define SWITCHES() ((uint8_t)(~P1 & 0x7Fu))

/* The last 32 octets of the battery-backed RAM. */
#define NV_ADDRESS 0x7FE0

/* Memory-mapped I/O at 8000h: inputs through 74HC541, outputs into 74HC573, selected by A0. */
#define IO_ADDRESS 0x8000

#endif
