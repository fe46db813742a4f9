/*
 * What happens to a map after matching: median, quantisation, similarity.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/vision/median.h"
#include "tsr/vision/quantise.h"
#include "tsr/vision/similarity.h"
#include "unity.h"

#define NONE TSR_DISPARITY_INVALID
#define WIDTH 32
#define HEIGHT 18
#define PIXELS (WIDTH * HEIGHT)

static uint16_t map[PIXELS];
static uint16_t other[PIXELS];
static _Alignas(2) uint8_t scratch[TSR_MEDIAN_SCRATCH_LEN(WIDTH) + 2];
static struct tsr_median median;
static struct tsr_similarity similarity;
static struct tsr_similarity_result result;
static const struct tsr_similarity_config config = {.width = WIDTH, .height = HEIGHT};
static const struct tsr_similarity_config by_eights = {
    .width = WIDTH, .height = HEIGHT, .block_log2 = 3, .threshold_q8 = 512};

void setUp(void)
{
    memset(map, 0, sizeof map);
    memset(other, 0, sizeof other);
    memset(scratch, 0xa5, sizeof scratch);
    memset(&median, 0xa5, sizeof median);
    memset(&similarity, 0xa5, sizeof similarity);
    memset(&result, 0xa5, sizeof result);
}
void tearDown(void) {}

static void expect_bytes(const void *object, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        TEST_ASSERT_EQUAL_HEX8(0xa5, ((const uint8_t *)object)[i]);
    }
}

static enum tsr_status start_median(uint16_t width, uint16_t height, uint16_t *at, size_t cap, uint8_t *room)
{
    return tsr_median_start(&median, width, height, at, cap, room, TSR_MEDIAN_SCRATCH_LEN(WIDTH));
}

static void test_median_start_refuses_what_it_must(void)
{
    uint16_t *odd = (uint16_t *)(void *)((uint8_t *)map + 1);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_median_start(NULL, WIDTH, HEIGHT, map, PIXELS, scratch, sizeof scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(WIDTH, HEIGHT, NULL, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(WIDTH, HEIGHT, map, PIXELS, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(WIDTH, HEIGHT, odd, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(WIDTH, HEIGHT, map, PIXELS, scratch + 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(0, HEIGHT, map, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(WIDTH, 0, map, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(TSR_IMAGE_WIDTH_MAX + 1, 1, map, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start_median(1, TSR_IMAGE_HEIGHT_MAX + 1, map, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start_median(WIDTH, HEIGHT, map, PIXELS - 1, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_median_start(&median, WIDTH, HEIGHT, map, PIXELS, scratch,
                                                      TSR_MEDIAN_SCRATCH_LEN(WIDTH) - 1));
    expect_bytes(&median, sizeof median);
    expect_bytes(scratch, sizeof scratch);
    TEST_ASSERT_EQUAL(TSR_OK, start_median(WIDTH, HEIGHT, map, PIXELS, scratch));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_median_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_median_run(&median, 0));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_median_run(&median, HEIGHT - 1));
    TEST_ASSERT_EQUAL(HEIGHT - 1, tsr_median_rows_done(&median));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_median_run(&median, 5));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_median_run(&median, 5));
    TEST_ASSERT_EQUAL(HEIGHT, tsr_median_rows_done(&median));
}

static void run_median(uint16_t *values, uint16_t width, uint16_t height)
{
    TEST_ASSERT_EQUAL(TSR_OK, start_median(width, height, values, (size_t)width * height, scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_median_run(&median, UINT16_MAX));
}

static void test_median_by_hand(void)
{
    uint16_t full[] = {9, 1, 8, 2, 7, 3, 6, 4, 5};
    run_median(full, 3, 3);
    TEST_ASSERT_EQUAL(5, full[4]);
    TEST_ASSERT_EQUAL(2, full[0]); /* 1 2 7 9: the lower of the middle two */
    uint16_t four[] = {40, NONE, 10, NONE, NONE, NONE, 30, NONE, 20};
    run_median(four, 3, 3);
    TEST_ASSERT_EQUAL(20, four[4]);
    TEST_ASSERT_EQUAL_HEX16(NONE, four[0]);
    uint16_t three[] = {40, NONE, 10, NONE, 5, NONE, NONE, NONE, NONE};
    run_median(three, 3, 3);
    TEST_ASSERT_EQUAL_HEX16(NONE, three[4]);
    uint16_t single[] = {3};
    run_median(single, 1, 1);
    TEST_ASSERT_EQUAL_HEX16(NONE, single[0]);
}

