#include "hal/riscv/core.h"
#include "hal/line_uart.h"
#include "hal_board.h"
#include "uart.h"

#define MSTATUS_MIE     0x008u
#define MIE_TIMER       0x080u
#define MIE_EXTERNAL    0x800u
#define MCAUSE_TIMER    0x80000007u
#define MCAUSE_EXTERNAL 0x8000000Bu
#define FAULT_STATUS    255 /* a fault is our bug, like a failed ASSERT */

#define PLIC_PRIORITY(irq) (BOARD_PLIC + 4u * (irq))
#define PLIC_ENABLE(irq)   (BOARD_PLIC + 0x2000u + 4u * ((irq) / 32u))
#define PLIC_THRESHOLD     (BOARD_PLIC + 0x200000u)
#define PLIC_CLAIM         (BOARD_PLIC + 0x200004u)

static volatile bool interrupted; /* an interrupt has come since hal_idle() looked */

/* ---- traps ----------------------------------------------------------------------------------------------- */

__attribute__((interrupt("machine"), aligned(4))) static void trap(void)
{
    uint32_t cause;
    uint32_t irq;

    __asm__ volatile("csrr %0, mcause" : "=r"(cause));
    interrupted = true;
    if (cause == MCAUSE_TIMER) {
        timer_stop();
        line_uart_timer_isr();
    } else if (cause == MCAUSE_EXTERNAL) {
        while ((irq = REG(PLIC_CLAIM)) != 0) {
            part_irq_isr(irq);
            REG(PLIC_CLAIM) = irq;
        }
    } else {
        core_exit(FAULT_STATUS);
    }
}

void core_irq_enable(uint32_t irq)
{
    REG(PLIC_PRIORITY(irq)) = 1;
    REG(PLIC_ENABLE(irq)) |= 1ul << irq % 32u;
}

/* ---- machine --------------------------------------------------------------------------------------------- */

void hal_init(void)
{
    (void)hal_irq_save();
    __asm__ volatile("csrw mtvec, %0" : : "r"(trap));
    timer_stop();
    REG(PLIC_THRESHOLD) = 0;
    part_init();
    __asm__ volatile("csrw mie, %0" : : "r"(MIE_TIMER | MIE_EXTERNAL));
}

uint8_t hal_irq_save(void)
{
    uint32_t mstatus;

    __asm__ volatile("csrrc %0, mstatus, %1" : "=r"(mstatus) : "r"(MSTATUS_MIE) : "memory");
    return (uint8_t)((mstatus & MSTATUS_MIE) ? HAL_IRQ_ON : 0u);
}

void hal_irq_restore(uint8_t state)
{
    if (state)
        __asm__ volatile("csrs mstatus, %0" : : "r"(MSTATUS_MIE) : "memory");
}

/* wfi ends with a pending interrupt even while masked (3.3.3), so nothing is missed between the look and the sleep. */
void hal_idle(void)
{
    uint8_t irq = hal_irq_save();

    if (!interrupted) {
        line_uart_wake();
        __asm__ volatile("wfi" : : : "memory");
        hal_irq_restore(HAL_IRQ_ON);
        (void)hal_irq_save();
    }
    interrupted = false;
    hal_irq_restore(irq);
    (void)hal_ticks();
}
