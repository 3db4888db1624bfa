#include "sim/faults.h"

#include "sim/random.h"

#include <string.h>

#define PARITY  0x01u /* as HAL_ERR_PARITY, HAL_ERR_FRAMING */
#define FRAMING 0x02u

const char *flt_reason(enum flt kind)
{
    static const char *const text[] = {
#define FLT_TEXT(name, reason) #name ": " reason,
        FLT_LIST(FLT_TEXT)
#undef FLT_TEXT
    };
    return text[kind];
}

static unsigned drop(struct flt_char *out, unsigned n, unsigned k)
{
    if (k + 1 < n)
        out[k + 1].idle = 11;
    memmove(&out[k], &out[k + 1], (n - k - 1) * sizeof out[0]);
    return n - 1;
}

static unsigned insert(struct flt_char *out, unsigned n, unsigned k, struct flt_char c)
{
    memmove(&out[k + 1], &out[k], (n - k) * sizeof out[0]);
    out[k] = c;
    return n + 1;
}

int flt_request(enum flt kind, uint64_t *random, const uint8_t *octets, unsigned n,
                struct flt_char out[FLT_CHARS])
{
    const unsigned k = sim_below(random, n);
    const unsigned bit = sim_below(random, 8);
    for (unsigned i = 0; i < n; i++)
        out[i] = (struct flt_char){0, octets[i], 0};
    switch (kind) {
    case FLT_ONE_BIT:
        out[k].octet ^= (uint8_t)(1u << bit);
        out[k].err = PARITY;
        return (int)n;
    case FLT_TWO_BITS:
        out[k].octet ^= (uint8_t)(1u << bit | 1u << ((bit + 1 + sim_below(random, 7)) & 7));
        return (int)n;
    case FLT_PARITY:
        out[k].err = PARITY;
        return (int)n;
    case FLT_FRAMING:
        out[k].err = FRAMING;
        return (int)n;
    case FLT_LOST_OCTET:
        return (int)drop(out, n, k);
    case FLT_DOUBLED_OCTET:
        return (int)insert(out, n, k, out[k]);
    case FLT_TRUNCATED:
        return (int)k;
    case FLT_STRETCHED:
        out[k ? k : 1].idle = 60;
        return (int)n;
    case FLT_NOISE_BEFORE:
        return (int)insert(out, n, 0, (struct flt_char){0, (uint8_t)sim_random(random), 0});
    case FLT_NOISE_AFTER:
        n = insert(out, n, n, (struct flt_char){0, 0xFF, FRAMING});
        return (int)insert(out, n, n, (struct flt_char){0, 0xFE, 0});
    case FLT_LOST_REQUEST:
        return 0;
    case FLT_BREAK:
        for (unsigned i = 0; i < n; i++)
            out[i] = (struct flt_char){0, 0, FRAMING};
        return (int)n;
    default:
        return -1;
    }
}

unsigned flt_stranger(enum flt kind, uint64_t *random, uint8_t octets[TG_MAX])
{
    /* station 77 answers master 1; master 1 polls station 77; both are none of ours */
    static const uint8_t answer[] = {0x68, 0x05, 0x05, 0x68, 0x01, 0x4D, 0x08, 0x12, 0x34, 0x9C, 0x16};
    static const uint8_t poll[] = {0x68, 0x05, 0x05, 0x68, 0x4D, 0x01, 0x7D, 0x55, 0xAA, 0xCA, 0x16};
    const uint8_t *const from = kind == FLT_FOREIGN ? poll : answer;
    if (kind != FLT_LATE_ANSWER && kind != FLT_FOREIGN && kind != FLT_COLLISION && kind != FLT_OTHER_RATE)
        return 0;
    memcpy(octets, from, sizeof answer);
    return kind == FLT_COLLISION ? 2 + sim_below(random, 6) : (unsigned)sizeof answer;
}

bool flt_hits_answer(enum flt kind)
{
    return kind == FLT_LOST_ANSWER || kind == FLT_ANSWER_BIT || kind == FLT_ANSWER_CUT;
}

bool flt_answer(enum flt kind, unsigned hit, unsigned i, uint8_t *octet, uint8_t *err)
{
    if (kind == FLT_LOST_ANSWER || (kind == FLT_ANSWER_CUT && i >= hit))
        return false;
    if (kind == FLT_ANSWER_BIT && i == hit) {
        *octet ^= 0x10;
        *err |= PARITY;
    }
    return true;
}
