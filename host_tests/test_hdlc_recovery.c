/* One connection from SNRM to the last control, and every fault at every frame of it: each control is carried out
 * exactly once, in order, and the primary knows it (issue: lost command, lost answer, duplicate at every point).
 * Then what only a primary can do: a module that is switched off and on, busy modules, the document's mode. */
#include "remote_board_fake.h"
#include "remote_module.h"
#include "hdlc/hdlc_8273.h"
#include "hdlc/hdlc_nrm.h"
#include "sim/hdlc_master.h"
#include "sim/random.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CONTROLS 12u /* N(S) goes round */

static uint8_t type;
static unsigned done, refused, not_sent, unknown;
static uint16_t seen[64]; /* outputs of the board after each answer */
static char last_trouble[64];

static void note(struct hp *p, struct hp_module *m, const struct hp_request *r, enum hp_outcome outcome,
                 const uint8_t *answer, unsigned n)
{
    (void)p, (void)m, (void)answer, (void)n;
    if (r->id == 0)
        return;
    if (outcome == HP_DONE)
        seen[done++ % 64] = board.digital_out;
    refused += outcome == HP_REFUSED;
    not_sent += outcome == HP_NOT_SENT;
    unknown += outcome == HP_UNKNOWN;
}

static void trouble(struct hp *p, struct hp_module *m, const char *what)
{
    (void)p, (void)m;
    snprintf(last_trouble, sizeof last_trouble, "%s", what);
}

static void init(void)
{
    rm_init(type, 5, 0);
}

static struct hp_module *start(uint8_t as, bool document, uint32_t scan_ms, const struct hm_plan *plan, unsigned plans)
{
    const struct hp_module module = {.name = "m",
                                     .address = 5,
                                     .type = (enum hp_type)as,
                                     .document = document,
                                     .scan_ms = scan_ms,
                                     .channels = 0xFFFF};
    type = as;
    done = refused = not_sent = unknown = 0;
    last_trouble[0] = 0;
    hbus_begin();
    board_fake_begin();
    hbus_station(init, rm_poll);
    hbus_run(20);
    hm_begin(plan, plans);
    hm_primary.done = note;
    hm_primary.trouble = trouble;
    return hp_add(&hm_primary, &module);
}

void setUp(void)
{
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL(0, hbus.collisions + hbus.stuck);
}

static void control(uint8_t channel, bool on)
{
    const uint8_t info[] = {0x02, channel, on ? 0x31 : 0x30};
    TEST_ASSERT_NOT_EQUAL(0, hp_ask(&hm_primary, 0, info, sizeof info));
}

/* Channel k on, k = 0..11: after control k the outputs are 2^(k+1) - 1, if each was done once and in order. */
static void all_controls(void)
{
    for (uint8_t k = 0; k < CONTROLS; k++)
        control(k, true);
}

static void check_all_controls(const char *what)
{
    TEST_ASSERT_TRUE_MESSAGE(hm_run_until_idle(60000), what);
    TEST_ASSERT_EQUAL_MESSAGE(CONTROLS, done, what);
    TEST_ASSERT_EQUAL_MESSAGE(CONTROLS, rm_counters.executed, what);
    for (unsigned k = 0; k < CONTROLS; k++)
        TEST_ASSERT_EQUAL_HEX16_MESSAGE((2u << k) - 1u, seen[k], what);
}

static unsigned frames_of_a_good_connection(void)
{
    start(RM_DO, false, 0, NULL, 0);
    all_controls();
    check_all_controls("good line");
    return hm_frames;
}

static void test_a_good_connection_has_no_frame_too_many(void)
{
    TEST_ASSERT_EQUAL(2 + 2 * CONTROLS, frames_of_a_good_connection()); /* SNRM UA, then I and I */
}

static void test_every_single_fault_at_every_frame(void)
{
    const unsigned frames = frames_of_a_good_connection();
    for (unsigned kind = HM_LOST; kind < HM_KINDS; kind++) {
        for (unsigned k = 0; k < frames; k++) {
            const struct hm_plan plan = {k, (enum hm_fault)kind};
            char what[100];
            snprintf(what, sizeof what, "frame %u: %s", k, hm_reason(plan.kind));
            start(RM_DO, false, 0, &plan, 1);
            all_controls();
            check_all_controls(what);
        }
    }
}

