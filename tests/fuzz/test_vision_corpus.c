/*
 * Replay the corpora of vision's fuzz harnesses, and deterministic mutations of
 * each file, through the same functions. SEED and RUNS choose the mutations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>

#define LLVMFuzzerTestOneInput fuzz_rectify_one_input
#include "fuzz_vision_rectify.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_match_one_input
#include "fuzz_vision_match.c"
#undef LLVMFuzzerTestOneInput

#include "corpus_replay.h"

#define RECTIFY_MUTATIONS 600 /* of every file */
#define MATCH_MUTATIONS 100   /* of which one matches up to seven times */

void setUp(void) {}
void tearDown(void) {}

static void test_rectify_corpus(void)
{
    corpus_replay(fuzz_rectify_one_input, "corpus_vision_rectify", RECTIFY_MUTATIONS);
}
static void test_match_corpus(void)
{
    corpus_replay(fuzz_match_one_input, "corpus_vision_match", MATCH_MUTATIONS);
}

int main(int argc, char **argv)
{
    printf("replay one mutation of every file: SEED=n RUNS=1 %s\n", argc > 0 ? argv[0] : "");
    UNITY_BEGIN();
    RUN_TEST(test_rectify_corpus);
    RUN_TEST(test_match_corpus);
    return UNITY_END();
}
