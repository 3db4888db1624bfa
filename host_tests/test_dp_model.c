/* The slave against a model of it: random services of three masters in random order, some repeated, and after each the
 * station's answer, state, owner and outputs must be the model's.
 *
 * The model is written from spec A6, A7 and facts 3.6 - 3.11, service by service, without looking at how the stack does
 * it. It has no time: between two telegrams the main loop gets its turn. */
#include "dp_fixture.h"

#include <stdio.h>
#include <string.h>

enum { WAIT_PRM = 1, WAIT_CFG, DATA_EXCH }; /* as enum ddlm_state */
enum { SILENCE = -1, ACKNOWLEDGE = -2 };    /* instead of a function code */

static struct {
    int state;
    uint8_t owner, groups, faults, min_t_sdr;
    bool sync_on, freeze_on, sync, freeze;
    uint8_t out[2], held[2], in[2], frozen[2];
    bool held_some;
} model;

static uint64_t dice;

static unsigned below(unsigned n)
{
    return sim_below(&dice, n);
}

void setUp(void)
{
    dp_begin_at(8, PHY_BAUD_1M5, 1500000);
    memset(&model, 0, sizeof model);
    model.state = WAIT_PRM;
    model.owner = 255;
    model.min_t_sdr = 11;
    model.in[0] = 0x1E;
}

void tearDown(void)
{
}

/* ---- the model: takes the request, fills the answer's data, -> its function code, SILENCE or ACKNOWLEDGE ---- */

static void lose_owner(uint8_t faults)
{
    model.state = WAIT_PRM;
    model.owner = 255;
    model.groups = 0;
    model.faults = faults;
    model.sync_on = model.freeze_on = model.sync = model.freeze = model.held_some = false;
    memset(model.out, 0, sizeof model.out);
}

/* Prm_Fault 40, Not_Supported 10, Cfg_Fault 04 */
static int set_prm(const struct tg *t)
{
    const uint8_t *const p = t->data;
    const bool ident_good = t->n >= 7 && p[4] == 0x12 && p[5] == 0x34;
    const bool t_sdr_good = t->n >= 7 && p[3] >= 11 && p[3] <= 150; /* max_T_SDR at 1.5 Mbit/s */
    if (model.owner != 255 && model.owner != t->sa)
        return ACKNOWLEDGE; /* locked */
    if (t->n < 7) {
        lose_owner(0x40);
    } else if (p[0] & 0x40) {
        lose_owner(ident_good ? 0 : 0x40);
    } else if (!(p[0] & 0x80)) {
        model.min_t_sdr = t_sdr_good ? p[3] : model.min_t_sdr;
    } else if (!ident_good || t->n > 10 || (p[3] && !t_sdr_good) || (t->n > 7 && (p[7] & 0xFE)) ||
               (t->n > 9 && p[9])) {
        lose_owner(0x40);
    } else {
        lose_owner(0);
        model.state = WAIT_CFG;
        model.owner = t->sa;
        model.groups = p[6];
        model.sync_on = p[0] & 0x20;
        model.freeze_on = p[0] & 0x10;
        model.min_t_sdr = p[3] ? p[3] : model.min_t_sdr;
    }
    return ACKNOWLEDGE;
}

static int chk_cfg(const struct tg *t)
{
    const bool good = t->n == 4 && memcmp(t->data, "\x10\x20\x10\x20", 4) == 0;
    if (model.owner != t->sa || model.state == WAIT_PRM)
        return ACKNOWLEDGE;
    if (!good)
        lose_owner(model.faults | 0x04);
    else
        model.state = DATA_EXCH; /* the application gives inputs at once */
    return ACKNOWLEDGE;
}

static int diag(const struct tg *t, uint8_t *data, unsigned *n)
{
    if (t->n)
        return TG_RR;
    const uint8_t octets[] = {
        (uint8_t)(model.faults | (model.state == DATA_EXCH ? 0 : 0x02)),
        (uint8_t)(0x04 | (model.state == WAIT_PRM) | (model.freeze ? 0x10 : 0) | (model.sync ? 0x20 : 0)),
        0,
        model.owner,
        0x12,
        0x34};
    *n = sizeof octets;
    memcpy(data, octets, sizeof octets);
    return TG_DL;
}

static int inputs(uint8_t *data, unsigned *n)
{
    *n = 2;
    memcpy(data, model.freeze ? model.frozen : model.in, 2);
    return TG_DL;
}

