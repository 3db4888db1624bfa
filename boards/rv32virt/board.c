/* What is particular to QEMU's "virt": PCI, the flash, the way out. */
#include "hal_board.h"
#include "hal/hal.h"
#include "hal/nv_log.h"
#include "hal/riscv/core.h"

#define PCI_SLOT_1     0x30008000u /* configuration space of bus 0, device 1 */
#define PCI_COMMAND    0x04u
#define PCI_BAR0       0x10u
#define PCI_IO         0x1u
#define EXIT_FAILED(n) ((uint32_t)(n) << 16 | 0x3333u)
#define EXIT_PASSED    0x5555u
#define EXIT_RESET     0x7777u

void board_init(void)
{
    REG(PCI_SLOT_1 + PCI_BAR0) = (BOARD_LINE_UART & 0xFFFFu) | PCI_IO;
    REG(PCI_SLOT_1 + PCI_COMMAND) = PCI_IO;
}

uint8_t hal_switches(void)
{
    return 126;
}

void hal_wdog_kick(void)
{
}

void core_exit(int status)
{
    REG(BOARD_EXIT) = status ? EXIT_FAILED(status) : EXIT_PASSED;
    for (;;) {
    }
}

void hal_reset(uint8_t why)
{
    if (why == HAL_RESET_ASSERT)
        core_exit(why);
    REG(BOARD_EXIT) = EXIT_RESET;
    for (;;) {
    }
}

/* ---- flash: Intel command set (CFI 0001H), both chips at once; the code runs from RAM ---- */

#define BOTH(command)  ((uint32_t)(command) << 16 | (command))
#define CFI_ARRAY      BOTH(0xFFu)
#define CFI_PROGRAM    BOTH(0x40u)
#define CFI_ERASE      BOTH(0x20u)
#define CFI_CONFIRM    BOTH(0xD0u)
#define CFI_READY      BOTH(0x80u)
#define CFI_PATIENCE   5000000ul

const uint16_t nv_page_words = BOARD_NV_PAGE_WORDS;

uint32_t nv_page_read(uint16_t n)
{
    return REG(BOARD_NV_PAGE + 4u * n);
}

static void finish(uint32_t address)
{
    uint32_t patience = CFI_PATIENCE;

    while ((REG(address) & CFI_READY) != CFI_READY && --patience) {
    }
    REG(address) = CFI_ARRAY;
}

bool nv_page_program(uint16_t n, uint32_t word)
{
    REG(BOARD_NV_PAGE + 4u * n) = CFI_PROGRAM;
    REG(BOARD_NV_PAGE + 4u * n) = word;
    finish(BOARD_NV_PAGE);
    return nv_page_read(n) == word;
}

bool nv_page_erase(void)
{
    REG(BOARD_NV_PAGE) = CFI_ERASE;
    REG(BOARD_NV_PAGE) = CFI_CONFIRM;
    finish(BOARD_NV_PAGE);
    return nv_page_read(0) == 0xFFFFFFFFu;
}
