/* The processor's side of the modelled 8273: registers, a DMA controller, two interrupt lines. */
#include "hal_8273_model.h"
#include "hal/hal_8273.h"

struct i8273 hal_8273_chip;

/* More upcalls than any frame needs at one instant: the driver does not take what the chip offers. */
#define UPCALLS_MAX 64u

static struct {
    uint8_t *rx;
    const uint8_t *tx;
    uint16_t rx_left, tx_left;
} dma;

static bool broken;
static uint8_t broken_value;

void hal_8273_break(bool is_broken, uint8_t value)
{
    broken = is_broken;
    broken_value = value;
}

uint8_t hal_8273_read(uint8_t reg)
{
    return broken ? broken_value : i8273_read(&hal_8273_chip, reg);
}

void hal_8273_write(uint8_t reg, uint8_t value)
{
    if (!broken)
        i8273_write(&hal_8273_chip, reg, value);
}

void hal_8273_dma_rx_isr(uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    dma.rx = octets;
    dma.rx_left = n;
}

void hal_8273_dma_tx_isr(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    dma.tx = octets;
    dma.tx_left = n;
}

/* A channel whose count has run out leaves the request standing: the chip then sees an overrun or underrun. */
static void serve_dma(void)
{
    if (i8273_drq_rx(&hal_8273_chip) && dma.rx_left) {
        *dma.rx++ = i8273_read(&hal_8273_chip, I8273_RX_DATA);
        dma.rx_left--;
    }
    if (i8273_drq_tx(&hal_8273_chip) && dma.tx_left) {
        i8273_write(&hal_8273_chip, I8273_TX_DATA, *dma.tx++);
        dma.tx_left--;
    }
}

bool hal_8273_serve_isr(void)
{
    if (broken)
        return true;
    serve_dma();
    for (unsigned i = 0; i < UPCALLS_MAX; i++) {
        if (i8273_int_rx(&hal_8273_chip))
            chip_rx_isr();
        else if (i8273_int_tx(&hal_8273_chip))
            chip_tx_isr();
        else
            return true;
        serve_dma();
    }
    return false;
}
