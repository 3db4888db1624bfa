/* The machine around the line: interrupt controllers, time, console UART, non-volatile cells. */
#include "hal/con_in.h"
#include "hal/line_uart.h"
#include "hal/x86/pc.h"
#include "hal_board.h"

static uint16_t last_count;
static uint32_t clocks;

/* ---- interrupts ------------------------------------------------------------------------------------------ */

#define EFLAGS_IF 0x200u

uint8_t hal_irq_save(void)
{
    uint32_t flags;

    __asm__ volatile("pushfl; popl %0; cli" : "=r"(flags) : : "memory");
    return (flags & EFLAGS_IF) ? HAL_IRQ_ON : 0;
}

void hal_irq_restore(uint8_t state)
{
    if (state)
        __asm__ volatile("sti" : : : "memory");
}

/* Initialisation words 1 to 4 and the mask: Intel 8259A. Everything but timer, COM1 and COM2 stays masked. */
static void init_pics(void)
{
    out8(PIC1, 0x11);
    out8(PIC2, 0x11);
    out8(PIC1 + 1u, VECTOR_OF_IRQ0);
    out8(PIC2 + 1u, VECTOR_OF_IRQ0 + 8u);
    out8(PIC1 + 1u, 0x04);
    out8(PIC2 + 1u, 0x02);
    out8(PIC1 + 1u, 0x01);
    out8(PIC2 + 1u, 0x01);
    out8(PIC1 + 1u, (uint8_t)~(1u << IRQ_TIMER | 1u << IRQ_COM1 | 1u << IRQ_COM2));
    out8(PIC2 + 1u, 0xFF);
}

/* ---- time ------------------------------------------------------------------------------------------------ */

static void init_pit(void)
{
    out8(PIT_MODE, PIT_CH0_ONE_SHOT);
    out8(PORT_B, (uint8_t)((in8(PORT_B) & ~2u) | 1u));
    out8(PIT_MODE, PIT_CH2_RATE);
    out8(PIT_CH2, 0);
    out8(PIT_CH2, 0);
}

static uint16_t count_isr(void)
{
    uint16_t down;

    out8(PIT_MODE, PIT_CH2_LATCH);
    down = in8(PIT_CH2);
    down = (uint16_t)(down | (uint16_t)(in8(PIT_CH2) << 8));
    return (uint16_t)(0u - down);
}

uint32_t pc_clocks_isr(void)
{
    uint16_t count = count_isr();

    clocks += (uint16_t)(count - last_count);
    last_count = count;
    return clocks;
}

/* ---- console --------------------------------------------------------------------------------------------- */

static void init_console(void)
{
    out8(BOARD_CONSOLE_UART + UART_LCR, LCR_DLAB);
    out8(BOARD_CONSOLE_UART + UART_DATA, (uint8_t)(BOARD_UART_HZ / 16u / BOARD_CONSOLE_RATE));
    out8(BOARD_CONSOLE_UART + UART_IER, 0);
    out8(BOARD_CONSOLE_UART + UART_LCR, LCR_8N1);
    out8(BOARD_CONSOLE_UART + UART_FCR, FCR_ON_AND_CLEAR);
    out8(BOARD_CONSOLE_UART + UART_MCR, MCR_DTR | MCR_RTS | MCR_OUT2);
    out8(BOARD_CONSOLE_UART + UART_IER, IER_RX);
    (void)in8(BOARD_CONSOLE_UART + UART_DATA);
}

void pc_console_isr(void)
{
    while (in8(BOARD_CONSOLE_UART + UART_LSR) & LSR_READY)
        con_in_isr(in8(BOARD_CONSOLE_UART + UART_DATA));
    (void)in8(BOARD_CONSOLE_UART + UART_IIR);
}

void hal_con_put(uint8_t octet)
{
    uint16_t patience = 0xFFFFu;

    while (!(in8(BOARD_CONSOLE_UART + UART_LSR) & LSR_THRE) && --patience) {
    }
    out8(BOARD_CONSOLE_UART + UART_DATA, octet);
}

/* ---- machine --------------------------------------------------------------------------------------------- */

void hal_init(void)
{
    init_pics();
    init_pit();
    init_console();
    out8(BOARD_LINE_UART + UART_MCR, MCR_DTR | MCR_OUT2);
    last_count = count_isr();
}

void pc_exit(int status)
{
    hal_reset((uint8_t)status);
}

/* Sleep until an interrupt, unless one has come since the last time: the main loop may not have seen what it brought. */
void hal_idle(void)
{
    uint8_t irq = hal_irq_save();

    if (!pc_had_irq) {
        line_uart_wake();
        __asm__ volatile("sti; hlt" : : : "memory");
        (void)hal_irq_save();
    }
    pc_had_irq = false;
    hal_irq_restore(irq);
    (void)hal_ticks();
}