static void test_quantise_refuses_what_it_must(void)
{
    map[0] = 33;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_quantise(NULL, 1, 1, 32));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_quantise(map, 1, 5, 32));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_quantise(map, 1, 1, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_quantise(map, 1, 1, TSR_DISPARITY_COUNT_MAX + 1));
    TEST_ASSERT_EQUAL(33, map[0]);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_quantise(map, 0, 4, 32));
    TEST_ASSERT_EQUAL(33, map[0]);
}

static void test_quantise_rounds_to_nearest_and_stays_in_range(void)
{
    uint16_t values[] = {0, 7, 8, 23, 24, 495, 496, 497, 65534, NONE};
    const uint16_t wanted[] = {0, 0, 16, 16, 32, 496, 496, 496, 496, NONE};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_quantise(values, 10, 4, 32));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(wanted, values, 10);
    uint16_t fine[] = {1, 2, 3, 496, 497};
    const uint16_t kept[] = {1, 2, 3, 496, 496};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_quantise(fine, 5, 0, 32));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(kept, fine, 5);
}

static void expect_bad(struct tsr_similarity_config bad, const char *name)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_check(&bad, &field));
    TEST_ASSERT_EQUAL_STRING(name, field);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_check(&bad, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_start(&similarity, &bad, map, other, PIXELS));
    expect_bytes(&similarity, sizeof similarity);
    TEST_ASSERT_FALSE(tsr_similarity_is_similar(&bad, &result));
}

#define EXPECT_BAD(member, value)                                                                                      \
    do {                                                                                                               \
        struct tsr_similarity_config bad = config;                                                                     \
        bad.member = (value);                                                                                          \
        expect_bad(bad, #member);                                                                                      \
    } while (0)

static void test_similarity_check_names_the_bad_field(void)
{
    const char *field = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_check(NULL, &field));
    TEST_ASSERT_EQUAL_STRING("config", field);
    EXPECT_BAD(width, 15);
    EXPECT_BAD(width, TSR_IMAGE_WIDTH_MAX + 1);
    EXPECT_BAD(height, 15);
    EXPECT_BAD(height, TSR_IMAGE_HEIGHT_MAX + 1);
    EXPECT_BAD(block_log2, 1);
    EXPECT_BAD(block_log2, 5);
    EXPECT_BAD(threshold_q8, 32 * 32 + 1);
}

static void test_similarity_defaults_are_the_documented_ones(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_start(&similarity, &config, map, other, PIXELS));
    TEST_ASSERT_EQUAL(2, similarity.config.block_log2);
    TEST_ASSERT_EQUAL(32, similarity.config.clip_q4);
    TEST_ASSERT_EQUAL(768, similarity.config.threshold_q8);
    TEST_ASSERT_EQUAL(8, similarity.config.min_blocks);
    const struct tsr_similarity_config large = {.width = 640, .height = 480, .clip_q4 = 1};
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_start(&similarity, &large, map, other, 640 * 480));
    TEST_ASSERT_EQUAL(1, similarity.config.threshold_q8);
    TEST_ASSERT_EQUAL(32, similarity.config.min_blocks);
    struct tsr_similarity_config coarse = config;
    coarse.block_log2 = 3;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_start(&similarity, &coarse, map, other, PIXELS));
    TEST_ASSERT_EQUAL(2, similarity.config.min_blocks);
    coarse.block_log2 = 4;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_start(&similarity, &coarse, map, other, PIXELS));
    TEST_ASSERT_EQUAL(1, similarity.config.min_blocks);
}

