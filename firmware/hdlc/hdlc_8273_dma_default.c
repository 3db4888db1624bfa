/* A port without a DMA controller. */
#include "hal/hal_8273.h"

void hal_8273_dma_rx_isr(uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    (void)octets;
    (void)n;
}

void hal_8273_dma_tx_isr(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    (void)octets;
    (void)n;
}
