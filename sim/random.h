/* A small random source for tests, the same everywhere (xorshift64*, Marsaglia 2003, Vigna 2014). */
#ifndef SIM_RANDOM_H
#define SIM_RANDOM_H

#include <stdint.h>

/* 32 random bits; *state must not be 0. */
static inline uint32_t sim_random(uint64_t *state)
{
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (uint32_t)((*state * 0x2545F4914F6CDD1DULL) >> 32);
}

/* 0..n-1, n >= 1. */
static inline uint32_t sim_below(uint64_t *state, uint32_t n)
{
    return (uint32_t)(((uint64_t)sim_random(state) * n) >> 32);
}

#endif
