#include "rm_host_board.h"
#include "remote_board.h"

#include <string.h>

#define DIGITALS  16u
#define ANALOGS   6u
#define FULL      0x0FFFu
#define REFERENCE 0x0800u

static struct {
    uint16_t digital, digital_fixed, outputs;
    uint16_t analog[ANALOGS], dac[ANALOGS];
    bool analog_fixed[ANALOGS];
    uint8_t ram[64];
    bool bad_ram, bad_program, bad_converter, bad_output;
} host;

/* The program checks its own code: what the linker has put between these two. */
extern const char __executable_start, etext;
#define PROGRAM_MAX 0x8000u

void rm_host_live(uint32_t ms)
{
    const uint16_t count = (uint16_t)(ms / 500u);

    host.digital = (uint16_t)((host.digital & host.digital_fixed) | (count & ~host.digital_fixed));
    for (uint32_t i = 0; i < ANALOGS; i++) {
        const uint32_t at = (ms / (i + 1u) + i * 700u) % (2u * FULL);
        if (!host.analog_fixed[i])
            host.analog[i] = (uint16_t)(at <= FULL ? at : 2u * FULL - at);
    }
}

void rm_host_fix_digital(uint8_t channel, bool on)
{
    const uint16_t bit = (uint16_t)(1u << channel);

    host.digital_fixed |= bit;
    host.digital = (uint16_t)(on ? host.digital | bit : host.digital & ~bit);
}

void rm_host_fix_analog(uint8_t index, uint16_t value)
{
    host.analog_fixed[index] = true;
    host.analog[index] = value;
}

uint16_t rm_host_inputs(void)
{
    return host.digital;
}

uint16_t rm_host_adc(uint8_t index)
{
    return host.analog[index];
}

uint16_t rm_host_outputs(void)
{
    return host.outputs;
}

uint16_t rm_host_dac(uint8_t index)
{
    return host.dac[index];
}

bool rm_host_fault(const char *what, bool on)
{
    if (strcmp(what, "ram") == 0)
        host.bad_ram = on;
    else if (strcmp(what, "program") == 0)
        host.bad_program = on;
    else if (strcmp(what, "converter") == 0)
        host.bad_converter = on;
    else if (strcmp(what, "output") == 0)
        host.bad_output = on;
    else
        return false;
    return true;
}

/* ---- remote_board.h ------------------------------------------------------------------------------ */

uint16_t rm_board_inputs_isr(void) IN_ISR
{
    return host.digital;
}

uint16_t rm_board_adc_isr(uint8_t input) IN_ISR
{
    if (input == RM_BOARD_REFERENCE)
        return host.bad_converter ? FULL : REFERENCE;
    return host.analog[input];
}

void rm_board_digital(uint16_t outputs)
{
    host.outputs = outputs;
}

void rm_board_analog(uint8_t index, uint16_t value)
{
    host.dac[index] = value;
}

/* A broken output is off, or 0, whatever it is told. */
uint16_t rm_board_digital_readback(void)
{
    return host.bad_output ? 0 : host.outputs;
}

uint16_t rm_board_analog_readback(uint8_t index)
{
    return host.bad_output ? 0 : host.dac[index];
}

uint16_t rm_board_program_size(void)
{
    const uintptr_t size = (uintptr_t)&etext - (uintptr_t)&__executable_start;

    return (uint16_t)(size < PROGRAM_MAX ? size : PROGRAM_MAX);
}

uint8_t rm_board_program_octet(uint16_t at)
{
    const volatile uint8_t *program = (const volatile uint8_t *)&__executable_start;

    return (uint8_t)(program[at] ^ (at == 0 && host.bad_program));
}

uint16_t rm_board_program_crc(void)
{
    return 0;
}

uint16_t rm_board_ram_size(void)
{
    return sizeof host.ram;
}

uint8_t rm_board_ram_read_isr(uint16_t at) IN_ISR
{
    return (uint8_t)(host.ram[at] & (host.bad_ram ? 0xFEu : 0xFFu));
}

void rm_board_ram_write_isr(uint16_t at, uint8_t octet) IN_ISR
{
    host.ram[at] = octet;
}
