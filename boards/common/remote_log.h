/* The sample log of a remote module: a ring of samples, each fetched once per channel.
 *
 * A sample is one word: all sixteen digital channels, or one word for each of six analog channels. The interrupt
 * only writes and counts; what a channel has lost is worked out in main, which must therefore look at every
 * channel (rm_log_poll) more often than the 16-bit count goes round.
 */
#ifndef REMOTE_LOG_H
#define REMOTE_LOG_H

#include "check.h"

/* Words in the ring: as many digital samples, a sixth of it analog ones; four of them are spare. */
#ifndef RM_LOG_WORDS
#define RM_LOG_WORDS 384u
#endif
#define RM_LOG_CHANNELS        16u
#define RM_LOG_CHANNELS_ANALOG 6u
STATIC_ASSERT(RM_LOG_WORDS >= 60u && RM_LOG_WORDS <= 30000u, the_log_holds_ten_analog_samples);

extern uint16_t XDATA rm_log_ring[RM_LOG_WORDS];

/* Start over; words of one sample: 1 or 6. main, interrupts masked. */
void rm_log_init(uint8_t words);

/* The next word of the sample being taken; the sample is in the log when it has all its words. isr. */
void rm_log_word_isr(uint16_t word) IN_ISR;

/* Count what has been overwritten, one channel a call. main. */
void rm_log_poll(void);

/* Channel 0..15's (or 0..5's) samples that wait, at most 255; what was lost before the first of them since
 * rm_log_found(), saturated at FFFF; its running number. main. */
uint8_t rm_log_find(uint8_t channel, uint16_t XDATA *lost, uint16_t XDATA *first);

/* Word w of the next sample, from the first that rm_log_find() found on. main. */
uint16_t rm_log_next(uint8_t w);

/* The first k of them have been taken, lost is 0 again. main. */
void rm_log_taken(uint8_t channel, uint8_t k);

#endif
