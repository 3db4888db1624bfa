#include "remote_board_fake.h"
#include "remote_board.h"

#include <string.h>

struct remote_board_fake board;

void board_fake_begin(void)
{
    memset(&board, 0, sizeof board);
    board.analog_in[RM_BOARD_REFERENCE] = 0x0800;
    for (unsigned i = 0; i < sizeof board.program; i++)
        board.program[i] = (uint8_t)(i * 7u);
}

uint16_t rm_board_inputs_isr(void) IN_ISR
{
    return board.digital_in;
}

uint16_t rm_board_adc_isr(uint8_t input) IN_ISR
{
    return board.analog_in[input];
}

void rm_board_digital(uint16_t outputs)
{
    board.driven++;
    board.digital_out = outputs;
}

void rm_board_analog(uint8_t index, uint16_t value)
{
    board.driven++;
    board.analog_out[index] = value;
}

uint16_t rm_board_digital_readback(void)
{
    return (uint16_t)((board.digital_out & ~board.stuck_bits) | (board.stuck_at & board.stuck_bits));
}

uint16_t rm_board_analog_readback(uint8_t index)
{
    return (board.analog_stuck >> index) & 1u ? 0x0FFF : board.analog_out[index];
}

uint16_t rm_board_program_size(void)
{
    return sizeof board.program;
}

uint8_t rm_board_program_octet(uint16_t at)
{
    return board.program[at];
}

uint16_t rm_board_program_crc(void)
{
    return board.program_crc;
}

uint16_t rm_board_ram_size(void)
{
    return sizeof board.ram;
}

uint8_t rm_board_ram_read_isr(uint16_t at) IN_ISR
{
    return at == 7u ? board.ram[at] & (uint8_t)~board.ram_stuck_bits : board.ram[at];
}

void rm_board_ram_write_isr(uint16_t at, uint8_t octet) IN_ISR
{
    board.ram[at] = octet;
}
