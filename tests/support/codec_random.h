/*
 * Seeds and random numbers of the codec's tests.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_RANDOM_H
#define TSR_TESTS_CODEC_RANDOM_H

#include <stdint.h>
#include <stdlib.h>

struct codec_random {
    uint64_t state;
};

/* xorshift64* (S. Vigna, 2016). */
static inline uint32_t codec_random_next(struct codec_random *random)
{
    random->state ^= random->state >> 12;
    random->state ^= random->state << 25;
    random->state ^= random->state >> 27;
    return (uint32_t)(random->state * 0x2545f4914f6cdd1dull >> 32);
}

/* 0 .. count - 1 */
static inline uint32_t codec_random_below(struct codec_random *random, uint32_t count)
{
    return codec_random_next(random) % count;
}

static inline struct codec_random codec_random_of_seed(uint64_t seed)
{
    struct codec_random random = {seed * 0x9e3779b97f4a7c15ull + 1u};
    codec_random_next(&random);
    return random;
}

/* The number in the environment, or the default. */
static inline uint64_t codec_setting(const char *name, uint64_t otherwise)
{
    const char *text = getenv(name);
    return text != NULL ? strtoull(text, NULL, 0) : otherwise;
}

#endif
