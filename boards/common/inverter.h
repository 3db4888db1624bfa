/* A motor inverter (spec B7): its registers (inverter_map.h) and a small drive model, alive in ticks. */
#ifndef INVERTER_H
#define INVERTER_H

#include "check.h"
#include "inverter_map.h"

/* Bit i is coil or input i; registers by INV_P_* and INV_V_*. Main only: the application's main loop and the
 * Modbus server are one thread, so nothing of it is ever seen half done. */
extern uint8_t XDATA inv_coils;
extern uint8_t XDATA inv_inputs;
extern uint16_t XDATA inv_params[INV_P_COUNT];
extern uint16_t XDATA inv_values[INV_V_COUNT];

/* Defaults, then what STORE kept in non-volatile memory (hal_nv_*, octets 0..12) if it is whole. After
 * hal_init(). */
void inv_init(void);

/* One pass: the model goes on by the time that has passed (steps of 10 ms; at most 250 of them are caught
 * up; on an 8051 a part of a step of 50 ms). */
void inv_poll(void);

/* The drive trips with this code (enum inv_trip): output off, RUN cleared. */
void inv_trip(uint8_t code);

/* Parameters are being stored. */
bool inv_storing(void);

#endif
