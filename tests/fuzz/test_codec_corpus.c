/*
 * Replay the corpora of the codec's fuzz harnesses, and deterministic
 * mutations of each file, through the same functions. SEED and RUNS choose the mutations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <string.h>

#define LLVMFuzzerTestOneInput fuzz_map_one_input
#include "fuzz_codec_map.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_packet_one_input
#include "fuzz_codec_packet.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_gray_one_input
#include "fuzz_codec_gray.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_view_one_input
#include "fuzz_codec_view.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_picture_one_input
#include "fuzz_codec_picture.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_image_packet_one_input
#include "fuzz_codec_image_packet.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_gray_history_one_input
#include "fuzz_codec_gray_history.c"
#undef LLVMFuzzerTestOneInput

#include "corpus_replay.h"

#define MUTATIONS 600 /* of every file */

void setUp(void) {}
void tearDown(void) {}

static void test_map_corpus(void)
{
    corpus_replay(fuzz_map_one_input, "corpus_codec_map", MUTATIONS);
}
static void test_packet_corpus(void)
{
    corpus_replay(fuzz_packet_one_input, "corpus_codec_packet", MUTATIONS);
}
static void test_gray_corpus(void)
{
    corpus_replay(fuzz_gray_one_input, "corpus_codec_gray", MUTATIONS);
}
static void test_view_corpus(void)
{
    corpus_replay(fuzz_view_one_input, "corpus_codec_view", MUTATIONS);
}
static void test_picture_corpus(void)
{
    corpus_replay(fuzz_picture_one_input, "corpus_codec_picture", MUTATIONS);
}
static void test_image_packet_corpus(void)
{
    corpus_replay(fuzz_image_packet_one_input, "corpus_codec_image_packet", MUTATIONS);
}
static void test_gray_history_corpus(void)
{
    corpus_replay(fuzz_gray_history_one_input, "corpus_codec_gray_history", MUTATIONS);
}

int main(int argc, char **argv)
{
    printf("replay one mutation of every file: SEED=n RUNS=1 %s\n", argc > 0 ? argv[0] : "");
    UNITY_BEGIN();
    RUN_TEST(test_map_corpus);
    RUN_TEST(test_packet_corpus);
    RUN_TEST(test_gray_corpus);
    RUN_TEST(test_view_corpus);
    RUN_TEST(test_picture_corpus);
    RUN_TEST(test_image_packet_corpus);
    RUN_TEST(test_gray_history_corpus);
    return UNITY_END();
}
