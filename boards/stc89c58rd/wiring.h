/* STC89C58RD+ in 12-clock mode: its registers, and how it is wired (README.md has the drawing). */
#ifndef WIRING_H
#define WIRING_H

#include <8052.h>
#include <stdint.h>

#ifndef FOSC_HZ
#define FOSC_HZ 24000000ul
#endif

/* README.md says what was checked: auxiliary register, watchdog, in-application programming of the data flash. */
static volatile __sfr __at(0x8E) AUXR;
static volatile __sfr __at(0xE1) WDT_CONTR;
static volatile __sfr __at(0xE2) ISP_DATA;
static volatile __sfr __at(0xE3) ISP_ADDRH;
static volatile __sfr __at(0xE4) ISP_ADDRL;
static volatile __sfr __at(0xE5) ISP_CMD;
static volatile __sfr __at(0xE6) ISP_TRIG;
static volatile __sfr __at(0xE7) ISP_CONTR;

/* AUXR: all of the external RAM is on the bus / addresses 0..3FFh are on the chip. */
#define EXTRAM_OUTSIDE 0x02u
#define EXTRAM_ON_CHIP 0x00u

/* WDT_CONTR: enabled, restarted, 12 * 64 * 32768 clocks: 1.05 s at 24 MHz. */
#define WDT_RESTART 0x35u
#define WDOG_KICK() (WDT_CONTR = WDT_RESTART)

/* P3.2 -|>o- driver enable of the transceiver: a port is high during reset, and the driver off. */
#define DRIVER_ENABLE P3_2
#define DRIVER_ON()  (DRIVER_ENABLE = 0)
#define DRIVER_OFF() (DRIVER_ENABLE = 1)

/* P1.0..P1.6 address switches: closed = 1 */
#define SWITCHES() ((uint8_t)(~P1 & 0x7Fu))

/* With RAM outside, memory-mapped I/O at 8000h as on the 87C51FB board; without it, P0 is a port. */
#define IO_ADDRESS 0x8000

#endif
