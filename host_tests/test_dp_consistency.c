/* Nobody sees half an old and half a new telegram: outputs, inputs, diagnosis (ddlm.h, promises 1 and 3).
 *
 * The main loop is interrupted anywhere. The stack is compiled with the compiler's hooks for a race detector, which are
 * called before every access to memory; here, at some of them chosen at random, the time of up to two characters passes
 * and interrupts happen right there.
 * All octets of one piece of data are equal, so any mixture shows. */
#include "dp_fixture.h"

#include <string.h>

#define LEN 32u /* cfg F3 7B: 32 octets each way */

static struct bus_master m1, m2;
static struct dp_slave slave;

static struct {
    bool armed;
    uint64_t dice;
    unsigned one_in, times;
} preempt;

static void interrupt_perhaps(void)
{
    if (!preempt.armed || !hv_interruptible_now() || sim_below(&preempt.dice, preempt.one_in) != 0)
        return;
    preempt.armed = false;
    preempt.times++;
    hv_spend(1 + sim_below(&preempt.dice, (uint32_t)(22 * hv_bit())));
    preempt.armed = true;
}

/* What the compiler calls before an access (and at entry and exit of functions, where nothing is done). */
#define BEFORE(name)                                                                                         \
    void __tsan_##name(void *at);                                                                            \
    void __tsan_##name(void *at)                                                                             \
    {                                                                                                        \
        (void)at;                                                                                            \
        interrupt_perhaps();                                                                                 \
    }
#define BEFORE_RANGE(name)                                                                                   \
    void __tsan_##name(void *at, unsigned long size);                                                        \
    void __tsan_##name(void *at, unsigned long size)                                                         \
    {                                                                                                        \
        (void)at;                                                                                            \
        (void)size;                                                                                          \
        interrupt_perhaps();                                                                                 \
    }
#define NOTHING(name, parameter)                                                                             \
    void __tsan_##name(parameter);                                                                           \
    void __tsan_##name(parameter)                                                                            \
    {                                                                                                        \
    }
BEFORE(read1)
BEFORE(read2)
BEFORE(read4)
BEFORE(read8)
BEFORE(write1)
BEFORE(write2)
BEFORE(write4)
BEFORE(write8)
BEFORE(read16)
BEFORE(write16)
BEFORE(unaligned_read2)
BEFORE(unaligned_read4)
BEFORE(unaligned_read8)
BEFORE(unaligned_write2)
BEFORE(unaligned_write4)
BEFORE(unaligned_write8)
BEFORE_RANGE(read_range)
BEFORE_RANGE(write_range)
NOTHING(init, void)
NOTHING(func_exit, void)

void __tsan_func_entry(void *from);
void __tsan_func_entry(void *from)
{
    (void)from;
}

static bool uniform(const uint8_t *octets, unsigned n)
{
    for (unsigned i = 1; i < n; i++)
        if (octets[i] != octets[0])
            return false;
    return true;
}

static unsigned mixed_outputs, mixed_inputs, mixed_diag, news;
static uint8_t number;

static void set_outputs(struct dp_master *m, struct dp_slave *s)
{
    (void)m;
    memset(s->outputs, ++number, LEN);
}

static void check_inputs(struct dp_master *m, struct dp_slave *s)
{
    (void)m;
    mixed_inputs += !uniform(s->inputs, LEN);
    news += s->diag_n > 8;
    mixed_diag += s->diag_n > 8 && !uniform(s->diag + 7, s->diag_n - 7u);
}

/* The application: new inputs each pass, a new diagnosis in some. */
static void loop(void)
{
    uint8_t block[60];
    memset(dp_in, dp_in[0] + 1, LEN);
    preempt.armed = true;
    dp_station_poll();
    if (sim_below(&preempt.dice, 30) == 0) {
        const uint8_t n = (uint8_t)(3 + sim_below(&preempt.dice, 57));
        memset(block, (int)sim_below(&preempt.dice, 256), sizeof block);
        block[0] = n; /* one device related block */
        ddlm_diag(block, n, 0);
    }
    preempt.armed = false;
    mixed_outputs += !uniform(dp_out, LEN);
}

static hv_time any_time(void)
{
    return sim_below(&preempt.dice, 2 * HV_MS);
}

