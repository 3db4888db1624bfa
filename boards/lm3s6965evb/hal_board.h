/* LM3S6965 evaluation board: the numbers the Cortex-M port needs. Console on UART 0, line on UART 1 (PD2, PD3), driver
 * enable on PD4 (PD0 selects the memory card), 50 MHz from the PLL. */
#ifndef LM3S6965EVB_HAL_BOARD_H
#define LM3S6965EVB_HAL_BOARD_H

#define BOARD_CORE_HZ 50000000ul
#define BOARD_RCC     0x01C00380ul /* SYSDIV 4, PLL on, 8 MHz crystal */

#define BOARD_CONSOLE_UART 0x4000C000u
#define BOARD_CONSOLE_IRQ  5
#define BOARD_CONSOLE_RATE 115200u
#define BOARD_LINE_UART    0x4000D000u
#define BOARD_LINE_IRQ     6
#define BOARD_LINE_PINS    0x0Cu
#define BOARD_TIMER        0x40030000u
#define BOARD_TIMER_IRQ    19
#define BOARD_DRIVER_GPIO  0x40007000u
#define BOARD_DRIVER_PIN   0x10u

#define BOARD_NV_PAGE     0x0003FC00u /* last of 256 kB */
#define BOARD_NV_PAGE_LEN 1024u

#endif