static int data_exchange(const struct tg *t, uint8_t *data, unsigned *n)
{
    if (model.state != DATA_EXCH || t->sa != model.owner)
        return TG_RS;
    if (t->n == 0) { /* Fail_Safe */
        memset(model.out, 0, 2);
        model.held_some = false;
    } else if (t->n != 2) {
        lose_owner(model.faults | 0x04);
        return TG_RS;
    } else if (model.sync) {
        memcpy(model.held, t->data, 2);
        model.held_some = true;
    } else {
        memcpy(model.out, t->data, 2);
    }
    return inputs(data, n);
}

static void release(void)
{
    if (model.held_some)
        memcpy(model.out, model.held, 2);
    model.held_some = false;
}

static int global_control(const struct tg *t)
{
    const uint8_t command = t->data[0], select = t->data[1];
    if (model.state != DATA_EXCH || t->sa != model.owner || t->n != 2 || (select && !(select & model.groups)))
        return SILENCE;
    if (command & 0x02) {
        memset(model.out, 0, 2);
        model.held_some = false;
    }
    if (command & 0x10) {
        release();
        model.sync = false;
    } else if ((command & 0x20) && model.sync_on) {
        release();
        model.sync = true;
    } else if (command & 0x20) {
        model.faults |= 0x10;
    }
    if (command & 0x04) {
        model.freeze = false;
    } else if ((command & 0x08) && model.freeze_on) {
        model.freeze = true;
        memcpy(model.frozen, model.in, 2);
    } else if (command & 0x08) {
        model.faults |= 0x10;
    }
    return SILENCE;
}

static int expected(const struct tg *t, uint8_t *data, unsigned *n)
{
    *n = 0;
    if ((t->fc & 0x0F) == TG_SDN_H || (t->fc & 0x0F) == TG_SDN_L)
        return t->dsap == 58 && (t->da == 8 || t->da == 127) ? global_control(t) : SILENCE;
    if (t->da != 8)
        return SILENCE;
    switch (t->dsap) {
    case TG_NO_SAP:
        return data_exchange(t, data, n);
    case 56:
        return model.state != DATA_EXCH ? TG_RS : t->n ? TG_RR : inputs(data, n);
    case 57:
        if (model.state != DATA_EXCH || t->n)
            return model.state != DATA_EXCH ? TG_RS : TG_RR;
        *n = 2;
        memcpy(data, model.out, 2);
        return TG_DL;
    case 59:
        *n = t->n ? 0 : 4;
        memcpy(data, "\x10\x20\x10\x20", 4);
        return t->n ? TG_RR : TG_DL;
    case 60:
        return diag(t, data, n);
    case 61:
        return set_prm(t);
    case 62:
        return chk_cfg(t);
    default:
        return TG_RS;
    }
}

/* ---- random requests, good ones often -------------------------------------------------------------------- */

static void random_set_prm(struct tg *t)
{
    static const uint8_t status[] = {0x80, 0x80, 0xB0, 0xB0, 0xA0, 0x90, 0x00, 0x40, 0xC0};
    static const uint8_t t_sdr[] = {0, 0, 0, 11, 60, 150, 151, 10, 1};
    const uint8_t data[] = {status[below(sizeof status)],
                            1,
                            1,
                            t_sdr[below(sizeof t_sdr)],
                            0x12,
                            (uint8_t)(0x34 + (below(12) == 0)),
                            (uint8_t)(1u << below(8)),
                            (uint8_t)(below(6) == 0 ? 2 : 0),
                            0,
                            (uint8_t)(below(6) == 0),
                            0};
    memcpy(t->data, data, sizeof data);
    t->n = (uint8_t)(below(3) ? 7 : below(12));
}

static void random_request(struct tg *t)
{
    static const int16_t saps[] = {TG_NO_SAP, TG_NO_SAP, TG_NO_SAP, 56, 57, 58, 58, 58,
                                   59,        60,        60,        61, 62, 62, 11};
    static const uint8_t commands[] = {0x00, 0x02, 0x04, 0x08, 0x10, 0x20, 0x28, 0x14, 0x3C};
    memset(t, 0, sizeof *t);
    t->dsap = saps[below(sizeof saps / sizeof saps[0])];
    t->ssap = t->dsap == TG_NO_SAP ? TG_NO_SAP : 62;
    t->sa = (uint8_t)(below(8) ? 2 : 3 + below(2));
    t->da = (uint8_t)(below(30) ? 8 : 9);
    t->fc = (uint8_t)(TG_REQUEST | TG_FCB | (below(2) ? TG_SRD_H : TG_SRD_L)); /* FCV 0: always new */
    if (t->dsap == 61) {
        random_set_prm(t);
    } else if (t->dsap == 62) {
        memcpy(t->data, "\x10\x20\x10\x20", 4);
        t->data[below(4)] ^= below(12) ? 0 : (uint8_t)(1u << below(8));
        t->n = (uint8_t)(below(16) ? 4 : below(7));
    } else if (t->dsap == 58) {
        t->fc = TG_REQUEST | TG_SDN_H;
        t->da = below(2) ? 127 : t->da;
        t->n = (uint8_t)(below(20) ? 2 : below(5));
        t->data[0] = commands[below(sizeof commands)];
        t->data[1] = (uint8_t)(below(2) ? 0 : 1u << below(8));
    } else if (t->dsap == TG_NO_SAP) {
        t->n = (uint8_t)(below(40) ? 2 : below(4));
        t->data[0] = (uint8_t)below(256);
        t->data[1] = (uint8_t)below(256);
    } else {
        t->n = (uint8_t)(below(20) == 0);
    }
}

