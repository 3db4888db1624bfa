/* Between the parts of the inverter: drive model, parameter store, Modbus side. */
#ifndef INVERTER_MODEL_H
#define INVERTER_MODEL_H

#include "inverter.h"

extern uint16_t XDATA inv_trips[1 + INV_TRIPS_KEPT]; /* count, then the codes, newest first */
extern uint16_t XDATA inv_note[INV_NOTE_RECORDS];

/* OUTPUT_FREQ, i * 100 ms ago; i is below INV_TREND_KEPT. */
uint16_t inv_trend(uint8_t i);

/* What row i of INV_PARAMS allows. */
bool inv_param_ok(uint8_t i, uint16_t value);

/* Parameters from non-volatile memory, if they are whole; start storing them; store one octet. */
void inv_restore(void);
void inv_store(void);
void inv_store_poll(void);

#endif
