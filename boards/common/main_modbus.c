/* The Modbus inverter for boards with a console: 19200 bit/s, 8E1, address by the switches, 1 where there are none.
 * Console: status, rtu, ascii. */
#include "hal/hal.h"
#include "inverter.h"
#include "line_console.h"
#include "modbus/mb.h"

#define NO_SWITCHES 126u

static void open_line(uint8_t mode)
{
    mb_port.mode = mode;
    mb_port.format = mode == MB_ASCII ? HAL_7E1 : HAL_8E1;
    mb_open();
}

static void cmd_status(void)
{
    console_say(mb_port.mode == MB_ASCII ? "mode=ascii" : "mode=rtu");
    console_say_pair(" address=", mb_port.address);
    console_say_pair(" bus_message=", mb_diag.counter[MB_BUS_MESSAGE]);
    console_say_pair(" bus_error=", mb_diag.counter[MB_BUS_ERROR]);
    console_say_pair(" slave_message=", mb_diag.counter[MB_SLAVE_MESSAGE]);
    console_say_pair(" frequency=", inv_values[INV_V_OUTPUT_FREQ]);
}

static void console_poll(void)
{
    if (!console_read())
        return;
    if (console_is("rtu"))
        open_line(MB_RTU);
    else if (console_is("ascii"))
        open_line(MB_ASCII);
    else if (!console_is("status"))
        console_say("error=unknown-command ");
    cmd_status();
    console_end();
}

int main(void)
{
    hal_init();
    mb_port.bit_per_s = 19200;
    mb_port.address = hal_switches();
    if (mb_port.address == 0 || mb_port.address == NO_SWITCHES)
        mb_port.address = 1;
    inv_init();
    open_line(MB_RTU);
    hal_irq_restore(HAL_IRQ_ON);
    for (;;) {
        mb_poll();
        inv_poll();
        console_poll();
        hal_wdog_kick();
        hal_idle();
    }
}
