/* The terminals of a remote module on a host, and what the console does to them. */
#ifndef FIELDLING_RM_HOST_BOARD_H
#define FIELDLING_RM_HOST_BOARD_H

#include <stdbool.h>
#include <stdint.h>

/* Inputs live until the console fixes them: digital ones count in binary, analog ones are triangles. */
void rm_host_live(uint32_t ms);

/* Digital channel 0..15, value 0 or 1; analog index 0..5, value 0..0FFFH. */
void rm_host_fix_digital(uint8_t channel, bool on);
void rm_host_fix_analog(uint8_t index, uint16_t value);

uint16_t rm_host_inputs(void);
uint16_t rm_host_adc(uint8_t index);
uint16_t rm_host_outputs(void);
uint16_t rm_host_dac(uint8_t index);

/* Break something, or mend it: "ram", "program", "converter", "output". False: no such thing. */
bool rm_host_fault(const char *what, bool on);

#endif
