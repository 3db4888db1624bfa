/* Between mb_server, the line, and the diagnostics of [A] 6.8 to 6.10 and [S] appendix A. Only called where a
 * row needs it (MB_HAS_DIAGNOSTICS). */
#ifndef FIELDLING_MB_DIAG_H
#define FIELDLING_MB_DIAG_H

#include "modbus/mb.h"

#define MB_LOG_OCTETS 64u /* [A] 6.10 */

/* Event octets, [A] 6.10. */
#define MB_EVENT_RECEIVE        0x80u
#define MB_EVENT_COMM_ERROR     0x02u
#define MB_EVENT_OVERRUN        0x10u
#define MB_EVENT_LISTEN_ONLY    0x20u /* of receive and of send events */
#define MB_EVENT_BROADCAST      0x40u
#define MB_EVENT_SEND           0x40u
#define MB_EVENT_EXCEPTION_1_3  0x01u
#define MB_EVENT_EXCEPTION_4    0x02u
#define MB_EVENT_EXCEPTION_5_6  0x04u
#define MB_EVENT_EXCEPTION_7    0x08u
#define MB_EVENT_ENTERED_LISTEN 0x04u
#define MB_EVENT_RESTART        0x00u

/* All counters and the diagnostic register to 0: functions 8/1, 8/0AH. main */
void mb_diag_clear(void);

/* Restart communication as soon as the line is free: function 8/1. main */
void mb_diag_restart(bool clear_log);

/* Do that, when it was asked for. main, every pass */
void mb_diag_poll(void);

/* A request for us is in mb_pdu. -> execute it? No in listen-only mode, but for function 8/1. main */
bool mb_diag_begin(void);

/* It has been dealt with: `exception` is the result, `answered` says that it will be answered. main */
void mb_diag_end(uint8_t exception, bool answered);

/* Answer to functions 11 and 12: status and event counter to octets[0..3]. main */
void mb_put_status(uint8_t XDATA *octets);

/* The event log; mb_log.c. */
void mb_log_isr(uint8_t event) IN_ISR; /* isr, lock */
void mb_log_clear(void);               /* main      */

#endif
