/* COM86: the numbers the x86 port needs. */
#ifndef COM86_HAL_BOARD_H
#define COM86_HAL_BOARD_H

#define BOARD_CONSOLE_UART 0x3F8u /* COM1, IRQ 4 */
#define BOARD_LINE_UART    0x2F8u /* COM2, IRQ 3 */
#define BOARD_UART_HZ      1843200ul
#define BOARD_CONSOLE_RATE 115200ul
#define BOARD_TEST_EXIT    0xF4u /* a port that only a test machine has: ends it with status (octet << 1) | 1 */

/* One sector of the flash, seen where all of it is: below 4 GB. */
#define BOARD_FLASH         0xFFFF0000ul
#define BOARD_NV_OFFSET     0xD000u /* kept free by rom.ld */
#define BOARD_NV_SECTOR_LEN 4096u
#define BOARD_NV_SECTOR     (BOARD_FLASH + BOARD_NV_OFFSET)
#define BOARD_NV_PATIENCE   4000000ul /* status reads; an erase takes at most a second */

#endif