void setUp(void)
{
    static const uint8_t cfg[] = {0xF3, 0x7B};
    preempt.armed = false;
    preempt.dice = 1;
    preempt.one_in = 300;
    preempt.times = 0;
    mixed_outputs = mixed_inputs = mixed_diag = news = 0;
    dp_adapts = false;
    dp_begin_at(8, PHY_BAUD_500K, 500000);
    memset(dp_out, 0, sizeof dp_out);
    memset(dp_in, 0, sizeof dp_in);
    hv_set_loop(loop, any_time);
    slave = (struct dp_slave){.address = 8,
                              .ident = 0x00AA,
                              .station_status = 0xB8,
                              .wd1 = 10,
                              .wd2 = 20,
                              .min_t_sdr = 11,
                              .group = 1,
                              .cfg_n = 2,
                              .out_n = LEN,
                              .in_n = LEN};
    memcpy(slave.cfg, cfg, sizeof cfg);
    m1.dp = (struct dp_master){
        .slaves = &slave, .slaves_n = 1, .before = set_outputs, .after = check_inputs, .ring = &m2.dp};
    m1.dp.ini.address = 2;
    m1.dp.ini.retries = 10;
    m2.dp = (struct dp_master){.ring = &m1.dp};
    m2.dp.ini.address = 3;
    m2.dp.ini.retries = 10;
    bus_attach(&m2);
    bus_attach(&m1);
    m2.dp.has_token = false;
}

void tearDown(void)
{
}

static void look_at(void (*question)(struct tg *t, uint8_t da), unsigned skip)
{
    static struct dp_job job;
    question(&job.request, 8);
    TEST_ASSERT_TRUE(bus_ask(&m2, &job));
    if (job.answer.n > skip + 1)
        TEST_ASSERT_TRUE_MESSAGE(uniform(job.answer.data + skip, job.answer.n - skip),
                                 "class 2 saw a mixture");
}

static void run(unsigned exchanges)
{
    static const uint8_t commands[] = {0x20, 0x08, 0x10, 0x04, 0x28, 0x14, 0x02, 0x00};
    static struct dp_job job;
    while (slave.exchanges < exchanges) {
        look_at(dpq_rd_inp, 0);
        look_at(dpq_rd_outp, 0);
        look_at(dpq_diag, 7);
        dpq_global_control(&job.request, 127, commands[sim_below(&preempt.dice, sizeof commands)], 0);
        bus_ask(&m1, &job);
    }
    const char *const verdict = seg_verdict();
    TEST_ASSERT_NULL_MESSAGE(verdict, verdict);
    TEST_ASSERT_EQUAL_UINT(0, mixed_outputs);
    TEST_ASSERT_EQUAL_UINT(0, mixed_inputs);
    TEST_ASSERT_EQUAL_UINT(0, mixed_diag);
    TEST_ASSERT_EQUAL_UINT(0, slave.wrong);
    TEST_ASSERT_EQUAL_UINT(0, slave.refusals);
    TEST_ASSERT_EQUAL_UINT(1, slave.starts);
    TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(exchanges, preempt.times,
                                          "main was interrupted more than once an exchange");
    TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(0, news, "diagnosis was seen");
}

static void nothing_is_half_old_half_new_with_the_main_loop_interrupted_anywhere(void)
{
    run(dp_count(5000, 50000));
}

static void nor_when_it_is_interrupted_nearly_everywhere(void)
{
    preempt.one_in = 20;
    run(dp_count(2000, 20000));
}

static void nor_when_requests_and_answers_get_lost(void)
{
    bus_fault(FLT_LOST_ANSWER, 5, 7);
    run(dp_count(2000, 20000));
    bus_fault(FLT_LOST_REQUEST, 5, 8);
    run(dp_count(4000, 40000));
}

/* A reset in the middle of anything: the station comes back. */
static void a_restart_in_the_middle_of_anything_leads_back_to_data_exchange(void)
{
    for (unsigned i = 0; i < dp_count(30, 300); i++) {
        hv_run_for(sim_below(&preempt.dice, 20 * HV_MS));
        const unsigned starts = slave.starts;
        dp_power_cycle();
        for (unsigned k = 0; k < 500 && slave.starts == starts; k++)
            hv_run_for(10 * HV_MS);
        TEST_ASSERT_EQUAL_UINT(starts + 1, slave.starts);
    }
    TEST_ASSERT_EQUAL_UINT(0, mixed_outputs);
    TEST_ASSERT_EQUAL_UINT(0, mixed_inputs);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(nothing_is_half_old_half_new_with_the_main_loop_interrupted_anywhere);
    RUN_TEST(nor_when_it_is_interrupted_nearly_everywhere);
    RUN_TEST(nor_when_requests_and_answers_get_lost);
    RUN_TEST(a_restart_in_the_middle_of_anything_leads_back_to_data_exchange);
    return UNITY_END();
}
