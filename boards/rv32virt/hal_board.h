/* QEMU's RISC-V machine "virt" with a serial card on PCI: console on its own 16550, the line on the card's. */
#ifndef RV32VIRT_HAL_BOARD_H
#define RV32VIRT_HAL_BOARD_H

#define BOARD_CLINT    0x02000000u
#define BOARD_MTIME_HZ 10000000ul
#define BOARD_PLIC     0x0C000000u

#define BOARD_CONSOLE_UART    0x10000000u
#define BOARD_CONSOLE_IRQ     10u
#define BOARD_CONSOLE_DIVISOR 2u /* 3.6864 MHz / 16 / 115200 */

#define BOARD_LINE_UART 0x03001000u /* port 1000H of the PCI bus */
#define BOARD_LINE_IRQ  33u         /* slot 1, INTA */
#define BOARD_LINE_HZ   1843200ul   /* divisor 12 is 9600 bit/s */

#define BOARD_NV_PAGE       0x22000000u /* second flash: two chips of 16 bits side by side */
#define BOARD_NV_PAGE_WORDS 1024u

#define BOARD_EXIT 0x00100000u

/* The card gets its address. From hal_init(). */
void board_init(void);

#endif
