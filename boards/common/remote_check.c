#include "remote_check.h"
#include "crc16.h"
#include "hal/hal.h"
#include "remote_board.h"
#include "remote_module.h"

/* our choice: octets of program memory a step; the reference conversion is good within 32 of 4096; an output within
 * 64, and wrong only after so many looks in a row, it may be settling; all outputs or the converter once in
 * so many steps. */
#define PROGRAM_STEP  8u
#define REFERENCE     0x0800u
#define REFERENCE_TOL 32u
#define OUTPUT_TOL    64u
#define OUTPUT_LOOKS  3u

static uint8_t type, faults, seen;
static uint16_t passes;
static uint16_t ram_at, program_at, program_crc, program_good;
static bool program_known;
static uint8_t output_at;
static uint8_t XDATA looks[RM_DIGITAL_CHANNELS];
static uint16_t stuck;

uint8_t rm_faults(void)
{
    return faults;
}

uint8_t rm_faults_seen(void)
{
    return seen;
}

uint16_t rm_passes(void)
{
    return passes;
}

uint16_t rm_check_stuck(void)
{
    return stuck;
}

static void report(uint8_t fault, bool there)
{
    if (there) {
        faults |= fault;
        seen |= fault;
    } else {
        faults &= (uint8_t)~fault;
    }
}

static uint16_t distance(uint16_t a, uint16_t b)
{
    return a > b ? (uint16_t)(a - b) : (uint16_t)(b - a);
}

/* Two patterns in one octet, then what it held. A fault stays until a whole pass found none. */
static bool octet_is_good(uint16_t at)
{
    const uint8_t irq = hal_irq_save();
    const uint8_t held = rm_board_ram_read_isr(at);
    bool good;

    rm_board_ram_write_isr(at, 0x55);
    good = rm_board_ram_read_isr(at) == 0x55;
    rm_board_ram_write_isr(at, 0xAA);
    good = good && rm_board_ram_read_isr(at) == 0xAA;
    rm_board_ram_write_isr(at, held);
    hal_irq_restore(irq);
    return good;
}

static void check_ram(void)
{
    static bool bad;

    if (ram_at == 0)
        bad = false;
    if (!octet_is_good(ram_at)) {
        bad = true;
        report(RM_FAULT_RAM, true);
    }
    if (++ram_at < rm_board_ram_size())
        return;
    ram_at = 0;
    report(RM_FAULT_RAM, bad);
}

static void check_program(void)
{
    uint8_t step = PROGRAM_STEP;

    if (program_at == 0)
        program_crc = CRC16_START;
    for (; step && program_at < rm_board_program_size(); step--)
        program_crc = crc16_add(program_crc, rm_board_program_octet(program_at++));
    if (program_at < rm_board_program_size())
        return;
    if (!program_known) {
        program_known = true;
        program_good = rm_board_program_crc() ? rm_board_program_crc() : program_crc;
    }
    report(RM_FAULT_PROGRAM, program_crc != program_good);
    program_at = 0;
    passes++;
}

static void check_converter(void)
{
    const uint8_t irq = hal_irq_save();
    const uint16_t reference = rm_board_adc_isr(RM_BOARD_REFERENCE);
    hal_irq_restore(irq);

    report(RM_FAULT_CONVERTER, distance(reference, REFERENCE) > REFERENCE_TOL);
}

static bool output_is_right(uint8_t index)
{
    if (type == RM_AO)
        return distance(rm_board_analog_readback(index), rm_output(index)) <= OUTPUT_TOL;
    return ((rm_board_digital_readback() >> index) & 1u) == rm_output(index);
}

static void check_output(void)
{
    const uint16_t bit = (uint16_t)(1u << output_at);

    if (output_is_right(output_at)) {
        looks[output_at] = 0;
        stuck &= (uint16_t)~bit;
    } else if (++looks[output_at] >= OUTPUT_LOOKS) {
        looks[output_at] = OUTPUT_LOOKS;
        stuck |= bit;
    }
    report(RM_FAULT_OUTPUT, stuck != 0);
    if (++output_at == (type == RM_AO ? RM_ANALOG_CHANNELS : RM_DIGITAL_CHANNELS))
        output_at = 0;
}

void rm_check_poll(void)
{
    check_ram();
    check_program();
    if (type == RM_AI)
        check_converter();
    if (type & (RM_DO | RM_AO))
        check_output();
}

void rm_check_init(uint8_t of)
{
    uint8_t i;

    type = of;
    faults = seen = 0;
    passes = 0;
    ram_at = program_at = 0;
    program_known = false;
    output_at = 0;
    stuck = 0;
    for (i = 0; i < RM_DIGITAL_CHANNELS; i++)
        looks[i] = 0;
}
