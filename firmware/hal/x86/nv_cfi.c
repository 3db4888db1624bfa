/* Non-volatile cells in the flash that also holds the program: Intel command set (CFI 0001). While a command runs the
 * flash reads as status, so these routines and all they call run from RAM, with interrupts masked.
 *
 * One sector holds the cells as a log of records, so that a change of one cell costs a program operation, and an erase
 * only when the sector is full:
 *
 *   record = index, value, ~index ^ value     erased = FF FF FF: end of the log
 */
#include "hal_board.h"
#include "hal/hal.h"

#define IN_RAM __attribute__((section(".data.code"), noinline))

#define CMD_ERASE      0x20u
#define CMD_ERASE_SURE 0xD0u
#define CMD_PROGRAM    0x40u
#define CMD_READ       0xFFu
#define CMD_CLEAR      0x50u
#define STATUS_READY   0x80u
#define STATUS_FAILED  0x38u

#define RECORD  3u
#define RECORDS (BOARD_NV_SECTOR_LEN / RECORD)

static volatile uint8_t *sector(void)
{
    return (volatile uint8_t *)BOARD_NV_SECTOR;
}

/* Bounded: a flash that never gets ready has failed. -> ready without an error. */
static IN_RAM bool finish(volatile uint8_t *at)
{
    uint32_t patience = BOARD_NV_PATIENCE;
    uint8_t status;

    do {
        status = *at;
    } while (!(status & STATUS_READY) && --patience);
    *at = CMD_CLEAR;
    *at = CMD_READ;
    return (status & STATUS_READY) && !(status & STATUS_FAILED);
}

static IN_RAM bool erase(volatile uint8_t *at)
{
    *at = CMD_ERASE;
    *at = CMD_ERASE_SURE;
    return finish(at);
}

static IN_RAM bool program(volatile uint8_t *at, uint8_t value)
{
    *at = CMD_PROGRAM;
    *at = value;
    return finish(at) && *at == value;
}

static uint8_t check_of(uint8_t index, uint8_t value)
{
    return (uint8_t)(~index ^ value);
}

static bool is_end(const volatile uint8_t *record)
{
    return record[0] == 0xFFu && record[1] == 0xFFu && record[2] == 0xFFu;
}

/* First free record, RECORDS when the sector is full. */
static uint16_t log_end(void)
{
    uint16_t n = 0;

    while (n < RECORDS && !is_end(sector() + n * RECORD))
        n++;
    return n;
}

/* The newest good record of a cell wins; one half written when power failed is passed over. */
uint8_t hal_nv_read(uint8_t index)
{
    const volatile uint8_t *record = sector();
    uint16_t n = log_end();
    uint8_t value = 0xFF;

    for (; n; n--, record += RECORD)
        if (record[0] == index && record[2] == check_of(index, record[1]))
            value = record[1];
    return value;
}

static bool append(uint16_t n, uint8_t index, uint8_t value)
{
    volatile uint8_t *record = sector() + n * RECORD;

    return program(record, index) && program(record + 1, value) && program(record + 2, check_of(index, value));
}

/* The sector is full: keep what the cells hold, and begin anew. */
static bool compact(void)
{
    uint8_t cells[HAL_NV_SIZE];
    uint8_t i;

    for (i = 0; i < HAL_NV_SIZE; i++)
        cells[i] = hal_nv_read(i);
    if (!erase(sector()))
        return false;
    for (i = 0; i < HAL_NV_SIZE; i++)
        if (cells[i] != 0xFFu && !append(log_end(), i, cells[i]))
            return false;
    return true;
}

bool hal_nv_write(uint8_t index, uint8_t value)
{
    uint8_t irq;
    bool good;

    if (index >= HAL_NV_SIZE)
        return false;
    if (hal_nv_read(index) == value)
        return true;
    irq = hal_irq_save();
    good = log_end() < RECORDS || compact();
    good = good && append(log_end(), index, value);
    hal_irq_restore(irq);
    return good && hal_nv_read(index) == value;
}
