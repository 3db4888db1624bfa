/* Registers of a PC: 8259 interrupt controllers, 8254 timer, 16550 UARTs. Data sheets: Intel 8259A, 82C54; National
 * PC16550D. Which of them a board has, and where, is said by its hal_board.h. */
#ifndef FIELDLING_X86_PC_H
#define FIELDLING_X86_PC_H

#include <stdbool.h>
#include <stdint.h>

static inline void out8(uint16_t port, uint8_t value)
{
    __asm__ volatile("outb %0,%1" : : "a"(value), "Nd"(port));
}

static inline uint8_t in8(uint16_t port)
{
    uint8_t value;

    __asm__ volatile("inb %1,%0" : "=a"(value) : "Nd"(port));
    return value;
}

/* ---- 8259 pair ---- */
#define PIC1           0x20u
#define PIC2           0xA0u
#define PIC_EOI        0x20u
#define PIC_READ_ISR   0x0Bu
#define IRQ_TIMER      0u
#define IRQ_COM2       3u
#define IRQ_COM1       4u
#define IRQ_SPURIOUS   7u
#define VECTOR_OF_IRQ0 0x20u

/* ---- 8254, 1.193182 MHz: channel 0 one-shot for silence, channel 2 free running for elapsed time ---- */
#define PIT_CH0          0x40u
#define PIT_CH2          0x42u
#define PIT_MODE         0x43u
#define PIT_CH0_ONE_SHOT 0x30u /* mode 0, low then high octet */
#define PIT_CH2_RATE     0xB4u /* mode 2, low then high octet */
#define PIT_CH2_LATCH    0x80u
#define PIT_HZ           1193182ul
#define PORT_B           0x61u /* bit 0 gate of channel 2, bit 1 speaker */

/* ---- 16550: offsets from its base ---- */
#define UART_DATA 0u
#define UART_IER  1u
#define UART_IIR  2u
#define UART_FCR  2u
#define UART_LCR  3u
#define UART_MCR  4u
#define UART_LSR  5u
#define UART_MSR  6u

#define IER_RX   0x01u
#define IER_THRE 0x02u
#define IER_LINE 0x04u

#define IIR_NONE 0x01u
#define IIR_ID   0x0Eu
#define IIR_THRE 0x02u

#define FCR_ON_AND_CLEAR 0x07u /* receiver trigger at one octet */
#define FIFO_OCTETS      16u

#define LCR_DLAB 0x80u
#define LCR_8N1  0x03u
#define LCR_8N2  0x07u
#define LCR_8E1  0x1Bu
#define LCR_8O1  0x0Bu
#define LCR_7N2  0x06u
#define LCR_7E1  0x1Au
#define LCR_7O1  0x0Au

#define MCR_DTR  0x01u
#define MCR_RTS  0x02u /* driver enable of the RS-485 converter */
#define MCR_OUT2 0x08u /* interrupt gate */
#define MCR_LOOP 0x10u

#define LSR_READY   0x01u
#define LSR_OVERRUN 0x02u
#define LSR_PARITY  0x04u
#define LSR_FRAMING 0x08u
#define LSR_BREAK   0x10u
#define LSR_ERRORS  0x1Eu
#define LSR_THRE    0x20u
#define LSR_TEMT    0x40u /* holding and shift register are empty: the last stop bit is out */

/* The interrupt stubs of start.S call this with the number of the request. */
void pc_irq_isr(uint32_t irq);

/* main() has returned: the image is a test. Does not return. */
void pc_exit(int status);

/* Console octets are waiting in the UART. isr. */
void pc_console_isr(void);

/* An interrupt has come since this was cleared. */
extern volatile bool pc_had_irq;

/* Clocks of channel 2 since start, 1.193182 MHz, wraps at 32 bits. Must be called at least every 54 ms. lock, isr. */
uint32_t pc_clocks_isr(void);

#endif
