#include "dp_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint8_t dp_in[244], dp_out[244];
unsigned dp_outs, dp_reports;
struct seg_party dp_tester;

static uint8_t switches, baud;

/* ---- the station ----------------------------------------------------------------------------------------- */

void ddlm_fault_ind(uint8_t status)
{
    (void)status;
    dp_reports++;
}

static void boot(void)
{
    hal_init();
    dp_station_init(switches, baud);
    hal_irq_restore(HAL_IRQ_ON);
}

static void fail(const char *what)
{
    TEST_FAIL_MESSAGE(what);
}

void dp_begin_at(uint8_t station_switches, uint8_t station_baud, uint32_t bit_per_s)
{
    hv_begin();
    hv_on_failure = fail;
    switches = station_switches;
    baud = station_baud;
    hv_set_switches(switches);
    seg_begin(bit_per_s, switches);
    dp_tester = (struct seg_party){.name = "tester"};
    seg_attach(&dp_tester);
    bus_fault(FLT_NONE, 1, 1);
    memset(dp_out, 0xEE, sizeof dp_out);
    memset(dp_in, 0, sizeof dp_in);
    dp_in[0] = 0x1E; /* 30 degrees */
    dp_outs = dp_reports = 0;
    hv_set_boot(boot);
    hv_set_loop(dp_station_poll, NULL);
    hv_power_on();
    hv_run_for(10 * HV_MS);
}

void dp_begin(uint8_t station_switches, uint8_t station_baud)
{
    dp_begin_at(station_switches, station_baud, 19200);
}

void dp_power_cycle(void)
{
    seg_station_off();
    hv_power_off();
    hv_run_for(100 * HV_MS);
    memset(dp_out, 0xEE, sizeof dp_out);
    hv_power_on();
    hv_run_for(10 * HV_MS);
}

/* ---- the tester ------------------------------------------------------------------------------------------ */

struct script {
    uint8_t octet[600], err[600];
    uint16_t idle[600];
    unsigned n;
};

static void parse(const char *hex, struct script *s)
{
    char *end;
    s->n = 0;
    s->idle[0] = 0;
    while (*hex) {
        if (*hex == ' ') {
            hex++;
        } else if (*hex == '_') {
            s->idle[s->n] = (uint16_t)strtoul(hex + 1, &end, 10);
            hex = end;
        } else {
            s->octet[s->n] = (uint8_t)strtoul(hex, &end, 16);
            TEST_ASSERT_EQUAL_PTR_MESSAGE(hex + 2, end, "two digits an octet");
            s->err[s->n] = *end == '!' ? HAL_ERR_PARITY : *end == '~' ? HAL_ERR_FRAMING : 0;
            hex = end + (s->err[s->n] != 0);
            s->idle[++s->n] = 0;
        }
    }
}

/* -> true: the station has answered */
static bool play(const struct script *s, unsigned line)
{
    const unsigned before = seg_said.telegrams;
    const hv_time bit = dp_tester.bit;
    hv_time t = seg_quiet_since() + 33 * bit;
    if (t < hv_now())
        t = hv_now();
    for (unsigned i = 0; i < s->n; i++) {
        t += s->idle[i] * bit;
        seg_send(&dp_tester, t, &s->octet[i], 1, &s->err[i]);
        t += 11 * bit;
    }
    hv_run_until(t);
    while (hv_driver() || (seg_said.telegrams == before && hv_now() < t + (seg_max_t_sdr() + 50) * bit))
        hv_run_for(11 * bit);
    hv_run_for(HV_MS);
    const char *const verdict = seg_verdict();
    UNITY_TEST_ASSERT(verdict == NULL, line, verdict);
    return seg_said.telegrams != before;
}

static const char *to_hex(const uint8_t *octets, unsigned n)
{
    static char text[3 * TG_MAX + 1];
    text[0] = 0;
    for (unsigned i = 0; i < n; i++)
        sprintf(text + 3 * i, i + 1 < n ? "%02X " : "%02X", octets[i]);
    return text;
}

const char *dp_ask(const char *hex, unsigned line)
{
    static struct script s;
    parse(hex, &s);
    return play(&s, line) ? to_hex(seg_said.octets, seg_said.n) : "";
}

unsigned dp_ask_octets(const uint8_t *octets, unsigned n, unsigned line)
{
    static struct script s;
    memset(&s, 0, sizeof s);
    memcpy(s.octet, octets, n);
    s.n = n;
    return play(&s, line) ? seg_said.n : 0;
}

unsigned dp_diag(unsigned line)
{
    struct tg t;
    if (*dp_ask(GET_DIAG, line) == 0 || tg_decode(seg_said.octets, seg_said.n, &t) != TG_GOOD || t.n < 6)
        return 0xFFFF;
    return (unsigned)(t.data[0] << 8 | t.data[1]);
}

void dp_to_data_exch(const char *set_prm, unsigned line)
{
    UNITY_TEST_ASSERT_EQUAL_STRING(ACK, dp_ask(set_prm, line), line, "Set_Prm");
    UNITY_TEST_ASSERT_EQUAL_STRING(ACK, dp_ask(CHK_CFG, line), line, "Chk_Cfg");
    hv_run_for(2 * HV_MS);
    UNITY_TEST_ASSERT_EQUAL_UINT(DDLM_DATA_EXCH, dp_info()->state, line, "state");
}

const struct ddlm_info *dp_info(void)
{
    static struct ddlm_info info;
    ddlm_read_info(&info);
    return &info;
}

unsigned dp_count(unsigned quick, unsigned full)
{
    return getenv("TEST_FULL") ? full : quick;
}
