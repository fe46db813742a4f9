/*
 * Replay a folder of tests/fuzz through a fuzz harness, and deterministic
 * mutations of each of its files. SEED and RUNS choose the mutations. For Unity
 * tests that have defined _POSIX_C_SOURCE.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CORPUS_REPLAY_H
#define TSR_TESTS_CORPUS_REPLAY_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "codec_random.h"
#include "unity.h"

#define CORPUS_FILE_LEN_MAX 4096

/* As libFuzzer's LLVMFuzzerTestOneInput. */
typedef int corpus_harness(const uint8_t *bytes, size_t len);

/* Bytes in a block of exactly their length, so that a sanitizer sees every overrun. */
static void corpus_try(corpus_harness *harness, const uint8_t *bytes, size_t len)
{
    uint8_t *exact = malloc(len > 0 ? len : 1);
    TEST_ASSERT_NOT_NULL(exact);
    memcpy(exact, bytes, len);
    (void)harness(exact, len);
    free(exact);
}

static size_t corpus_mutate(struct codec_random *random, uint8_t *bytes, size_t len)
{
    static const uint8_t extremes[4] = {0x00, 0xff, 0x7f, 0x80};
    const unsigned count = 1 + codec_random_below(random, 4);
    for (unsigned i = 0; i < count && len > 0; i++) {
        const size_t at = codec_random_below(random, (uint32_t)len);
        switch (codec_random_below(random, 5)) {
        case 0: bytes[at] = (uint8_t)codec_random_next(random); break;
        case 1: bytes[at] ^= (uint8_t)(1u << codec_random_below(random, 8)); break;
        case 2: len = codec_random_below(random, 2) == 0 ? at : len; break;
        case 3: memset(bytes + at, extremes[codec_random_below(random, 4)], len - at); break;
        default: memmove(bytes + at, bytes + at / 2, len - at); break;
        }
    }
    return len;
}

static void corpus_replay_file(corpus_harness *harness, const char *path, unsigned mutations)
{
    uint8_t bytes[CORPUS_FILE_LEN_MAX];
    FILE *file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    const size_t len = fread(bytes, 1, sizeof bytes, file);
    (void)fclose(file);
    corpus_try(harness, bytes, len);
    const uint64_t first = codec_setting("SEED", 1);
    const uint64_t end = first + codec_setting("RUNS", mutations);
    for (uint64_t seed = first; seed < end; seed++) {
        uint8_t mutated[CORPUS_FILE_LEN_MAX];
        struct codec_random random = codec_random_of_seed(seed);
        memcpy(mutated, bytes, len);
        corpus_try(harness, mutated, corpus_mutate(&random, mutated, len));
    }
}

/* Every file of the folder below tests/fuzz, of which there must be one, and so many mutations of each. */
static void corpus_replay(corpus_harness *harness, const char *folder, unsigned mutations)
{
    const char *source = getenv("TSR_SOURCE");
    char path[1024];
    unsigned file_count = 0;
    TEST_ASSERT_NOT_NULL_MESSAGE(source, "TSR_SOURCE is not set");
    (void)snprintf(path, sizeof path, "%s/tests/fuzz/%s", source, folder);
    DIR *dir = opendir(path);
    TEST_ASSERT_NOT_NULL_MESSAGE(dir, path);
    for (const struct dirent *entry = readdir(dir); entry != NULL; entry = readdir(dir)) {
        if (entry->d_name[0] != '.') {
            (void)snprintf(path, sizeof path, "%s/tests/fuzz/%s/%s", source, folder, entry->d_name);
            corpus_replay_file(harness, path, mutations);
            file_count++;
        }
    }
    (void)closedir(dir);
    printf("%s: %u files\n", folder, file_count);
    TEST_ASSERT_GREATER_THAN(0, file_count);
}

#endif
