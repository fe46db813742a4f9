/*
 * Replay the corpus of the rectification table's fuzz harness, and deterministic
 * mutations of each file. SEED and RUNS choose the mutations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <stdio.h>

#include "codec_random.h"
#include "fuzz_vision_rectify.c"
#include "unity.h"

#define FILE_LEN_MAX 2048
#define MUTATIONS_PER_FILE 600

void setUp(void) {}
void tearDown(void) {}

/* Bytes in a block of exactly their length, so that a sanitizer sees every overrun. */
static void try_bytes(const uint8_t *bytes, size_t len)
{
    uint8_t *exact = malloc(len > 0 ? len : 1);
    TEST_ASSERT_NOT_NULL(exact);
    memcpy(exact, bytes, len);
    (void)LLVMFuzzerTestOneInput(exact, len);
    free(exact);
}

static size_t mutate(struct codec_random *random, uint8_t *bytes, size_t len)
{
    const unsigned count = 1 + codec_random_below(random, 4);
    for (unsigned i = 0; i < count && len > 0; i++) {
        const size_t at = codec_random_below(random, (uint32_t)len);
        switch (codec_random_below(random, 5)) {
        case 0: bytes[at] = (uint8_t)codec_random_next(random); break;
        case 1: bytes[at] ^= (uint8_t)(1u << codec_random_below(random, 8)); break;
        case 2: len = codec_random_below(random, 4) == 0 ? at : len; break;
        case 3: memset(bytes + at, codec_random_below(random, 2) == 0 ? 0x7f : 0x80, len - at); break;
        default: memmove(bytes + at, bytes + at / 2, len - at); break;
        }
    }
    return len;
}

static void replay_file(const char *path)
{
    uint8_t bytes[FILE_LEN_MAX];
    FILE *file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    const size_t len = fread(bytes, 1, sizeof bytes, file);
    (void)fclose(file);
    struct tsr_rectify_table table;
    TEST_ASSERT_EQUAL_MESSAGE(TSR_OK, tsr_rectify_open(&table, bytes, len), path);
    try_bytes(bytes, len);
    const uint64_t first = codec_setting("SEED", 1);
    const uint64_t end = first + codec_setting("RUNS", MUTATIONS_PER_FILE);
    for (uint64_t seed = first; seed < end; seed++) {
        uint8_t mutated[FILE_LEN_MAX];
        struct codec_random random = codec_random_of_seed(seed);
        memcpy(mutated, bytes, len);
        try_bytes(mutated, mutate(&random, mutated, len));
    }
}

static void test_rectify_corpus(void)
{
    const char *source = getenv("TSR_SOURCE");
    char path[1024];
    unsigned file_count = 0;
    TEST_ASSERT_NOT_NULL_MESSAGE(source, "TSR_SOURCE is not set");
    (void)snprintf(path, sizeof path, "%s/tests/fuzz/corpus_vision_rectify", source);
    DIR *dir = opendir(path);
    TEST_ASSERT_NOT_NULL_MESSAGE(dir, path);
    for (const struct dirent *entry = readdir(dir); entry != NULL; entry = readdir(dir)) {
        if (entry->d_name[0] != '.') {
            (void)snprintf(path, sizeof path, "%s/tests/fuzz/corpus_vision_rectify/%s", source, entry->d_name);
            replay_file(path);
            file_count++;
        }
    }
    (void)closedir(dir);
    printf("corpus_vision_rectify: %u files\n", file_count);
    TEST_ASSERT_GREATER_THAN(0, file_count);
}

int main(int argc, char **argv)
{
    printf("replay one mutation of every file: SEED=n RUNS=1 %s\n", argc > 0 ? argv[0] : "");
    UNITY_BEGIN();
    RUN_TEST(test_rectify_corpus);
    return UNITY_END();
}
