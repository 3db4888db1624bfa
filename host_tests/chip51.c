/* The modelled 8273 for host_tests/hdlc_chip.py, which is not C: one chip, bit by bit. */
#include "sim/hdlc_bits.h"
#include "sim/i8273.h"

static struct i8273 chip;

void chip_begin(void)
{
    i8273_power_on(&chip);
}

unsigned chip_read(unsigned reg)
{
    return i8273_read(&chip, (uint8_t)reg);
}

void chip_write(unsigned reg, unsigned value)
{
    i8273_write(&chip, (uint8_t)reg, (uint8_t)value);
}

/* RxINT in bit 0, TxINT in bit 1 */
unsigned chip_interrupts(void)
{
    return (i8273_int_rx(&chip) ? 1u : 0) | (i8273_int_tx(&chip) ? 2u : 0);
}

/* One bit time, the line at level (1 when nobody drives it). -> 0, 1: the chip drove this; 2: it did not. */
unsigned chip_bit(unsigned level)
{
    i8273_shift_out(&chip);
    i8273_shift_in(&chip, chip.rts || level);
    return chip.rts ? chip.txd : 2u;
}

/* Bit times until status or interrupts would change, levels[0..n-1] being on the line: 1..n. */
unsigned chip_quiet(const uint8_t *levels, unsigned n)
{
    const struct i8273 now = chip;
    const unsigned status = chip_read(I8273_COMMAND), interrupts = chip_interrupts();
    unsigned k = 0;
    while (k < n) {
        chip_bit(levels[k++]);
        if (chip_read(I8273_COMMAND) != status || chip_interrupts() != interrupts)
            break;
    }
    chip = now;
    return k;
}
