/* The request of the comparison, "read 10 holding registers", on a port that does nothing: what is counted
 * between the marks is the server's. Runs on a PC, a Cortex-M0 and an 8051. */
#include "modbus_figures/request.h"
#include "hal/hal.h"
#include "modbus/mb.h"

static uint16_t XDATA registers[10] = {0x1000, 0x1001, 0x1002, 0x1003, 0x1004,
                                       0x1005, 0x1006, 0x1007, 0x1008, 0x1009};
static uint8_t XDATA bits[2];

static const struct mb_block CODE blocks[] = {{MB_COILS, 0, 16, bits},
                                              {MB_INPUTS, 0, 16, bits},
                                              {MB_INPUT_REGS, 0, 10, registers},
                                              {MB_HOLDING, 0, 10, registers},
                                              MB_MAP_END};
const struct mb_block CODE *mb_map = blocks;

/* Address 17, function 03, address 0, 10 registers; CRC by hand with the bitwise rule of [S] 6.2.2. */
static const uint8_t CODE request[] = {0x11, 0x03, 0x00, 0x00, 0x00, 0x0A, 0xC7, 0x5D};
static const uint8_t CODE answer[] = {0x11, 0x03, 0x14, 0x10, 0x00, 0x10, 0x01, 0x10, 0x02,
                                      0x10, 0x03, 0x10, 0x04, 0x10, 0x05, 0x10, 0x06, 0x10,
                                      0x07, 0x10, 0x08, 0x10, 0x09, 0x10, 0xE1};

static const uint8_t XDATA *XDATA sent;
static uint16_t XDATA sent_n;

uint8_t hal_irq_save(void)
{
    return 0;
}

void hal_irq_restore(uint8_t state)
{
    (void)state;
}

uint8_t hal_line_open(uint32_t bit_per_s, uint8_t format)
{
    (void)bit_per_s;
    (void)format;
    return HAL_LINE_TIMED;
}

hal_dur_t hal_tbit(uint16_t n)
{
    return n;
}

void hal_silence(hal_dur_t d) IN_ISR
{
    (void)d;
}

void hal_send(const uint8_t XDATA *octets, uint16_t n) IN_ISR
{
    figure_mark(MARK_FIRST_OCTET_OUT);
    sent = octets;
    sent_n = n;
}

uint16_t hal_ticks(void)
{
    return 0;
}

void figure_open(void)
{
    mb_port.bit_per_s = 19200;
    mb_port.address = 0x11;
    mb_open();
    line_silence_isr();
}

void figure_request(void)
{
    static uint8_t i;
    sent_n = 0;
    for (i = 0; i < sizeof request; i++) {
        figure_mark(MARK_OCTET);
        line_octet_isr(request[i], 0);
        figure_mark(MARK_OCTET_DONE);
    }
    line_silence_isr(); /* t1.5 */
    figure_mark(MARK_SILENCE);
    line_silence_isr(); /* t3.5 */
    mb_poll();
    figure_mark(MARK_POLL_DONE);
    line_sent_isr();
}

uint8_t figure_ok(void)
{
    uint8_t i;
    if (sent_n != sizeof answer)
        return 0;
    for (i = 0; i < sizeof answer; i++)
        if (sent[i] != answer[i])
            return 0;
    return 1;
}