/* The answer the model wants, as a telegram. */
static unsigned answer_of(const struct tg *t, int function, const uint8_t *data, unsigned n,
                          uint8_t out[TG_MAX])
{
    struct tg a = {
        .sd = 0, .da = t->sa, .sa = 8, .fc = (uint8_t)function, .dsap = TG_NO_SAP, .ssap = TG_NO_SAP};
    if (function == SILENCE)
        return 0;
    if (function == ACKNOWLEDGE)
        a.sd = TG_SC;
    if (n) {
        a.sd =
            TG_SD2; /* eight octets too: the request was no SD3, or the answer's SAPs are among the eight */
        a.dsap = t->ssap;
        a.ssap = t->dsap;
        a.n = (uint8_t)n;
        memcpy(a.data, data, n);
    }
    return tg_encode(&a, out);
}

static unsigned visits[4], repeats;

static void ask_and_compare(const struct tg *t, unsigned step)
{
    uint8_t request[TG_MAX], wanted[TG_MAX], data[8];
    char where[120];
    unsigned n;
    const unsigned len = tg_encode(t, request);
    const int function = expected(t, data, &n);
    const unsigned wanted_n = answer_of(t, function, data, n, wanted);
    snprintf(where, sizeof where, "step %u: FC %02X SAP %d of master %u, %u octets", step, t->fc, t->dsap,
             t->sa, t->n);
    const unsigned got = dp_ask_octets(request, len, __LINE__);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted_n, got, where);
    if (got)
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wanted, seg_said.octets, got, where);
    hv_run_for(HV_MS / 2);
    TEST_ASSERT_EQUAL_INT_MESSAGE(model.state, dp_info()->state, where);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(model.owner, dp_info()->master, where);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(model.groups, dp_info()->groups, where);
    TEST_ASSERT_EQUAL_MESSAGE(model.sync, dp_info()->sync, where);
    TEST_ASSERT_EQUAL_MESSAGE(model.freeze, dp_info()->freeze, where);
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(model.out, dp_out, 2, where);
    seg_set_min_t_sdr(model.min_t_sdr);
    visits[model.state]++;
    if (got && below(10) ==
                   0) { /* the same again under FCV: a retry only of an FCV frame, so ask it that way first */
        struct tg again = *t;
        again.fc = (uint8_t)((t->fc | TG_FCV) & ~TG_FCB);
        const unsigned len2 = tg_encode(&again, request);
        const int function2 = expected(&again, data, &n);
        const unsigned wanted2 = answer_of(&again, function2, data, n, wanted);
        for (unsigned i = 0; i < 3; i++, repeats++) {
            TEST_ASSERT_EQUAL_UINT_MESSAGE(wanted2, dp_ask_octets(request, len2, __LINE__), where);
            TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wanted, seg_said.octets, wanted2, where);
            dp_in[0] = model.in[0] = (uint8_t)(model.in[0] + 1); /* does not show in a repeated answer */
            hv_run_for(HV_MS / 2);
            seg_set_min_t_sdr(model.min_t_sdr);
        }
    }
}

static void the_station_does_what_the_model_does(void)
{
    const unsigned steps = dp_count(20000, 400000);
    struct tg t;
    dice = 2026;
    for (unsigned i = 0; i < steps; i++) {
        if (below(4) == 0) {
            dp_in[1] = model.in[1] = (uint8_t)below(256);
            hv_run_for(HV_MS / 2);
        }
        random_request(&t);
        ask_and_compare(&t, i);
    }
    for (unsigned s = WAIT_PRM; s <= DATA_EXCH; s++)
        TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(steps / 20, visits[s], "a state that is hardly visited");
    TEST_ASSERT_GREATER_THAN_UINT(steps / 20, repeats);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(the_station_does_what_the_model_does);
    return UNITY_END();
}
