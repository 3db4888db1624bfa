/* What a remote module asks of its board. */
#ifndef REMOTE_BOARD_H
#define REMOTE_BOARD_H

#include "check.h"

/* All sixteen digital inputs, bit i = channel i. isr. */
uint16_t rm_board_inputs_isr(void) IN_ISR;

/* One conversion, 0..0FFFH: input 0..5 is channel 01..06; input RM_BOARD_REFERENCE is a fixed half of the full
 * scale, for the plausibility check. isr, lock. */
#define RM_BOARD_REFERENCE 6u
uint16_t rm_board_adc_isr(uint8_t input) IN_ISR;

/* Set all sixteen digital outputs / one analog output 0..5, 0..0FFFH. main. */
void rm_board_digital(uint16_t outputs);
void rm_board_analog(uint8_t index, uint16_t value);

/* What is really there, read back from the terminals. A board that cannot know says what was set. main. */
uint16_t rm_board_digital_readback(void);
uint16_t rm_board_analog_readback(uint8_t index);

/* Program memory, octets 0..size-1, and the CRC-16 (crc16.h) it must have; 0: unknown, the first pass decides. main. */
uint16_t rm_board_program_size(void);
uint8_t rm_board_program_octet(uint16_t at);
uint16_t rm_board_program_crc(void);

/* RAM that is checked octet by octet, 0..size-1; called with interrupts masked. lock. */
uint16_t rm_board_ram_size(void);
uint8_t rm_board_ram_read_isr(uint16_t at) IN_ISR;
void rm_board_ram_write_isr(uint16_t at, uint8_t octet) IN_ISR;

#endif
