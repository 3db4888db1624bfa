/* TMS320F2808 controller of the inverter: 20 MHz crystal, 100 MHz, LSPCLK a quarter of it. SCI-A on GPIO28 (RX) and GPIO29 (TX), driver
 * enable on GPIO12. */
#ifndef F2808_HAL_BOARD_H
#define F2808_HAL_BOARD_H

#define BOARD_CRYSTAL_HZ 20000000ul
#define BOARD_CPU_HZ     100000000ul
#define BOARD_LSPCLK_HZ  25000000ul
#define BOARD_DRIVER_PIN 0x1000u

#endif
