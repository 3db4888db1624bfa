/* One station in virtual time that is fed telegrams, to count instructions under callgrind (bench_dp.sh).
 *
 * usage: bench-dp-N exchange|foreign COUNT
 * exchange: Data_Exchange of this device's lengths, each answered; foreign: the same telegram to another station. */
#include "ddlm/ddlm.h"
#include "hal_virtual.h"
#include "phy_uart/phy_uart.h"
#include "sim/dp_master.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint8_t inputs[DEV_INPUT_MAX], outputs[DEV_OUTPUT_MAX];
static unsigned answered;

static void background(void)
{
    ddlm_poll();
    ddlm_outputs(outputs);
    ddlm_inputs(inputs);
}

static void on_driver(bool on)
{
    answered += on;
}

static void on_octet(uint8_t octet, hv_time start, hv_time end)
{
    (void)octet;
    (void)start;
    (void)end;
}

/* Everything from the first octet in to the last octet out happens in here, in interrupts. */
static void say(struct tg *t)
{
    static uint8_t fcb = TG_FCB;
    uint8_t octets[TG_MAX];
    t->sa = 2;
    t->fc = (uint8_t)(TG_REQUEST | TG_FCV | fcb | (t->fc & 0x0F));
    fcb ^= TG_FCB;
    const unsigned n = tg_encode(t, octets);
    hv_run_for(33 * hv_bit());
    for (unsigned i = 0; i < n; i++) {
        hv_run_for(11 * hv_bit());
        hv_receive(octets[i], 0);
    }
    hv_run_for((11 + TG_MAX * 11) * hv_bit());
}

static void bring_up(void)
{
    static const uint8_t cfg[] = {DEV_MODULES(DEV_IDENTIFIERS)};
    static const struct hv_wire wire = {on_octet, on_driver};
    struct dp_slave slave = {.address = 8, .ident = DEV_IDENT, .station_status = 0x80, .cfg_n = sizeof cfg};
    struct tg t;
    memcpy(slave.cfg, cfg, sizeof cfg);
    hv_begin();
    hv_set_wire(&wire);
    hal_init();
    ddlm_slave_init(8, PHY_BAUD_500K);
    hal_irq_restore(HAL_IRQ_ON);
    hv_set_loop(background, NULL);
    dpq_set_prm(&t, &slave);
    say(&t);
    dpq_chk_cfg(&t, &slave);
    say(&t);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: %s exchange|foreign COUNT\n", argv[0]);
        return 2;
    }
    const bool foreign = strcmp(argv[1], "foreign") == 0;
    const unsigned count = (unsigned)strtoul(argv[2], NULL, 10);
    bring_up();
    answered = 0;
    for (unsigned i = 0; i < count; i++) {
        struct tg t;
        memset(outputs, (int)i, sizeof outputs);
        dpq_sap(&t, foreign ? 9 : 8, TG_NO_SAP, outputs, DEV_OUTPUT_LEN);
        t.ssap = TG_NO_SAP;
        say(&t);
    }
    return answered == (foreign ? 0 : count) ? 0 : 1;
}
