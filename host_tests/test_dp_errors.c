/* HD = 4 and T93: damaged bits and noise. EN 50170-2 part 4, 4.7 promises Hamming distance 4: no error of up to three
 * bits, start, parity and stop bits included, makes another telegram. The bits are turned on the line; the receiver of
 * sim/uart.c loses and finds its start bits as a real one does. */
#include "dp_fixture.h"

#include <stdio.h>
#include <string.h>

void setUp(void)
{
    dp_begin_at(8, PHY_BAUD_12M, 12000000);
}

void tearDown(void)
{
}

#define STATUS    "10 08 02 49 53 16"
#define STATUS_OK "10 02 08 00 0A 16"

static unsigned requests(void)
{
    static struct fdl_counters c;
    fdl_read_counters(&c);
    return c.requests;
}

/* ---- HD = 4 ---------------------------------------------------------------------------------------------- */

static uint8_t good[14 * 11], turned[14 * 11];
static unsigned bits;

static void prepare(const uint8_t *octets, unsigned n)
{
    hv_set_loop(NULL, NULL);
    for (unsigned i = 0; i < n; i++)
        uart_levels(octets[i], good + 11 * i);
    bits = 11 * n;
}

/* The levels in turned[], heard at the right rate, then silence for T_SDR and T_SYN. True: the station took it. */
static bool heard(void)
{
    const struct uart_wave wave = {turned, bits, hv_bit()};
    const hv_time start = hv_now();
    const unsigned before = requests(), said = seg_said.telegrams;
    struct uart_octet o = {.resume = 0};
    while (uart_next(&wave, o.resume, wave.bit, &o)) {
        hv_run_until(start + o.end);
        hv_receive(o.octet, (uint8_t)((o.parity_error ? HAL_ERR_PARITY : 0) |
                                      (o.framing_error ? HAL_ERR_FRAMING : 0)));
    }
    hv_run_until(start + (bits + 11 + 40) * wave.bit);
    return hv_driver() || seg_said.telegrams != said || requests() != before;
}

static void turn(unsigned a, unsigned b, unsigned c)
{
    memcpy(turned, good, bits);
    turned[a] ^= 1;
    if (b != a)
        turned[b] ^= 1;
    if (c != b)
        turned[c] ^= 1;
    if (heard()) {
        char text[60];
        snprintf(text, sizeof text, "bits %u %u %u", a, b, c);
        TEST_FAIL_MESSAGE(text);
    }
}

static void the_good_one_is_taken(void)
{
    memcpy(turned, good, bits);
    TEST_ASSERT_TRUE(heard());
    hv_run_for(400 * hv_bit());
}

static void one_and_two_bits(void)
{
    for (unsigned a = 0; a < bits; a++)
        for (unsigned b = a; b < bits; b++)
            turn(a, b, b);
}

static void three_random_bits(unsigned n, uint64_t random)
{
    while (n) {
        const unsigned a = sim_below(&random, bits), b = sim_below(&random, bits),
                       c = sim_below(&random, bits);
        if (a == b || b == c || a == c)
            continue;
        turn(a, b, c);
        n--;
    }
}

static void HD4_no_error_of_1_2_or_3_bits_in_an_SD1_is_taken(void)
{
    static const uint8_t status[] = {0x10, 0x08, 0x02, 0x49, 0x53, 0x16};
    prepare(status, sizeof status);
    the_good_one_is_taken();
    for (unsigned a = 0; a < bits; a++)
        for (unsigned b = a; b < bits; b++)
            for (unsigned c = b == a ? bits - 1 : b; c < bits; c++)
                turn(a, b, b == a ? b : c);
    the_good_one_is_taken();
}

static void HD4_no_error_of_1_2_or_3_bits_in_an_SD2_is_taken(void)
{
    static const uint8_t dx[] = {0x68, 0x05, 0x05, 0x68, 0x08, 0x02, 0x6D, 0x11, 0x22, 0xAA, 0x16};
    prepare(dx, sizeof dx);
    the_good_one_is_taken();
    one_and_two_bits();
    three_random_bits(dp_count(50000, 1000000), 2);
    the_good_one_is_taken();
}

static void HD4_no_error_of_1_2_or_3_bits_in_an_SD3_is_taken(void)
{
    static const uint8_t cfg[] = {0xA2, 0x88, 0x82, 0x6D, 0x3E, 0x3E, 0, 0, 0, 0, 0, 0, 0xF3, 0x16};
    prepare(cfg, sizeof cfg);
    the_good_one_is_taken();
    one_and_two_bits();
    three_random_bits(dp_count(50000, 1000000), 3);
    hv_set_loop(dp_station_poll, NULL);
    hv_run_for(HV_MS);
    the_good_one_is_taken();
}

/* ---- T93: noise ------------------------------------------------------------------------------------------ */

