/* Remote module: digital in, digital out, analog in, analog out, over HDLC. What the application is, whatever board
 * it runs on (remote_board.h).
 *
 * Information field, in the source document's control octets 08H/09H and in I-frames alike (spec C2):
 *
 *   function          module  command                answer
 *   01 request data   DI      01 ch                  01 ch 30|31            30H off, 31H on; ch 00..0F
 *                     AI      01 ch                  01 ch hi lo            ch 01..06
 *   02 control        DO      02 ch 30|31            02 ch 30|31
 *                     AO      02 ch hi lo            02 ch hi lo            0000..0FFF
 * in I-frames only, our choice:
 *   03 diagnosis      all     03 page                03 page ...            remote_module.c
 *   04 samples        DI AI   04 ch max              04 ch lost.16 first.16 k sample_1..sample_k
 *
 * Samples: oldest first, taken out of the log; each as in function 01 (one or two octets); first = running number
 * of the first one, lost = how many were overwritten before it since the last fetch (FFFF: or more); max 00 = as many
 * as fit; k = 0: the log is empty. I-frames are never lost or doubled, so the master gets each sample once.
 *
 * Negative answer in I-frames, our choice: function + 80H, ch (00 if there was none), reason (enum rm_reason). In the
 * document's mode: silence and a counter. In both no output has changed.
 *
 * Context: main, except rm_tick_isr.
 */
#ifndef REMOTE_MODULE_H
#define REMOTE_MODULE_H

#include "check.h"

enum rm_type { RM_DI = 1, RM_DO = 2, RM_AI = 4, RM_AO = 8 }; /* bits: the table of functions or's them */

enum rm_function { RM_REQUEST = 0x01, RM_CONTROL = 0x02, RM_DIAGNOSIS = 0x03, RM_SAMPLES = 0x04 };
#define RM_NEGATIVE 0x80u

enum rm_reason {
    RM_OK,
    RM_FUNCTION, /* not one of this module's                        */
    RM_CHANNEL,
    RM_LENGTH,
    RM_VALUE,    /* neither 30H nor 31H; above 0FFFH                */
    RM_HARDWARE, /* diagnosis says that the value cannot be trusted */
};

#define RM_OFF 0x30u
#define RM_ON  0x31u
#define RM_DIGITAL_CHANNELS 16u /* 00..0F */
#define RM_ANALOG_CHANNELS  6u  /* 01..06 */
#define RM_ANALOG_MAX       0x0FFFu

/* Time between two samples [ms], 6..250. */
#ifndef RM_SAMPLE_MS
#define RM_SAMPLE_MS 10u
#endif

/* Results of the background checks. */
enum rm_fault {
    RM_FAULT_RAM = 0x01,
    RM_FAULT_PROGRAM = 0x02,
    RM_FAULT_CONVERTER = 0x04,
    RM_FAULT_OUTPUT = 0x08,
};

struct rm_counters {
    uint16_t executed; /* outputs set                       */
    uint16_t refused;  /* commands that were not carried out */
    uint16_t safe;     /* times the outputs went to safety   */
};
extern struct rm_counters XDATA rm_counters;

/* Power-up: outputs safe (off, 0), checks and samples start over, station as hdlc_nrm_init(). type is one of enum
 * rm_type. True: the chip answers. */
bool rm_init(uint8_t type, uint8_t address, uint8_t mode);

/* One pass of the main loop: at most one frame, one step of each check. */
void rm_poll(void);

/* The board's timer, every millisecond: a sample is taken every RM_SAMPLE_MS, its analog channels 1 ms apart. isr. */
void rm_tick_isr(void) IN_ISR;

/* Carry out a command info[0..n-1] -> length of the answer at answer[0..]; in the document's mode 0: silence. */
uint8_t rm_execute(const uint8_t XDATA *info, uint8_t n, uint8_t XDATA *answer, bool in_document_mode);

/* Output channel 0..15 (digital, 0 or 1) or 0..5 (analog) as last set. */
uint16_t rm_output(uint8_t index);

/* enum rm_fault or'ed: at the last check; ever since power-up. Complete background passes, modulo 65536. */
uint8_t rm_faults(void);
uint8_t rm_faults_seen(void);
uint16_t rm_passes(void);

#endif
