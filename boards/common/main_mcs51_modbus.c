/* The Modbus inverter on an 8052 core: no console, the one serial port is the line.
 *
 * How the line is, is said by switches at process input 0, closed = 1, looked at after power-up. All open are the
 * standard's defaults ([S] 2.4, 2.5: 19200 bit/s, even parity, RTU).
 *   bits 0..2  rate, see below; one that the crystal does not reach is 9600
 *   bits 3, 4  0 even parity, 1 odd, 2 none (two stop bits), 3 none and one stop bit (our choice: many clients do so)
 *   bit 5      1 = ASCII: seven data bits
 */
#include "hal/hal.h"
#include "hal/mcs51/mcs51.h" /* the vectors */
#include "board.h"
#include "inverter.h"
#include "modbus/mb.h"

#define RATE_BITS    0x07u
#define FORMAT_BITS  0x18u
#define FORMAT_SHIFT 3u
#define ASCII_BIT    0x20u
#define LAST_ADDRESS 125u /* 126 is the DP switches' "from memory", and 0 is no address: 1 */

static const uint16_t CODE rates[RATE_BITS + 1u] = {192, 12, 24, 48, 96, 384, 576, 1152}; /* 100 bit/s */
static const uint8_t CODE formats_rtu[] = {HAL_8E1, HAL_8O1, HAL_8N2, HAL_8N1};
static const uint8_t CODE formats_ascii[] = {HAL_7E1, HAL_7O1, HAL_7N2, HAL_8N1};

static void open_line(uint8_t switches)
{
    const uint8_t format = (switches & FORMAT_BITS) >> FORMAT_SHIFT;

    mb_port.mode = switches & ASCII_BIT ? MB_ASCII : MB_RTU;
    mb_port.format = mb_port.mode == MB_ASCII ? formats_ascii[format] : formats_rtu[format];
    mb_port.bit_per_s = 100u * (uint32_t)rates[switches & RATE_BITS];
    if (mb_open() != HAL_LINE_NO)
        return;
    mb_port.bit_per_s = 9600;
    mb_open();
}

void main(void)
{
    hal_init();
    mb_port.address = hal_switches();
    if (mb_port.address == 0 || mb_port.address > LAST_ADDRESS)
        mb_port.address = 1;
    inv_init();
    open_line(board_input(0));
    hal_irq_restore(HAL_IRQ_ON);
    for (;;) {
        mb_poll();
        inv_poll();
        hal_wdog_kick();
        hal_idle();
    }
}
