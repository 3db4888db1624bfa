/* What can come over a wire that nobody meant: random frames and noise. Promises, for any input: no write
 * without a whole, valid request to us; no answer but to one; never more than one answer; the next good
 * request is served. */
#include "modbus_fixture.h"
#include "sim/random.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

static uint64_t seed = 0x4D6F64627573ULL;

static unsigned times(unsigned full)
{
    return getenv("TEST_FULL") ? full : full / 100;
}

void setUp(void)
{
}

void tearDown(void)
{
}

/* Everything a write can reach, so that a change without a good request shows. */
static uint32_t contents(void)
{
    static const struct {
        const void *at;
        size_t n;
    } parts[] = {
        {coils_13, sizeof coils_13},       {coils_ac, sizeof coils_ac},     {coils_big, sizeof coils_big},
        {holding_0, sizeof holding_0},     {holding_6b, sizeof holding_6b}, {file_3, sizeof file_3},
        {holding_big, sizeof holding_big}, {file_4, sizeof file_4},         {file_9, sizeof file_9},
        {fx.callback, sizeof fx.callback}, {&fx.callback_bits, 1}};
    uint32_t hash = 2166136261u;
    for (unsigned p = 0; p < sizeof parts / sizeof parts[0]; p++)
        for (size_t i = 0; i < parts[p].n; i++)
            hash = (hash ^ ((const uint8_t *)parts[p].at)[i]) * 16777619u;
    return hash;
}

/* -> body. Random, but often close to a request: a real function code, plausible addresses and counts. */
static unsigned random_body(void)
{
    static const uint8_t codes[] = {1,  2,  3,  4,  5,  6,  7,  8,  11, 12, 15,
                                    16, 17, 20, 21, 22, 23, 24, 43, 65, 110};
    unsigned n = 2 + sim_below(&seed, sim_below(&seed, 4) ? 16 : 252);
    for (unsigned i = 0; i < n; i++)
        body[i] = (uint8_t)sim_random(&seed);
    body[0] = sim_below(&seed, 4) ? 0x11 : (uint8_t)sim_below(&seed, 3);
    if (sim_below(&seed, 8))
        body[1] = codes[sim_below(&seed, sizeof codes)];
    if (n > 5 && sim_below(&seed, 2)) {
        body[2] = 0;
        body[4] = 0;
        body[5] = (uint8_t)sim_below(&seed, 12);
    }
    if (n > 7 && sim_below(&seed, 2))
        body[6] = (uint8_t)(n - 7);
    if (sim_below(&seed, 3) == 0)
        body[2] = (uint8_t)(n - 3); /* byte count of files */
    return n;
}

static bool is_write(uint8_t code)
{
    return code == 5 || code == 6 || code == 15 || code == 16 || code == 21 || code == 22 || code == 23 ||
           code == 65;
}

static void one_frame(void)
{
    const unsigned n = random_body();
    const bool bad = sim_below(&seed, 4) == 0;
    const uint32_t before = contents();
    const unsigned writes = fx.writes;
    const bool listening = mb_diag.listen_only;
    client.wrong.check_xor = 0;
    if (bad)
        client.wrong.check_xor = (uint16_t)(client.coding.mode == MBC_ASCII ? 1 + sim_below(&seed, 255)
                                                                            : 1 + sim_below(&seed, 65535));
    mbc_send(&client, body, n);
    const unsigned got_n = mbc_wait(&client, got);
    if (bad || body[0] != 0x11 || listening)
        TEST_ASSERT_EQUAL(0, client.heard_n);
    else if (!mb_diag.listen_only)
        TEST_ASSERT_GREATER_OR_EQUAL_MESSAGE(2, got_n, "a good request to us is answered by a good frame");
    if (got_n) {
        TEST_ASSERT_EQUAL_HEX8(0x11, got[0]);
        TEST_ASSERT_EQUAL_HEX8(body[1] & 0x7F, got[1] & 0x7F);
    }
    if (bad || (body[0] != 0x11 && body[0] != 0) || !is_write(body[1]) || listening) {
        TEST_ASSERT_EQUAL(writes, fx.writes);
        TEST_ASSERT_EQUAL_HEX32(before, contents());
    }
    if (got_n && got[1] & 0x80u)
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(before, contents(),
                                        "what is answered by an exception has changed nothing");
    TEST_ASSERT_EQUAL(fx.locks, fx.unlocks);
}

static void restart_if_listening(unsigned i)
{
    static const uint8_t restart[] = {0x11, 8, 0, 1, 0, 0};
    if (!mb_diag.listen_only || i % 8)
        return;
    client.wrong.check_xor = 0;
    mbc_send(&client, restart, sizeof restart);
    mbc_wait(&client, got);
    TEST_ASSERT_FALSE(mb_diag.listen_only);
}

static void random_frames(uint8_t mode, unsigned n)
{
    fixture_begin(0x11, mode);
    client.time_out = mode == MB_ASCII ? 20 : 6;
    for (unsigned i = 0; i < n; i++) {
        restart_if_listening(i);
        one_frame();
        client.coding.delimiter = '\n';
        if (mode == MB_ASCII) { /* function 8/3 may have changed it */
            mb_open();
            mbc_idle(1);
        }
    }
    client.wrong.check_xor = 0;
    restart_if_listening(0);
    ask("11 07", "11 07 00");
    TEST_ASSERT_GREATER_THAN_MESSAGE(n / 200, fx.writes, "some of the random requests must be good writes");
}

static void test_random_frames_rtu(void)
{
    random_frames(MB_RTU, times(600000));
}

static void test_random_frames_ascii(void)
{
    random_frames(MB_ASCII, times(400000));
}

/* Noise in chunks with silences of any length between them; in ASCII mostly of the characters frames are made
 * of. */
static void noise(uint8_t mode, unsigned n)
{
    static const char letters[] = ":0123456789ABCDEF\r\n1103::";
    uint8_t chunk[64];
    fixture_begin(0x11, mode);
    const uint32_t before = contents();
    for (unsigned sent = 0; sent < n;) {
        const unsigned size = 1 + sim_below(&seed, sizeof chunk);
        for (unsigned i = 0; i < size; i++)
            chunk[i] = (uint8_t)(mode == MB_ASCII && sim_below(&seed, 16)
                                     ? (uint8_t)letters[sim_below(&seed, sizeof letters - 1)]
                                     : sim_random(&seed));
        client.wrong.err_at = sim_below(&seed, 64);
        client.wrong.err = sim_below(&seed, 4) ? 0 : (uint8_t)(1u << sim_below(&seed, 4));
        mbc_put(&client, chunk, size);
        mbc_idle(sim_below(&seed, 60));
        sent += size;
        TEST_ASSERT_EQUAL_MESSAGE(before, contents(), "noise has written");
    }
    memset(&client.wrong, 0, sizeof client.wrong);
    mbc_idle(60);
    ask("11 03 00 6B 00 01", "11 03 02 02 2B");
}

static void test_noise_rtu(void)
{
    noise(MB_RTU, times(6000000));
}

static void test_noise_ascii(void)
{
    noise(MB_ASCII, times(4000000));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_frames_rtu);
    RUN_TEST(test_random_frames_ascii);
    RUN_TEST(test_noise_rtu);
    RUN_TEST(test_noise_ascii);
    return UNITY_END();
}
