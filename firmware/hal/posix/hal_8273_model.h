/* What a host program or a test says to the modelled 8273 of its station. */
#ifndef FIELDLING_HAL_8273_MODEL_H
#define FIELDLING_HAL_8273_MODEL_H

#include "sim/i8273.h"

extern struct i8273 hal_8273_chip;

/* The chip stops answering: everything reads as `value`, nothing is written. For tests of a broken chip. */
void hal_8273_break(bool broken, uint8_t value);

/* Serve DMA requests, then make the upcalls of active interrupt lines, until there are none. Interrupt
 * context: the caller says that interrupts are not masked. -> false: the driver leaves an interrupt pending. */
bool hal_8273_serve_isr(void);

#endif
