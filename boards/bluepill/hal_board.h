/* STM32F103C8 "Blue Pill": the numbers the Cortex-M port needs. Line on USART1 (PA9 TX, PA10 RX), driver enable on PA8,
 * console on USART2 (PA2 TX, PA3 RX), 72 MHz from the 8 MHz crystal. */
#ifndef BLUEPILL_HAL_BOARD_H
#define BLUEPILL_HAL_BOARD_H

#define BOARD_CORE_HZ 72000000ul

#define BOARD_LINE_UART     0x40013800u
#define BOARD_LINE_IRQ      37
#define BOARD_LINE_CLOCK_HZ 72000000ul
#define BOARD_DRIVER_BSRR   0x40010810u
#define BOARD_DRIVER_PIN    0x0100ul

#define BOARD_CONSOLE_UART     0x40004400u
#define BOARD_CONSOLE_IRQ      38
#define BOARD_CONSOLE_CLOCK_HZ 36000000ul
#define BOARD_CONSOLE_RATE     115200u

#define BOARD_TIMER     0x40000000u /* TIM2: 72 MHz, twice APB1 */
#define BOARD_TIMER_IRQ 28

#define BOARD_GPIOA_CRL 0x44444B44ul /* PA2 alternate push-pull, PA3 floating input                    */
#define BOARD_GPIOA_CRH 0x444444B3ul /* PA8 push-pull output, PA9 alternate push-pull, PA10 floating input */

#define BOARD_NV_PAGE     0x0800FC00u /* last of 64 kB */
#define BOARD_NV_PAGE_LEN 1024u

#endif
