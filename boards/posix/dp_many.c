/* DP-TEST01 as one of many on a segment in virtual time: the shared object behind sim/many.h. */
#include "board.h"
#include "ddlm/ddlm.h"
#include "dp_test01_app.h"
#include "hal_virtual.h"
#include "phy_uart/phy_uart.h"
#include "sim/many.h"

static uint8_t rate;
static uint8_t outputs[4];
static void (*says)(void *of, uint8_t octet, uint64_t start, uint64_t end);
static void *says_of;

/* Inputs are what the outputs were, one higher: the master can tell that they went through this station. */
uint8_t board_input(uint8_t module)
{
    return (uint8_t)(outputs[module + 1] + 1);
}

void board_output(uint8_t module, uint8_t value)
{
    outputs[module] = value;
}

static void boot(void)
{
    hal_init();
    dp_test01_init(hal_switches(), rate);
    hal_irq_restore(HAL_IRQ_ON);
}

/* A main loop of 200 us: an 8-bit part's, not an ideal one's. */
static hv_time loop_time(void)
{
    return 200 * HV_US;
}

static void octet_out(uint8_t octet, hv_time start, hv_time end)
{
    says(says_of, octet, start, end);
}

static void driver(bool on)
{
    (void)on;
}

static void power_on(uint8_t address, uint8_t baud,
                     void (*to)(void *of, uint8_t octet, uint64_t start, uint64_t end), void *of)
{
    static const struct hv_wire wire = {octet_out, driver};
    rate = baud;
    says = to;
    says_of = of;
    hv_begin();
    hv_set_switches(address);
    hv_set_boot(boot);
    hv_set_loop(dp_test01_poll, loop_time);
    hv_set_wire(&wire);
    hv_power_on();
}

static void hears(uint64_t t, uint8_t octet)
{
    hv_inject(t, octet, 0);
}

static void look(uint8_t *state, uint16_t *exchanges, uint16_t *foreign)
{
    struct ddlm_info info;
    struct ddlm_counters ddlm;
    struct fdl_counters fdl;
    ddlm_read_info(&info);
    ddlm_read_counters(&ddlm);
    fdl_read_counters(&fdl);
    *state = info.state;
    *exchanges = ddlm.data_exchange;
    *foreign = fdl.foreign;
}

static uint64_t bit(uint8_t baud)
{
    return hv_bit_of(phy_bit_per_s(baud));
}

static unsigned max_t_sdr(uint8_t baud)
{
    return phy_max_t_sdr(baud);
}

const struct many_station fieldling_many_station = {power_on, hears, hv_run_until, look, bit, max_t_sdr};
