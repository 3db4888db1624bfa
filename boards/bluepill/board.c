/* What is particular to the Blue Pill: no address switches (a master sets the address, the last page of the flash keeps
 * it), the independent watchdog. */
#include "hal/cortexm/core.h"
#include "hal/nv_log.h"
#include "hal_board.h"

#define IWDG_KR     0x40003000u
#define IWDG_RELOAD 0xAAAAu

uint8_t hal_switches(void)
{
    return 126;
}

/* Kicks it; started by option bytes or a debugger, it bites after its reset value of about half a second. */
void hal_wdog_kick(void)
{
    REG(IWDG_KR) = IWDG_RELOAD;
}

void hal_reset(uint8_t why)
{
    (void)why;
    core_reset();
}

/* ---- flash: PM0075; half words, pages of 1 kB ---- */

#define FLASH_KEYR 0x40022004u
#define FLASH_SR   0x4002200Cu
#define FLASH_CR   0x40022010u
#define FLASH_AR   0x40022014u
#define KEY_1      0x45670123u
#define KEY_2      0xCDEF89ABu
#define SR_BUSY    0x01u
#define SR_DONE    0x34u /* end of operation and errors, cleared by writing 1 */
#define CR_PROGRAM 0x01u
#define CR_ERASE   0x02u
#define CR_START   0x40u
#define CR_LOCK    0x80u
#define PATIENCE   5000000ul

const uint16_t nv_page_words = BOARD_NV_PAGE_LEN / 4u;

static void finish(void)
{
    uint32_t patience = PATIENCE;

    while ((REG(FLASH_SR) & SR_BUSY) && --patience) {
    }
    REG(FLASH_SR) = SR_DONE;
}

static void unlock(void)
{
    if (!(REG(FLASH_CR) & CR_LOCK))
        return;
    REG(FLASH_KEYR) = KEY_1;
    REG(FLASH_KEYR) = KEY_2;
}

uint32_t nv_page_read(uint16_t n)
{
    return REG(BOARD_NV_PAGE + 4u * n);
}

bool nv_page_program(uint16_t n, uint32_t word)
{
    volatile uint16_t *half = (volatile uint16_t *)(BOARD_NV_PAGE + 4u * n);

    unlock();
    REG(FLASH_CR) = CR_PROGRAM;
    half[0] = (uint16_t)word;
    finish();
    half[1] = (uint16_t)(word >> 16);
    finish();
    REG(FLASH_CR) = CR_LOCK;
    return nv_page_read(n) == word;
}

bool nv_page_erase(void)
{
    unlock();
    REG(FLASH_CR) = CR_ERASE;
    REG(FLASH_AR) = BOARD_NV_PAGE;
    REG(FLASH_CR) = CR_ERASE | CR_START;
    finish();
    REG(FLASH_CR) = CR_LOCK;
    return nv_page_read(0) == 0xFFFFFFFFu;
}
