/* What is particular to the LM3S6965 evaluation board. */
#include "hal/cortexm/core.h"
#include "hal/nv_log.h"
#include "hal_board.h"
#include "semihosting.h"

/* No address switches; the image is delivered with address 3 in its non-volatile page, and a master may change it. */
#define PRESET_ADDRESS 3u
__attribute__((section(".nv"), used)) static const uint32_t delivered[] = {
    NV_LOG_WORD(0u, PRESET_ADDRESS), NV_LOG_WORD(1u, (uint8_t)~PRESET_ADDRESS)};

uint8_t hal_switches(void)
{
    return 126;
}

void hal_wdog_kick(void)
{
}

/* ---- flash controller: LM3S6965 data sheet, chapter 8; words of 32 bits, pages of 1 kB ---- */

#define FLASH_FMA   0x400FD000u
#define FLASH_FMD   0x400FD004u
#define FLASH_FMC   0x400FD008u
#define FMC_KEY     0xA4420000u
#define FMC_WRITE   0x1u
#define FMC_ERASE   0x2u
#define FMC_PATIENCE 5000000ul

const uint16_t nv_page_words = BOARD_NV_PAGE_LEN / 4u;

uint32_t nv_page_read(uint16_t n)
{
    return REG(BOARD_NV_PAGE + 4u * n);
}

static void command(uint32_t address, uint32_t what)
{
    uint32_t patience = FMC_PATIENCE;

    REG(FLASH_FMA) = address;
    REG(FLASH_FMC) = FMC_KEY | what;
    while ((REG(FLASH_FMC) & what) && --patience) {
    }
}

bool nv_page_program(uint16_t n, uint32_t word)
{
    REG(FLASH_FMD) = word;
    command(BOARD_NV_PAGE + 4u * n, FMC_WRITE);
    return nv_page_read(n) == word;
}

bool nv_page_erase(void)
{
    command(BOARD_NV_PAGE, FMC_ERASE);
    return nv_page_read(0) == 0xFFFFFFFFu;
}

/* Without a debugger the break point is a fault, which comes back here: hence the flag. */
void hal_reset(uint8_t why)
{
    static bool asked;

    if (!asked) {
        asked = true;
        semihosting_exit(why);
    }
    core_reset();
}
