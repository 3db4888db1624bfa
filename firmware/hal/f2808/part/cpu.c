/* Clocks, vectors and reset of the part. Source: TI SPRU712 (system control and interrupts). */
#include "cpu.h"
#include "hal/f2808/f2808.h"
#include "hal/f2808/machine.h"
#include "hal_board.h"

#define PLLSTS 0x7011u
#define LOSPCP 0x701Bu
#define PLLCR  0x7021u

#define PLLSTS_LOCKED  0x0001u
#define WDCR_OFF       0x0068u /* with the check value 101 */
#define WDCR_WRONG     0x0000u
#define VECTOR_TINT0   0x0D4Cu /* 1.7 */
#define VECTOR_SCIRXA  0x0DC0u /* 9.1 */
#define VECTOR_SCITXA  0x0DC2u /* 9.2 */
#define IER_1_AND_9    0x0101u

#define PLL_TIMES      (BOARD_CPU_HZ * 2u / BOARD_CRYSTAL_HZ)         /* CPU = crystal * n / 2         */
#define LOSPCP_DIVIDES (BOARD_CPU_HZ / BOARD_LSPCLK_HZ / 2u)          /* LSPCLK = CPU / 2n; n = 0: / 1 */
STATIC_ASSERT(PLL_TIMES >= 1u && PLL_TIMES <= 10u, the_pll_can_that);
STATIC_ASSERT(LOSPCP_DIVIDES <= 7u, the_prescaler_can_that);

extern cregister volatile unsigned int IER;

void cpu_clocks(void)
{
    cpu_allow();
    reg_set(WDCR, WDCR_OFF);
    reg_set(PLLCR, PLL_TIMES);
    while (!(reg_get(PLLSTS) & PLLSTS_LOCKED)) {
    }
    reg_set(LOSPCP, LOSPCP_DIVIDES);
    cpu_protect();
}

/* ---- interrupts: the port's functions are ordinary ones; these save what the CPU does not ------------------- */

static void (*timer0_isr)(void);
static void (*rx_isr)(void);
static void (*tx_isr)(void);

static interrupt void on_timer0(void)
{
    timer0_isr();
}

static interrupt void on_rx(void)
{
    rx_isr();
}

static interrupt void on_tx(void)
{
    tx_isr();
}

static void set_vector(uint16_t address, interrupt void (*function)(void))
{
    const uint32_t code = (uint32_t)(uintptr_t)function;

    reg_set(address, code & 0xFFFFu);
    reg_set(address + 1u, code >> 16);
}

void cpu_vectors(void (*timer0)(void), void (*rx)(void), void (*tx)(void))
{
    timer0_isr = timer0;
    rx_isr = rx;
    tx_isr = tx;
    cpu_allow();
    set_vector(VECTOR_TINT0, on_timer0);
    set_vector(VECTOR_SCIRXA, on_rx);
    set_vector(VECTOR_SCITXA, on_tx);
    cpu_protect();
    IER |= IER_1_AND_9;
}

void cpu_restart(uint8_t why)
{
    (void)why;
    cpu_allow();
    reg_set(WDCR, WDCR_WRONG);
    for (;;) {
    }
}
