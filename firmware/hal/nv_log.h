/* The non-volatile cells of hal.h in one erasable page of flash, as a log of 32-bit words.
 *
 *   word = index | value << 8 | (index ^ value ^ 5A) << 16 | A5 << 24        erased = FFFFFFFF: end of the log
 *
 * A change of a cell costs one word; the page is erased only when it is full. A word that was half written when power
 * failed has a wrong check octet and is passed over. The page may be delivered with words in it (a preset address).
 */
#ifndef FIELDLING_HAL_NV_LOG_H
#define FIELDLING_HAL_NV_LOG_H

#include "hal/hal.h"

/* What the port supplies, all called with interrupts masked. */

/* Words a page holds. */
extern const uint16_t nv_page_words;

/* Read word n. */
uint32_t nv_page_read(uint16_t n);

/* Program the erased word n / erase the page; wait until done, bounded. -> it reads back. */
bool nv_page_program(uint16_t n, uint32_t word);
bool nv_page_erase(void);

/* The word that says cell `index` has `value`, for a page delivered with something in it. */
#define NV_LOG_WORD(index, value)                                                                                \
    ((uint32_t)(index) | (uint32_t)(value) << 8 | (uint32_t)((index) ^ (value) ^ 0x5Au) << 16 | 0xA5000000u)

#endif
