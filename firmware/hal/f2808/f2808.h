/* Registers of the TMS320F2808: SCI-A, CPU timers 0 and 1, PIE, GPIO, watchdog. Addresses are of 16-bit words. Sources: TI
 * SPRUFK7 (SCI), SPRU712 (system control and interrupts), SPRU716 for the echo-back set-up the tests repeat.
 *
 * "reg.h" gives reg_get(address) and reg_set(address, value): the memory itself on the part (part/reg.h), the model in tests. */
#ifndef FIELDLING_F2808_H
#define FIELDLING_F2808_H

#include "reg.h"

#define SCICCR   0x7050u
#define SCICTL1  0x7051u
#define SCIHBAUD 0x7052u
#define SCILBAUD 0x7053u
#define SCICTL2  0x7054u
#define SCIRXST  0x7055u
#define SCIRXBUF 0x7057u
#define SCITXBUF 0x7059u
#define SCIFFTX  0x705Au
#define SCIFFRX  0x705Bu
#define SCIFFCT  0x705Cu

#define CCR_TWO_STOP 0x80u
#define CCR_EVEN     0x40u
#define CCR_PARITY   0x20u
#define CCR_LOOP     0x10u
#define CCR_8_BITS   0x07u
#define CCR_7_BITS   0x06u

#define CTL1_RX_ERR_ENA 0x40u
#define CTL1_RUN        0x20u /* 0 holds the SCI in reset */
#define CTL1_TXENA      0x02u
#define CTL1_RXENA      0x01u

#define CTL2_TX_EMPTY 0x40u /* buffer and shift register are empty */

#define RXST_ERROR 0x80u
#define RXST_BREAK 0x20u
#define RXST_FE    0x10u
#define RXST_OE    0x08u
#define RXST_PE    0x04u

#define RXBUF_FE 0x8000u /* of the octet that is read, with FIFOs */
#define RXBUF_PE 0x4000u

#define FFTX_ON        0xC000u /* SCIRST off reset, FIFO enhancements on */
#define FFTX_FIFO_ON   0x2000u /* 0 empties it */
#define FFTX_INT_CLEAR 0x0040u
#define FFTX_INT_ENA   0x0020u
#define FFRX_OVERFLOW  0x8000u
#define FFRX_OVF_CLEAR 0x4000u
#define FFRX_FIFO_ON   0x2000u
#define FFRX_INT_CLEAR 0x0040u
#define FFRX_INT_ENA   0x0020u
#define FIFO_COUNT(reg) ((uint16_t)((reg) >> 8 & 0x1Fu))
#define FIFO_OCTETS    16u

/* CPU timer n: counts down from PRD at the CPU clock, sets TIF at 0 and begins anew. */
#define TIMER0  0x0C00u
#define TIMER1  0x0C08u
#define TIM_LOW  0u
#define TIM_HIGH 1u
#define PRD_LOW  2u
#define PRD_HIGH 3u
#define TCR      4u
#define TPR      6u
#define TPRH     7u
#define TCR_FLAG   0x8000u /* written 1: cleared */
#define TCR_ENA    0x4000u
#define TCR_RELOAD 0x0020u
#define TCR_STOP   0x0010u

#define PIECTRL   0x0CE0u
#define PIEACK    0x0CE1u
#define PIEIER1   0x0CE2u
#define PIEIER9   0x0CF2u
#define PIE_TIMER0 0x40u /* group 1, line 7 */
#define PIE_SCIRXA 0x01u /* group 9, line 1 */
#define PIE_SCITXA 0x02u /* group 9, line 2 */

#define GPADIR   0x6F8Au
#define GPAMUX2  0x6F88u
#define GPASET   0x6FC2u
#define GPACLEAR 0x6FC4u

#define PCLKCR0 0x701Cu
#define PCLK_SCIA 0x0400u
#define WDKEY   0x7025u
#define WDCR    0x7029u

#endif