static uint64_t dice;

static void hear_octet(uint8_t octet, uint8_t err)
{
    hv_run_for(11 * hv_bit());
    hv_receive(octet, err);
}

/* The judge has not seen what went straight into the receiver: what it says about answers to that does not count. */
static void not_judged(void)
{
    seg_station_off();
    (void)seg_verdict();
}

/* Chunks of random length with idle of random length between; now and then a good telegram, which must be answered. */
static void T93_after_any_noise_the_next_good_telegram_is_answered(void)
{
    const unsigned octets = dp_count(200000, 10000000);
    dice = 93;
    for (unsigned done = 0; done < octets;) {
        const unsigned n = 1 + sim_below(&dice, sim_below(&dice, 8) ? 30 : 400);
        const bool dirty = sim_below(&dice, 4) == 0;
        for (unsigned i = 0; i < n; i++)
            hear_octet((uint8_t)sim_random(&dice), dirty && sim_below(&dice, 16) == 0 ? HAL_ERR_PARITY : 0);
        hv_run_for(sim_below(&dice, 60) * hv_bit());
        done += n;
        if (sim_below(&dice, 64) == 0 || done >= octets) {
            hv_run_for(33 * hv_bit());
            not_judged();
            ASK(STATUS, STATUS_OK);
        }
    }
}

/* Noise that knows the language: telegrams of this file with some octets changed and the FCS made right again, so that
 * they reach every layer. Whatever they do to the station's state, it goes on answering. */
static unsigned mutant(uint8_t out[TG_MAX])
{
    static const uint8_t saps[] = {55, 56, 57, 58, 59, 60, 61, 62};
    struct tg t = {.da = sim_below(&dice, 8) ? 8 : 127, .sa = (uint8_t)(sim_below(&dice, 4) + 2)};
    static const uint8_t functions[] = {TG_SRD_H, TG_SRD_H,  TG_SRD_L, TG_SDN_H,
                                        TG_SDA_L, TG_STATUS, TG_IDENT, TG_LSAP};
    t.fc = (uint8_t)(TG_REQUEST | (sim_below(&dice, 4) << 4) | functions[sim_below(&dice, sizeof functions)]);
    t.dsap = t.ssap = TG_NO_SAP;
    if (sim_below(&dice, 3)) {
        t.dsap = sim_below(&dice, 8) ? saps[sim_below(&dice, sizeof saps)] : (int16_t)sim_below(&dice, 256);
        t.ssap = 62;
    }
    t.n = (uint8_t)(sim_below(&dice, 8) ? sim_below(&dice, 14) : sim_below(&dice, 245));
    for (unsigned i = 0; i < t.n; i++)
        t.data[i] = (uint8_t)sim_random(&dice);
    if (t.dsap == 61 && t.n >= 7 && sim_below(&dice, 2)) {
        static const uint8_t prm[] = {0x80, 1, 1, 11, 0x12, 0x34, 1};
        memcpy(t.data, prm, sizeof prm);
        t.n = 7;
    }
    if (t.dsap == 62 && sim_below(&dice, 2)) {
        static const uint8_t cfg[] = {0x10, 0x20, 0x10, 0x20};
        memcpy(t.data, cfg, sizeof cfg);
        t.n = 4;
    }
    return tg_encode(&t, out);
}

static void T93_whatever_is_asked_the_station_goes_on_answering(void)
{
    const unsigned telegrams = dp_count(20000, 500000);
    uint8_t octets[TG_MAX];
    unsigned states = 0;
    dice = 94;
    for (unsigned i = 0; i < telegrams; i++) {
        const unsigned n = mutant(octets);
        for (unsigned k = 0; k < n; k++)
            hear_octet(octets[k], 0);
        hv_run_for(sim_below(&dice, 8) ? HV_US * 200 : 40 * hv_bit());
        states |= 1u << dp_info()->state;
        if (i % 256 == 0) {
            hv_run_for(5 * HV_MS);
            not_judged();
            (void)dp_ask("68 0C 0C 68 88 82 6D 3D 3E 00 01 01 0B 12 34 00 3A 16",
                         __LINE__); /* min_T_SDR 11 again */
            ASK(STATUS, STATUS_OK);
        }
    }
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(0x0E, states, "WAIT_PRM, WAIT_CFG and DATA_EXCH were all visited");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(HD4_no_error_of_1_2_or_3_bits_in_an_SD1_is_taken);
    RUN_TEST(HD4_no_error_of_1_2_or_3_bits_in_an_SD2_is_taken);
    RUN_TEST(HD4_no_error_of_1_2_or_3_bits_in_an_SD3_is_taken);
    RUN_TEST(T93_after_any_noise_the_next_good_telegram_is_answered);
    RUN_TEST(T93_whatever_is_asked_the_station_goes_on_answering);
    return UNITY_END();
}
