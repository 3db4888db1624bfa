/* Between the line (mb_line.c, mb_ascii.c) and the server (mb_server.c): one buffer, handed to and fro.
 *
 * Invariant: mb_frame and the receiver's variables below belong to the interrupts while state is below
 * MB_READY, to main in MB_READY, to the port in MB_SENDING. Only their owner touches them, and only their
 * owner gives them away, by its last act: that is why neither takes a lock to read or write them.
 */
#ifndef FIELDLING_MB_LINE_H
#define FIELDLING_MB_LINE_H

#include "hal/hal.h"
#include "modbus/mb.h"

/* What is awaited next. The first four are the RTU state diagram of [S] figure 14. */
enum mb_line_state {
    MB_RECEPTION, /* RTU: an octet, or t1.5 of silence                              */
    MB_IDLE,      /* RTU: the first octet of a frame                                */
    MB_CONTROL,   /* RTU: the rest of t3.5; an octet spoils the frame               */
    MB_INITIAL,   /* RTU: t3.5 of silence                                           */
    MB_COLON,     /* ASCII: the start of a frame                                    */
    MB_HIGH,      /* ASCII: the high half of an octet, or CR                        */
    MB_LOW,       /* ASCII: the low half of an octet                                */
    MB_END,       /* ASCII: the end delimiter                                       */
    MB_READY,     /* a checked frame for us is in mb_adu                            */
    MB_SENDING,   /* the last stop bit of the answer                                */
};

/* Why a frame is thrown away, beside the flags HAL_ERR_*: an octet after t1.5, or more than a frame has. */
#define MB_FLAW 0x80u

struct mb_rx {
    volatile uint8_t state; /* enum mb_line_state */
    uint8_t flaws;          /* HAL_ERR_*, MB_FLAW of the frame; in MB_READY: something was heard */
    uint16_t n;             /* octets of the frame so far, in mb_adu                           */
    uint16_t crc;           /* RTU: of mb_adu[0..n-1]                                          */
    uint8_t idle;           /* the state in which a frame is awaited: MB_IDLE, or in ASCII MB_COLON */
    uint8_t lrc;            /* ASCII: sum of mb_adu[0..n-1]                                       */
    uint8_t fresh;          /* ASCII: a character has come since main last looked                  */
    hal_dur_t t15, t35;
};
extern HOT struct mb_rx mb_rx;

#define mb_is_ascii   (MB_WITH_ASCII && mb_rx.idle == MB_COLON)
#define mb_idle_state (MB_WITH_ASCII ? mb_rx.idle : (uint8_t)MB_IDLE)

/* End delimiter of ASCII frames; function 8/3 changes the next one, which holds from the next answer on. Our
 * choice: that is after the answer to 8/3 itself, and LF again after mb_open() or a restart. */
extern uint8_t XDATA mb_delimiter, mb_next_delimiter;

/* A frame has ended, its PDU in mb_pdu[0..pdu_len-1]; pdu_len 0: there was a frame, but not a good one.
 * Counts it, and keeps it if it is for us. */
void mb_frame_end_isr(uint8_t pdu_len) IN_ISR;

/* Receive and time out in ASCII; mb_ascii.c. */
void mb_ascii_octet_isr(uint8_t octet, uint8_t err) IN_ISR;
void mb_ascii_poll(void);

/* What function 8 and 12 want to know of the line; mb_diag.c. */
void mb_bad_frame_isr(uint8_t flaws) IN_ISR;

/* Spell mb_adu[0..mb_pdu_len] out with LRC, CR and delimiter. -> characters. Main, in MB_READY. */
uint16_t mb_ascii_encode(void);

/* The request has been dealt with: send the answer mb_pdu[0..mb_pdu_len-1], or none. Main, in MB_READY. */
void mb_line_end(bool answered);

#endif
