/* Trace of a Modbus station: one line a frame, as the line had it and what it says. All of it is main.
 *
 *   trace=rx t=12.345678 frame=1103006B00037687 check=ok address=17 function=03 data=006B0003
 *
 * check: CRC or LRC by the encoder of the simulation, a second opinion beside the station's own. */
#ifndef FIELDLING_MB_TRACE_H
#define FIELDLING_MB_TRACE_H

#include <stdbool.h>
#include <stdint.h>

void mb_trace_set(bool on);

/* Say the frames noted since the last call. ascii: how to read them; gap_ms: a frame received has ended when
 * nothing came for so long. */
void mb_trace_poll(bool ascii, uint16_t gap_ms);

#endif
