#include "sim/hdlc_bus.h"
#include "hal/posix/hal_virtual_vm.h"

#include <string.h>

#define BIT_7200   80000u /* ticks */
#define PATIENCE   1200u  /* bits: the longest answer of a remote module takes 700 */
#define IDLE_AFTER 24u    /* bits */

struct hbus hbus;

static hv_time loop_pause(void)
{
    return hbus.bit;
}

void hbus_begin(void)
{
    hv_begin();
    memset(&hbus, 0, sizeof hbus);
    hbus.bit = BIT_7200;
    hbus.our_level = hbus.last_level = true;
    i8273_power_on(&hal_8273_chip);
    hal_8273_break(false, 0);
}

void hbus_station(void (*init)(void), void (*loop)(void))
{
    hal_init();
    init();
    hal_irq_restore(HAL_IRQ_ON);
    hv_set_loop(loop, loop_pause);
}

void hbus_clear(void)
{
    hbus.answers = hbus.answer_n = 0;
    memset(hbus.events, 0, sizeof hbus.events);
    hbus.collisions = 0;
    hbus.driven = 0;
}

/* Our bit of this cell: false, we do not drive. */
static bool our_bit(void)
{
    if (hbus.out_at == hbus.out.n) {
        hbus.our_level = true;
        return false;
    }
    const bool bit = hbus.out.bit[hbus.out_at++];
    hbus.our_level = hbus.nrzi ? hbus.our_level ^ !bit : bit;
    if (hbus.out_at == hbus.out.n)
        hbus.our_end = hbus.now + 1;
    return true;
}

static void hear_station(bool level)
{
    const bool bit = hbus.nrzi ? level == hbus.last_level : level;
    hbus.last_level = level;
    const enum hb_event event = hb_decode(&hbus.decoder, bit);
    if (event == HB_FRAME) {
        hbus.answers++;
        hbus.answer_n = hbus.decoder.n;
        memcpy(hbus.answer, hbus.decoder.octets, hbus.decoder.n);
        if (hbus.tap)
            hbus.tap(hbus.answer, hbus.answer_n, true);
    } else {
        hbus.events[event]++;
    }
}

static void serve_interrupts(void)
{
    if (!hv_vm.on || hv_vm.masked)
        return;
    hv_vm.in_isr = true;
    hbus.stuck += !hal_8273_serve_isr();
    hv_vm.in_isr = false;
}

static bool spoilt(bool level, bool to_station)
{
    return hbus.spoil ? hbus.spoil(level, to_station) : level;
}

static void cell(void)
{
    struct i8273 *chip = &hal_8273_chip;
    const bool ours = our_bit();
    bool wire = true;

    i8273_shift_out(chip);
    if (chip->rts) {
        wire &= chip->txd;
        hbus.driven++;
        if (!hbus.answering)
            hbus.turn_round = hbus.now - hbus.our_end;
    }
    hbus.answering = chip->rts;
    if (ours) {
        wire &= hbus.our_level;
        hbus.collisions += chip->rts;
    } else {
        hear_station(spoilt(wire, false));
    }
    if (chip->rts && !hbus.echo)
        i8273_shift_in(chip, true);
    else
        i8273_shift_in(chip, spoilt(wire, true));
    serve_interrupts();
    hbus.now++;
    hv_run_for(hbus.bit);
}

void hbus_run(unsigned bits)
{
    while (bits--)
        cell();
}

void hbus_say_bits(const struct hb_line *line)
{
    hbus.out = *line;
    hbus.out_at = 0;
    hbus_run(line->n);
}

void hbus_say(const uint8_t *octets, unsigned n)
{
    static struct hb_line line;
    line.n = line.inserted = line.ones = 0;
    for (unsigned i = 0; i < hbus.preframe; i++)
        hb_raw(&line, 0, 8);
    hb_frame(&line, octets, n);
    if (hbus.tap)
        hbus.tap(octets, n, false);
    hbus_say_bits(&line);
}

bool hbus_ask(const uint8_t *octets, unsigned n)
{
    const unsigned before = hbus.answers;
    hbus_say(octets, n);
    for (unsigned i = 0; i < PATIENCE && (hbus.answers == before || hal_8273_chip.rts); i++)
        cell();
    hbus_run(IDLE_AFTER);
    return hbus.answers == before + 1;
}