static void test_every_pair_of_lost_frames(void)
{
    const unsigned frames = frames_of_a_good_connection();
    for (unsigned a = 0; a < frames; a++) {
        for (unsigned b = a + 1; b < frames + 2; b++) {
            const struct hm_plan plan[] = {{a, HM_LOST}, {b, HM_LOST}};
            char what[100];
            snprintf(what, sizeof what, "frames %u and %u lost", a, b);
            start(RM_DO, false, 0, plan, 2);
            all_controls();
            check_all_controls(what);
        }
    }
}

/* A bad line for a long time: 15 frames of 100 meet a fault. Connections may be given up then; every control is
 * carried out once, or never, and never is what the primary reports unless it says that it does not know. */
static void test_random_faults_for_long(void)
{
    static struct hm_plan plan[20000];
    const unsigned rounds = getenv("TEST_FULL") ? 4000 : 300;
    uint64_t random = 11;
    unsigned n = 0, asked = 0;
    for (unsigned k = 0; n < 20000; k++)
        if (sim_below(&random, 100) < 15)
            plan[n++] = (struct hm_plan){k, (enum hm_fault)(1 + sim_below(&random, HM_KINDS - 1))};
    start(RM_DO, false, 0, plan, rounds < 1000 ? 500 : 5000);
    for (unsigned k = 0; k < rounds; k++) {
        control((uint8_t)sim_below(&random, 16), sim_random(&random) & 1u);
        asked++;
        TEST_ASSERT_TRUE(hm_run_until_idle(60000));
    }
    TEST_ASSERT_EQUAL(asked, done + not_sent + unknown);
    TEST_ASSERT_TRUE(rm_counters.executed >= done);
    TEST_ASSERT_TRUE(rm_counters.executed <= done + unknown);
    TEST_ASSERT_TRUE_MESSAGE(done > asked * 9 / 10, "far too many connections lost");
}

static void test_a_module_switched_off_and_on(void)
{
    struct hp_module *m = start(RM_DO, false, 500, NULL, 0);
    control(3, true);
    TEST_ASSERT_TRUE(hm_run_until_idle(2000));
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
    hal_8273_break(true, 0); /* dead: nothing read or written */
    i8273_power_on(&hal_8273_chip);
    control(4, true);
    hm_run(3000);
    TEST_ASSERT_EQUAL(HP_OFFLINE, m->state);
    TEST_ASSERT_EQUAL_STRING("does not answer", last_trouble);
    TEST_ASSERT_EQUAL(1, unknown); /* it was sent; nobody can know */
    control(5, true);
    hm_run(2000);
    TEST_ASSERT_EQUAL(1, not_sent);
    hal_8273_break(false, 0);
    hbus_station(init, rm_poll);
    hm_run(3000);
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
    TEST_ASSERT_EQUAL(0, board.digital_out);
    control(6, true);
    TEST_ASSERT_TRUE(hm_run_until_idle(2000));
    TEST_ASSERT_EQUAL_HEX16(0x0040, board.digital_out);
    TEST_ASSERT_EQUAL(2, done);
}

static void test_a_module_that_restarts_unseen_says_dm(void)
{
    struct hp_module *m = start(RM_DO, false, 300, NULL, 0);
    hm_run(1000);
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
    hbus_station(init, rm_poll); /* power-up between two polls */
    hm_run(1000);
    TEST_ASSERT_EQUAL(1, m->count.dm);
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
    TEST_ASSERT_EQUAL(2, m->count.connects);
}

static void test_frmr_is_answered_by_a_new_connection(void)
{
    struct hp_module *m = start(RM_DO, false, 300, NULL, 0);
    hm_run(1000);
    m->vr = 5; /* the primary has lost count: its N(R) makes no sense to the module */
    hm_run(1000);
    TEST_ASSERT_EQUAL(1, m->count.frmr);
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
    control(1, true);
    TEST_ASSERT_TRUE(hm_run_until_idle(2000));
    TEST_ASSERT_EQUAL(1, done);
}