static void test_similarity_refuses_what_it_must(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_start(NULL, &config, map, other, PIXELS));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_start(&similarity, NULL, map, other, PIXELS));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_start(&similarity, &config, NULL, other, PIXELS));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_start(&similarity, &config, map, NULL, PIXELS));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_similarity_start(&similarity, &config, map, other, PIXELS - 1));
    expect_bytes(&similarity, sizeof similarity);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_start(&similarity, &config, map, other, PIXELS));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_run(NULL, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_run(&similarity, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_get_result(NULL, &result));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_similarity_get_result(&similarity, NULL));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_similarity_run(&similarity, 9));
    TEST_ASSERT_EQUAL(12, tsr_similarity_rows_done(&similarity)); /* whole rows of blocks */
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_similarity_get_result(&similarity, &result));
    expect_bytes(&result, sizeof result);
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_similarity_run(&similarity, 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_run(&similarity, 1));
    TEST_ASSERT_EQUAL(HEIGHT, tsr_similarity_rows_done(&similarity));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_run(&similarity, 1));
    TEST_ASSERT_FALSE(tsr_similarity_is_similar(NULL, &result));
    TEST_ASSERT_FALSE(tsr_similarity_is_similar(&config, NULL));
}

static bool compare(const struct tsr_similarity_config *chosen)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_start(&similarity, chosen, map, other, PIXELS));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_run(&similarity, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_similarity_get_result(&similarity, &result));
    return tsr_similarity_is_similar(chosen, &result);
}

static void fill_block(uint16_t *at, int block_x, int block_y, uint16_t value)
{
    for (int y = 0; y < 8; y++) {
        for (int x = 0; x < 8; x++) {
            at[(8 * block_y + y) * WIDTH + 8 * block_x + x] = value;
        }
    }
}

static void test_similarity_counts_blocks(void)
{
    TEST_ASSERT_TRUE(compare(&by_eights));
    TEST_ASSERT_EQUAL(PIXELS, result.both_count);
    TEST_ASSERT_EQUAL(0, result.one_count);
    TEST_ASSERT_EQUAL(0, tsr_similarity_mse_q8(&result));
    TEST_ASSERT_EQUAL(8, result.blocks); /* the last two rows fill none */
    fill_block(map, 1, 0, 32);
    TEST_ASSERT_TRUE(compare(&by_eights)); /* one is fewer than two */
    TEST_ASSERT_EQUAL(1, result.different_blocks);
    TEST_ASSERT_EQUAL((64 * 1024 + PIXELS / 2) / PIXELS, tsr_similarity_mse_q8(&result));
    fill_block(map, 3, 1, 3000);
    TEST_ASSERT_FALSE(compare(&by_eights));
    TEST_ASSERT_EQUAL(2, result.different_blocks);
}

static void test_similarity_threshold_is_exact(void)
{
    struct tsr_similarity_config chosen = by_eights;
    chosen.threshold_q8 = 100;
    chosen.min_blocks = 1;
    fill_block(map, 0, 0, 10);
    TEST_ASSERT_TRUE(compare(&chosen)); /* 100 is not above 100 */
    map[0] = 11;
    TEST_ASSERT_FALSE(compare(&chosen));
}

static void test_similarity_needs_half_of_a_block(void)
{
    struct tsr_similarity_config chosen = by_eights;
    chosen.min_blocks = 1;
    fill_block(map, 0, 0, 500);
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 8; x++) {
            other[y * WIDTH + x] = NONE;
        }
    }
    TEST_ASSERT_FALSE(compare(&chosen));
    TEST_ASSERT_EQUAL(8, result.blocks);
    TEST_ASSERT_EQUAL(32, result.one_count);
    map[7 * WIDTH + 7] = NONE;
    TEST_ASSERT_TRUE(compare(&chosen));
    TEST_ASSERT_EQUAL(7, result.blocks);
    memset(map, 0xff, sizeof map);
    TEST_ASSERT_TRUE(compare(&chosen));
    TEST_ASSERT_EQUAL(0, result.both_count);
    TEST_ASSERT_EQUAL(0, tsr_similarity_mse_q8(&result));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_median_start_refuses_what_it_must);
    RUN_TEST(test_median_by_hand);
    RUN_TEST(test_quantise_refuses_what_it_must);
    RUN_TEST(test_quantise_rounds_to_nearest_and_stays_in_range);
    RUN_TEST(test_similarity_check_names_the_bad_field);
    RUN_TEST(test_similarity_defaults_are_the_documented_ones);
    RUN_TEST(test_similarity_refuses_what_it_must);
    RUN_TEST(test_similarity_counts_blocks);
    RUN_TEST(test_similarity_threshold_is_exact);
    RUN_TEST(test_similarity_needs_half_of_a_block);
    return UNITY_END();
}
