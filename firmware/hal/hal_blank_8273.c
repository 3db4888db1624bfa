/* The empty port's 8273 (hal_blank.c). */
#include "hal_8273.h"

volatile uint8_t XDATA hal_8273_registers[9];
