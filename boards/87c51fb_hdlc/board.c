/* Terminals and memory of the remote module on the 87C51FB. */
#include "hal/hal.h"
#include "remote_board.h"
#include "remote_log.h"
#include "wiring.h"

static volatile XDATA uint8_t __at(OUTPUT_ADDRESS) output[2];
static volatile XDATA uint8_t __at(INPUT_ADDRESS) input[2];
static volatile XDATA uint8_t __at(ADC_ADDRESS) adc[3];
static volatile XDATA uint8_t __at(DAC_ADDRESS) dac[12];

/* Turns of a loop of at least two machine cycles: 25 us, one conversion. */
#define CONVERSION_TURNS 13u

uint16_t rm_board_inputs_isr(void) IN_ISR
{
    return (uint16_t)((uint16_t)input[1] << 8 | input[0]);
}

uint16_t rm_board_adc_isr(uint8_t channel) IN_ISR
{
    uint8_t turns = CONVERSION_TURNS;

    adc[0] = channel;
    while (--turns) {
    }
    return (uint16_t)((uint16_t)adc[1] << 8 | adc[2]);
}

void rm_board_digital(uint16_t outputs)
{
    output[0] = (uint8_t)outputs;
    output[1] = (uint8_t)(outputs >> 8);
}

void rm_board_analog(uint8_t index, uint16_t value)
{
    dac[index << 1] = (uint8_t)(value >> 8);
    dac[(index << 1) + 1u] = (uint8_t)value;
}

uint16_t rm_board_digital_readback(void)
{
    return (uint16_t)((uint16_t)output[1] << 8 | output[0]);
}

uint16_t rm_board_analog_readback(uint8_t index)
{
    return (uint16_t)((uint16_t)dac[index << 1] << 8 | dac[(index << 1) + 1u]);
}

uint16_t rm_board_program_size(void)
{
    return PROGRAM_SIZE;
}

uint8_t rm_board_program_octet(uint16_t at)
{
    return *(const uint8_t CODE *)at;
}

/* our choice: the first pass after power-up decides; an EPROM that loses bits does so while it runs. */
uint16_t rm_board_program_crc(void)
{
    return 0;
}

/* The check cannot test the octets it works with; it tests the sample log, the largest part of RAM in use. */
uint16_t rm_board_ram_size(void)
{
    return 2u * RM_LOG_WORDS;
}

uint8_t rm_board_ram_read_isr(uint16_t at) IN_ISR
{
    return ((volatile XDATA uint8_t *)rm_log_ring)[at];
}

void rm_board_ram_write_isr(uint16_t at, uint8_t octet) IN_ISR
{
    ((volatile XDATA uint8_t *)rm_log_ring)[at] = octet;
}
