#include "ddlm_unit.h"

struct ddlm_info XDATA info;
struct ddlm_counters XDATA counts;
uint8_t XDATA outputs[16];

void station_begin(uint8_t switches)
{
    uint8_t i;

    fake_begin();
    for (i = 0; i < sizeof outputs; i++)
        outputs[i] = 0xEE;
    fake.masked = true;
    TEST_ASSERT_EQUAL(DDLM_OK, ddlm_slave_init(switches, 1));
    fake.masked = false;
}

void to_wait_cfg(void)
{
    ask("68 0C 0C 68 88 82 6D 3D 3E 80 00 00 0B 12 34 00 C3 16");
    STATE(DDLM_WAIT_CFG);
}

void to_data_exch(void)
{
    to_wait_cfg();
    ask("68 09 09 68 88 82 6D 3E 3E 10 20 10 20 53 16");
    inputs("31 01");
    STATE(DDLM_DATA_EXCH);
}

void turn(void)
{
    ddlm_poll();
}

void turn_after(uint16_t ms)
{
    fake.ticks = (uint16_t)(fake.ticks + ms);
    ddlm_poll();
}

void ask(const char *hex)
{
    request(hex);
    turn();
}

static uint8_t XDATA du_octets[250];

void ask_sap(uint8_t da, uint8_t sa, uint8_t sap, const char *du)
{
    uint8_t n = from_hex(du_octets, du);
    uint8_t sum = (uint8_t)(da + sa + sap + 0x80 + 0x80 + 0x6D + 62);
    uint8_t i;

    fake.sent_len = 0;
    fake_silence();
    fake_octet(0x68, 0);
    fake_octet((uint8_t)(n + 5), 0);
    fake_octet((uint8_t)(n + 5), 0);
    fake_octet(0x68, 0);
    fake_octet((uint8_t)(da | 0x80), 0);
    fake_octet((uint8_t)(sa | 0x80), 0);
    fake_octet(0x6D, 0);
    fake_octet(sap, 0);
    fake_octet(62, 0);
    for (i = 0; i < n; i++) {
        fake_octet(du_octets[i], 0);
        sum = (uint8_t)(sum + du_octets[i]);
    }
    fake_octet(sum, 0);
    fake_octet(0x16, 0);
    finish_request();
    turn();
}

void inputs(const char *hex)
{
    static uint8_t XDATA octets[16];

    from_hex(octets, hex);
    ddlm_inputs(octets);
}

void read_diag(void)
{
    ddlm_read_info(&info);
    ask_sap(info.address, 3, 60, "");
}

uint8_t output_len(void)
{
    ddlm_read_info(&info);
    return info.output_len;
}
