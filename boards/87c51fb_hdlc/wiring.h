/* Remote module: 87C51FB at 12 MHz, 8273, 32 kB of external RAM at 0000..7FFF.
 *
 *   8000..8003  8273 registers (/CS)      8004  /TxDACK      8008  /RxDACK
 *   8010, 8011  digital outputs 0..7, 8..15 (74HC573; read back from the terminals through 74HC541)
 *   8012, 8013  digital inputs 0..7, 8..15 (74HC541)
 *   8020        analog multiplexer and start of conversion: 0..5 channels, 6 half of the reference voltage
 *   8021, 8022  12-bit result, high octet, low octet
 *   8030..803B  D/A converters: high, low octet of channel 01, then 02, ..; read back through the converter's latch
 *   INT0, INT1  RxINT, TxINT of the 8273, inverted
 *   /RTS        driver enable of the RS-485 transceiver; receiver enable tied to it; /CTS and /CD active
 *   P1.0..P1.4  address switches, closed = 1      P1.7  watchdog: an edge kicks
 *   clock       7200 bit/s (or 32 times it for the DPLL) from outside: README.md
 */
#ifndef WIRING_H
#define WIRING_H

#include <8052.h>
#include <stdint.h>

#ifndef FOSC_HZ
#define FOSC_HZ 12000000ul
#endif

#define CHIP_ADDRESS   0x8000
#define OUTPUT_ADDRESS 0x8010
#define INPUT_ADDRESS  0x8012
#define ADC_ADDRESS    0x8020
#define DAC_ADDRESS    0x8030
#define PROGRAM_SIZE   0x4000u

#define WATCHDOG    P1_7
#define SWITCHES()  ((uint8_t)(~P1 & 0x1Fu))
#define WDOG_KICK() (WATCHDOG = !WATCHDOG)

#endif
