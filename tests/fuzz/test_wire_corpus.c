/*
 * Replay the corpora of the wire's fuzz harnesses, and deterministic mutations
 * of each file, through the same functions. SEED and RUNS choose the mutations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <string.h>

#define LLVMFuzzerTestOneInput fuzz_frame_one_input
#include "fuzz_wire_frame.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_fragment_one_input
#include "fuzz_wire_fragment.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_body_one_input
#include "fuzz_wire_body.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_link_one_input
#include "fuzz_wire_link.c"
#undef LLVMFuzzerTestOneInput

#include "corpus_replay.h"

#define MUTATIONS 2000 /* of every file */

void setUp(void) {}
void tearDown(void) {}

static void test_frame_corpus(void)
{
    corpus_replay(fuzz_frame_one_input, "corpus_wire_frame", MUTATIONS);
}
static void test_fragment_corpus(void)
{
    corpus_replay(fuzz_fragment_one_input, "corpus_wire_fragment", MUTATIONS);
}
static void test_body_corpus(void)
{
    corpus_replay(fuzz_body_one_input, "corpus_wire_body", MUTATIONS);
}
static void test_link_corpus(void)
{
    corpus_replay(fuzz_link_one_input, "corpus_wire_link", MUTATIONS);
}

int main(int argc, char **argv)
{
    printf("replay one mutation of every file: SEED=n RUNS=1 %s\n", argc > 0 ? argv[0] : "");
    UNITY_BEGIN();
    RUN_TEST(test_frame_corpus);
    RUN_TEST(test_fragment_corpus);
    RUN_TEST(test_body_corpus);
    RUN_TEST(test_link_corpus);
    return UNITY_END();
}
