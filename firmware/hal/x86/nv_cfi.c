/* The page of nv_log.h in the flash that also holds the program: Intel command set (CFI 0001). While a command runs, the
 * whole flash reads as status, so these routines run from RAM, with interrupts masked. */
#include "hal/nv_log.h"
#include "hal_board.h"

#define IN_RAM __attribute__((section(".ramcode"), noinline))

#define CMD_ERASE      0x20u
#define CMD_ERASE_SURE 0xD0u
#define CMD_PROGRAM    0x40u
#define CMD_READ       0xFFu
#define CMD_CLEAR      0x50u
#define STATUS_READY   0x80u
#define STATUS_FAILED  0x38u

const uint16_t nv_page_words = BOARD_NV_SECTOR_LEN / 4u;

static volatile uint8_t *octet_at(uint16_t n, uint8_t i)
{
    return (volatile uint8_t *)(BOARD_NV_SECTOR + 4u * n + i);
}

/* Give a command and its second octet; wait until ready. Bounded: a flash that never gets ready has failed. */
static IN_RAM bool command(volatile uint8_t *at, uint8_t first, uint8_t second)
{
    uint32_t patience = BOARD_NV_PATIENCE;
    uint8_t status;

    *at = first;
    *at = second;
    do {
        status = *at;
    } while (!(status & STATUS_READY) && --patience);
    *at = CMD_CLEAR;
    *at = CMD_READ;
    return (status & STATUS_READY) && !(status & STATUS_FAILED);
}

uint32_t nv_page_read(uint16_t n)
{
    uint32_t word = 0;
    uint8_t i;

    for (i = 4; i; i--)
        word = word << 8 | *octet_at(n, (uint8_t)(i - 1u));
    return word;
}

bool nv_page_program(uint16_t n, uint32_t word)
{
    uint8_t i;

    for (i = 0; i < 4; i++)
        if (!command(octet_at(n, i), CMD_PROGRAM, (uint8_t)(word >> (8u * i))))
            return false;
    return nv_page_read(n) == word;
}

bool nv_page_erase(void)
{
    return command(octet_at(0, 0), CMD_ERASE, CMD_ERASE_SURE) && nv_page_read(0) == 0xFFFFFFFFu;
}
