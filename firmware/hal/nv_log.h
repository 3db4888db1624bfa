/* The non-volatile cells of hal.h in one erasable page of flash, as a log of 32-bit words.
 *
 *   word = index | value << 8 | ~value << 16 | ~index << 24        erased = FFFFFFFF, behind the last word
 *
 * A change of a cell costs one word; the page is erased only when it is full. Programming clears bits and erasing sets
 * them: a word stopped in the middle of either has a 1 or a 0 on both sides of a complement, and is passed over. So power
 * lost while a word is written leaves the old value or the new one, in the other cells what they held. Power lost while
 * a full page is renewed may lose cells (there is one page): they read FF or an earlier value of their own, no other.
 * The page may be delivered with words in it (a preset address).
 */
#ifndef FIELDLING_HAL_NV_LOG_H
#define FIELDLING_HAL_NV_LOG_H

#include "hal/hal.h"

/* What the port supplies, all called with interrupts masked. */

/* Words a page holds, more than HAL_NV_SIZE. */
extern const uint16_t nv_page_words;

/* Read word n. */
uint32_t nv_page_read(uint16_t n);

/* Program the erased word n / erase the page; wait until done, bounded. -> it reads back. */
bool nv_page_program(uint16_t n, uint32_t word);
bool nv_page_erase(void);

/* The word that says cell `index` has `value`, for a page delivered with something in it. */
#define NV_LOG_WORD(index, value)                                                                                      \
    ((uint32_t)(uint8_t)(index) | (uint32_t)(uint8_t)(value) << 8 | (uint32_t)((value) ^ 0xFFu) << 16 |                \
     (uint32_t)((index) ^ 0xFFu) << 24)

#endif
