/* Trace of a DP station: one line a telegram, layer by layer. All of it is main.
 *
 *   trace=rx t=0.345678 phy=6805056888826D3C3EF116 fdl=SRD_HIGH da=8.60 sa=2.62 fcb=1 fcv=0 len=0
 *     ddlm=Slave_Diag.req state=WAIT_PRM                                             (in one line)
 *
 * t      seconds since the trace was switched on
 * phy    the octets on the line
 * fdl    what they mean by the decoder of the simulation: a second opinion beside the station's own; octets
 *        that are no telegram show as fdl=invalid, with the rest of the run they came in
 * ddlm   the service
 * state  the station's, after the main loop has dealt with the telegram */
#ifndef FIELDLING_DP_TRACE_H
#define FIELDLING_DP_TRACE_H

#include <stdbool.h>
#include <stdint.h>

void dp_trace_set(bool on);

/* Say the telegrams noted since the last call, state being the station's now. */
void dp_trace_poll(uint8_t state);

#endif