static void test_rej_makes_the_primary_send_again(void)
{
    struct hp_module *m = start(RM_DO, false, 300, NULL, 0);
    hm_run(1000);
    m->vs = 3; /* N(S) 3, 0 expected: REJ 0, which is no N(R) for 3: the connection starts over */
    control(1, true);
    TEST_ASSERT_TRUE(hm_run_until_idle(3000));
    hm_run(500);
    TEST_ASSERT_EQUAL(1, m->count.rej);
    TEST_ASSERT_EQUAL(2, m->count.connects);
    TEST_ASSERT_EQUAL(1, unknown);
    TEST_ASSERT_EQUAL(0, rm_counters.executed);
}

static void test_a_busy_module_gets_it_later(void)
{
    struct hp_module *m = start(RM_DO, false, 300, NULL, 0);
    hdlc_nrm_busy(true);
    control(1, true);
    hm_run(1000);
    TEST_ASSERT_TRUE(m->count.rnr > 2);
    TEST_ASSERT_EQUAL(0, done);
    hdlc_nrm_busy(false);
    TEST_ASSERT_TRUE(hm_run_until_idle(1000));
    TEST_ASSERT_EQUAL(1, done);
    TEST_ASSERT_EQUAL(1, rm_counters.executed);
}

static void test_scans_fetch_every_channel(void)
{
    struct hp_module *m = start(RM_AI, false, 500, NULL, 0);
    for (uint16_t i = 0; i < 6; i++)
        board.analog_in[i] = (uint16_t)(0x111 * (i + 1));
    hbus_station(init, rm_poll); /* its first sample sees them */
    hm_run(1500);
    TEST_ASSERT_EQUAL_HEX16(0x3F, m->valid);
    for (unsigned i = 0; i < 6; i++)
        TEST_ASSERT_EQUAL_HEX16(0x111 * (i + 1), m->value[i]);
    TEST_ASSERT_EQUAL(0, m->count.timeouts + m->count.strange + m->count.duplicates);
}

static void test_document_mode_scans_and_controls(void)
{
    struct hp_module *m = start(RM_DI, true, 1000, NULL, 0);
    board.digital_in = 0xA5C3;
    hbus_station(init, rm_poll);
    hm_run(2500);
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, m->valid);
    for (unsigned i = 0; i < 16; i++)
        TEST_ASSERT_EQUAL((0xA5C3 >> i) & 1, m->value[i]);
    m = start(RM_DO, true, 1000, NULL, 0);
    control(9, true);
    TEST_ASSERT_TRUE(hm_run_until_idle(1000));
    TEST_ASSERT_EQUAL(1, done);
    TEST_ASSERT_EQUAL_HEX16(0x0200, board.digital_out);
    control(16, true); /* silence */
    TEST_ASSERT_TRUE(hm_run_until_idle(1000));
    TEST_ASSERT_EQUAL(1, unknown);
    TEST_ASSERT_EQUAL(HP_OFFLINE, m->state);
}

static void test_disabled_modules_are_disconnected_and_left_alone(void)
{
    struct hp_module *m = start(RM_DI, false, 200, NULL, 0);
    hm_run(1000);
    TEST_ASSERT_EQUAL(HDLC_NRM, hdlc_nrm_state());
    hp_enable(&hm_primary, 0, false);
    hm_run(1000);
    TEST_ASSERT_EQUAL(HDLC_NDM, hdlc_nrm_state());
    const unsigned frames = hm_frames;
    hm_run(1000);
    TEST_ASSERT_EQUAL(frames, hm_frames);
    hp_enable(&hm_primary, 0, true);
    hm_run(500);
    TEST_ASSERT_EQUAL(HP_ONLINE, m->state);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_good_connection_has_no_frame_too_many);
    RUN_TEST(test_every_single_fault_at_every_frame);
    RUN_TEST(test_every_pair_of_lost_frames);
    RUN_TEST(test_random_faults_for_long);
    RUN_TEST(test_a_module_switched_off_and_on);
    RUN_TEST(test_a_module_that_restarts_unseen_says_dm);
    RUN_TEST(test_frmr_is_answered_by_a_new_connection);
    RUN_TEST(test_rej_makes_the_primary_send_again);
    RUN_TEST(test_a_busy_module_gets_it_later);
    RUN_TEST(test_scans_fetch_every_channel);
    RUN_TEST(test_document_mode_scans_and_controls);
    RUN_TEST(test_disabled_modules_are_disconnected_and_left_alone);
    return UNITY_END();
}
