#include "remote_log.h"
#include "hal/hal.h"

uint16_t XDATA rm_log_ring[RM_LOG_WORDS];

/* The interrupt's: at = next word; total = whole samples ever, modulo 65536. */
static volatile uint16_t at, total;
static uint8_t words, word;

/* main's: sample number next[channel] is the first that was not fetched; at most `kept` wait. The ring holds SPARE
 * samples more: those that come while main reads. */
#define SPARE 4u
static uint16_t kept, end;
static uint16_t XDATA next[RM_LOG_CHANNELS], lost_before[RM_LOG_CHANNELS];
static uint8_t polled;
static uint16_t reading; /* rm_log_next(): where */

void rm_log_init(uint8_t words_of_one)
{
    uint8_t i;

    words = words_of_one;
    ASSERT(words == 1u || words == RM_LOG_CHANNELS_ANALOG);
    kept = (uint16_t)(words == 1u ? RM_LOG_WORDS - SPARE : RM_LOG_WORDS / RM_LOG_CHANNELS_ANALOG - SPARE);
    end = (uint16_t)(words == 1u ? RM_LOG_WORDS : RM_LOG_WORDS / RM_LOG_CHANNELS_ANALOG * RM_LOG_CHANNELS_ANALOG);
    at = total = 0;
    word = polled = 0;
    for (i = 0; i < RM_LOG_CHANNELS; i++)
        next[i] = lost_before[i] = 0;
}

void rm_log_word_isr(uint16_t value) IN_ISR
{
    rm_log_ring[at] = value;
    at++;
    if (++word < words)
        return;
    word = 0;
    total++;
    if (at == end)
        at = 0;
}

static uint16_t total_now(void)
{
    const uint8_t irq = hal_irq_save();
    const uint16_t now = total;
    hal_irq_restore(irq);
    return now;
}

/* -> samples that wait. */
static uint16_t forget_overwritten(uint8_t channel)
{
    uint16_t waiting = (uint16_t)(total_now() - next[channel]);
    uint16_t over;

    if (waiting <= kept)
        return waiting;
    over = (uint16_t)(waiting - kept);
    next[channel] = (uint16_t)(next[channel] + over);
    lost_before[channel] = (uint16_t)(lost_before[channel] + over);
    if (lost_before[channel] < over)
        lost_before[channel] = 0xFFFFu;
    return kept;
}

void rm_log_poll(void)
{
    (void)forget_overwritten(polled);
    polled = (polled + 1u) & (RM_LOG_CHANNELS - 1u);
}

uint8_t rm_log_find(uint8_t channel, uint16_t XDATA *lost, uint16_t XDATA *first)
{
    const uint16_t waiting = forget_overwritten(channel);
    const uint8_t irq = hal_irq_save();
    uint16_t back = (uint16_t)(total - next[channel]); /* one may have come since */
    const uint16_t from = (uint16_t)(at - word);
    hal_irq_restore(irq);

    if (words != 1u)
        back = (uint16_t)((back << 2) + (back << 1)); /* six words each */
    reading = from >= back ? (uint16_t)(from - back) : (uint16_t)(from + (end - back));
    *lost = lost_before[channel];
    *first = next[channel];
    return waiting > 255u ? 255u : (uint8_t)waiting;
}

uint16_t rm_log_next(uint8_t w)
{
    const uint16_t value = rm_log_ring[reading + w];

    reading = (uint16_t)(reading + words);
    if (reading == end)
        reading = 0;
    return value;
}

void rm_log_taken(uint8_t channel, uint8_t k)
{
    next[channel] = (uint16_t)(next[channel] + k);
    lost_before[channel] = 0;
}
