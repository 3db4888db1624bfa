/* THE PORT, continued: an Intel 8273 protocol controller beside the processor (only boards that have one).
 *
 *     firmware/hdlc  --- hal_8273_*  --->  the chip's registers, in hal_8273_arch.h of firmware/hal/<arch>/
 *     firmware/hdlc  <-- chip_*_isr  ---  its two interrupt lines
 *
 * The line, its driver enable (/RTS) and its bit clock are the chip's. What differs between boards is how the
 * chip is reached, and whether a DMA controller moves the data.
 */
#ifndef FIELDLING_HAL_8273_H
#define FIELDLING_HAL_8273_H

#include "check.h"

/* Registers by A1 A0, and the data registers, which /TxDACK and /RxDACK select (8273 register map; the two
 * data addresses are our choice, as the 87C51FB board decodes them). */
#define HAL_8273_STATUS    0u /* read  */
#define HAL_8273_COMMAND   0u /* write */
#define HAL_8273_RESULT    1u /* read  */
#define HAL_8273_PARAMETER 1u /* write */
#define HAL_8273_TX_RESULT 2u /* read  */
#define HAL_8273_RESET     2u /* write */
#define HAL_8273_RX_RESULT 3u /* read  */
#define HAL_8273_TX_DATA   4u /* write */
#define HAL_8273_RX_DATA   8u /* read  */

/* From the port's hal_8273_arch.h, as functions or inline; where memory mapped, one access. isr, lock.
 *   uint8_t hal_8273_read(uint8_t reg);
 *   void hal_8273_write(uint8_t reg, uint8_t value); */
#include "hal_8273_arch.h"

/* Let the DMA controller store the next octets received at octets[0..n-1] / fetch the next ones to send from
 * there. A new call takes the place of the last one. A port without DMA needs neither: the default in
 * hdlc_8273_dma_default.c does nothing, and HDLC_8273_DMA must not be asked for. isr, lock. */
void hal_8273_dma_rx_isr(uint8_t XDATA *octets, uint16_t n) IN_ISR;
void hal_8273_dma_tx_isr(const uint8_t XDATA *octets, uint16_t n) IN_ISR;

/* Upcalls, implemented by hdlc_8273.c: RxINT, TxINT is active. The lines are levels: they stay until the driver has
 * read what caused them. A call without a cause does nothing, so both may share one interrupt. isr. */
void chip_rx_isr(void) IN_ISR;
void chip_tx_isr(void) IN_ISR;

#endif
