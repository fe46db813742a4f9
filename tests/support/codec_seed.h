/*
 * Random checks by seed, for Unity tests: a failure prints the command that replays it. SEED and RUNS choose others.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_SEED_H
#define TSR_TESTS_CODEC_SEED_H

#include <stdio.h>

#include "codec_random.h"
#include "unity.h"

static const char *program; /* main() sets it */
static uint64_t seed;       /* of the check that runs; 0: none */

void tearDown(void)
{
    if (Unity.CurrentTestFailed && seed != 0) {
        printf("failed; replay: SEED=%llu RUNS=1 %s\n", (unsigned long long)seed, program);
    }
    seed = 0;
}

static void check_seeds(unsigned runs, void (*check_seed)(void))
{
    const uint64_t first = codec_setting("SEED", 1);
    const uint64_t end = first + codec_setting("RUNS", runs);
    printf("replay all: SEED=%llu %s\n", (unsigned long long)first, program);
    for (seed = first; seed < end; seed++) {
        check_seed();
    }
    seed = 0;
}

#endif
