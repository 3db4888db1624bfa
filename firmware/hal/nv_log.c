#include "hal/nv_log.h"

#define ERASED 0xFFFFFFFFu

/* Sought from above: an erase that lost power may have left erased words below old ones, and what is appended must come
 * behind them all. */
static uint16_t log_end(void)
{
    uint16_t n = nv_page_words;

    while (n && nv_page_read((uint16_t)(n - 1u)) == ERASED)
        n--;
    return n;
}

/* The newest good word of a cell wins. */
static uint8_t newest(uint8_t index)
{
    uint16_t n = log_end();
    uint32_t word;

    while (n) {
        word = nv_page_read(--n);
        if (word == NV_LOG_WORD(index, (uint8_t)(word >> 8)))
            return (uint8_t)(word >> 8);
    }
    return 0xFF;
}

/* The page is full: keep what the cells hold, and begin anew. A word that fails costs its own cell only. */
static bool compact(void)
{
    uint8_t cells[HAL_NV_SIZE];
    uint16_t end = 0;
    bool good = true;
    uint8_t i;

    for (i = 0; i < HAL_NV_SIZE; i++)
        cells[i] = newest(i);
    if (!nv_page_erase())
        return false;
    for (i = 0; i < HAL_NV_SIZE; i++)
        if (cells[i] != 0xFFu && !nv_page_program(end++, NV_LOG_WORD(i, cells[i])))
            good = false;
    return good;
}

static bool append(uint8_t index, uint8_t value)
{
    if (log_end() == nv_page_words && !compact())
        return false;
    return nv_page_program(log_end(), NV_LOG_WORD(index, value));
}

uint8_t hal_nv_read(uint8_t index)
{
    uint8_t irq = hal_irq_save();
    uint8_t value = newest(index);

    hal_irq_restore(irq);
    return value;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    uint8_t irq;
    bool good;

    if (index >= HAL_NV_SIZE)
        return false;
    irq = hal_irq_save();
    good = newest(index) == value || (append(index, value) && newest(index) == value);
    hal_irq_restore(irq);
    return good;
}
