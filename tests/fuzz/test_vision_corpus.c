/*
 * Replay the corpus of the rectification table's fuzz harness, and deterministic
 * mutations of each file. SEED and RUNS choose the mutations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>

#include "corpus_replay.h"
#include "fuzz_vision_rectify.c"

#define MUTATIONS 600 /* of every file */

void setUp(void) {}
void tearDown(void) {}

static void test_rectify_corpus(void)
{
    corpus_replay(LLVMFuzzerTestOneInput, "corpus_vision_rectify", MUTATIONS);
}

int main(int argc, char **argv)
{
    printf("replay one mutation of every file: SEED=n RUNS=1 %s\n", argc > 0 ? argv[0] : "");
    UNITY_BEGIN();
    RUN_TEST(test_rectify_corpus);
    return UNITY_END();
}
