/*
 * Rectification: tables that are refused, and views whose pixels can be told
 * without the spline.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>

#include "rectify_tables.h"
#include "unity.h"

#define WIDTH 83 /* no multiple of any step */
#define HEIGHT 61
#define STRIDE 90
#define TABLE_CAP 4096u
#define GUARD 0xa5
#define GUARD_LEN 16u

static const struct table_plan identity = {WIDTH, HEIGHT, WIDTH, HEIGHT, 4, {{0, 0}, {0, 0}}, {64, 64}, 0};

static uint8_t bytes[TABLE_CAP];
static struct tsr_rectify_table table;
static uint8_t source[HEIGHT * STRIDE];
static uint8_t target[HEIGHT * STRIDE + GUARD_LEN];
static uint8_t kept[STRIDE * HEIGHT + GUARD_LEN];

void setUp(void)
{
    uint32_t noise = 7;
    for (size_t i = 0; i < sizeof source; i++) {
        source[i] = (uint8_t)table_noise(&noise, 200);
    }
    memset(target, GUARD, sizeof target);
    memset(kept, GUARD, sizeof kept);
}

void tearDown(void) {}

static size_t open_plan(const struct table_plan *plan)
{
    const size_t len = table_make(plan, bytes);
    TEST_ASSERT_LESS_OR_EQUAL(TABLE_CAP, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_open(&table, bytes, len));
    return len;
}

static struct tsr_gray_view source_view(void)
{
    return (struct tsr_gray_view){source, WIDTH, HEIGHT, STRIDE};
}

static struct tsr_gray target_frame(void)
{
    return (struct tsr_gray){target, WIDTH, HEIGHT, STRIDE};
}

static void rectify_all(enum tsr_rectify_side side)
{
    struct tsr_rectify rectify;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_start(&rectify, &table, side, source_view(), target_frame()));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_run(&rectify, HEIGHT));
    TEST_ASSERT_EQUAL(HEIGHT, tsr_rectify_rows_done(&rectify));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_run(&rectify, 1));
}

static void check_guards(void)
{
    for (size_t y = 0; y < HEIGHT; y++) {
        TEST_ASSERT_EACH_EQUAL_HEX8(GUARD, target + y * STRIDE + WIDTH, STRIDE - WIDTH);
    }
    TEST_ASSERT_EACH_EQUAL_HEX8(GUARD, target + HEIGHT * STRIDE, GUARD_LEN);
}

static uint8_t source_at(int x, int y)
{
    x = x < 0 ? 0 : x >= WIDTH ? WIDTH - 1 : x;
    y = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    return source[y * STRIDE + x];
}

static void test_fields(void)
{
    open_plan(&identity);
    TEST_ASSERT_EQUAL(WIDTH, table.width);
    TEST_ASSERT_EQUAL(HEIGHT, table.source_height);
    TEST_ASSERT_EQUAL(-24, table.d0_q4);
    TEST_ASSERT_EQUAL(240u << 16, table.focal_q16);
    TEST_ASSERT_EQUAL(60u << 16, table.baseline_q16);
    TEST_ASSERT_EQUAL(80 << 16, table.cx_q16);
    TEST_ASSERT_EQUAL(60 << 16, table.cy_q16);
    TEST_ASSERT_EQUAL(0, table.rows_above[0]);
}

static void test_identity_at_every_step(void)
{
    for (uint8_t step_log2 = TSR_RECTIFY_STEP_LOG2_MIN; step_log2 <= TSR_RECTIFY_STEP_LOG2_MAX; step_log2++) {
        struct table_plan plan = identity;
        plan.step_log2 = step_log2;
        open_plan(&plan);
        for (int side = 0; side < 2; side++) {
            memset(target, GUARD, sizeof target);
            rectify_all((enum tsr_rectify_side)side);
            for (int y = 0; y < HEIGHT; y++) {
                TEST_ASSERT_EQUAL_MEMORY(source + y * STRIDE, target + y * STRIDE, WIDTH);
            }
            check_guards();
        }
    }
}

static void test_half_pixel_shift(void)
{
    struct table_plan plan = identity;
    plan.shift_q6[0][0] = 32;
    plan.shift_q6[1][1] = -32;
    open_plan(&plan);
    rectify_all(TSR_RECTIFY_LEFT);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            TEST_ASSERT_EQUAL((source_at(x, y) + source_at(x + 1, y) + 1) / 2, target[y * STRIDE + x]);
        }
    }
    rectify_all(TSR_RECTIFY_RIGHT);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            TEST_ASSERT_EQUAL((source_at(x, y - 1) + source_at(x, y) + 1) / 2, target[y * STRIDE + x]);
        }
    }
}

static void test_borders_are_replicated(void)
{
    struct table_plan plan = identity;
    plan.shift_q6[0][0] = -64 * 5;
    plan.shift_q6[0][1] = 64 * 200;
    plan.shift_q6[1][0] = 64 * 9;
    plan.shift_q6[1][1] = -64 * 3;
    open_plan(&plan);
    rectify_all(TSR_RECTIFY_LEFT);
    for (int x = 0; x < WIDTH; x++) {
        TEST_ASSERT_EQUAL(source_at(x - 5, HEIGHT - 1), target[x]);
    }
    rectify_all(TSR_RECTIFY_RIGHT);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            TEST_ASSERT_EQUAL(source_at(x + 9, y - 3), target[y * STRIDE + x]);
        }
    }
    check_guards();
}

static void test_position_is_what_run_reads(void)
{
    struct table_plan plan = identity;
    plan.shift_q6[0][0] = 7;
    open_plan(&plan);
    int32_t position[2];
    tsr_rectify_position(&table, TSR_RECTIFY_LEFT, 50, 33, position);
    TEST_ASSERT_EQUAL(50 * 256 + 28, position[0]);
    TEST_ASSERT_EQUAL(33 * 256, position[1]);
    tsr_rectify_position(&table, TSR_RECTIFY_LEFT, WIDTH - 1, 0, position);
    TEST_ASSERT_EQUAL((WIDTH - 1) * 256, position[0]);
}

/* Random points: a map no lens has, with whatever spread up and down. */
static void make_wild(uint8_t step_log2, uint32_t wobble_q6)
{
    struct table_plan plan = identity;
    plan.step_log2 = step_log2;
    plan.wobble_q6 = wobble_q6;
    open_plan(&plan);
}

static void test_chunks_and_place_make_no_difference(void)
{
    static uint8_t expected[HEIGHT * STRIDE];
    static const uint32_t wobbles[] = {0, 40, 400, 3000, 32000};
    for (size_t i = 0; i < sizeof wobbles / sizeof wobbles[0]; i++) {
        make_wild((uint8_t)(3 + i % 3), wobbles[i]);
        rectify_all(TSR_RECTIFY_RIGHT);
        memcpy(expected, target, sizeof expected);
        for (uint16_t rows = 1; rows < 9; rows = (uint16_t)(rows + 3)) {
            struct tsr_rectify rectify;
            memcpy(target, source, sizeof source);
            const size_t len = TSR_RECTIFY_KEPT_LEN(WIDTH, table.rows_above[1]);
            memset(kept, GUARD, sizeof kept);
            TEST_ASSERT_EQUAL(
                TSR_OK, tsr_rectify_start_in_place(&rectify, &table, TSR_RECTIFY_RIGHT, target_frame(), kept, len));
            while (tsr_rectify_run(&rectify, rows) == TSR_AGAIN) {
            }
            for (int y = 0; y < HEIGHT; y++) {
                TEST_ASSERT_EQUAL_MEMORY(expected + y * STRIDE, target + y * STRIDE, WIDTH);
                TEST_ASSERT_EQUAL_MEMORY(source + y * STRIDE + WIDTH, target + y * STRIDE + WIDTH, STRIDE - WIDTH);
            }
            TEST_ASSERT_EACH_EQUAL_HEX8(GUARD, kept + len, GUARD_LEN);
        }
    }
}

static void test_rows_above_bound_every_position(void)
{
    static const uint32_t wobbles[] = {0, 40, 400, 3000, 32000};
    for (size_t i = 0; i < sizeof wobbles / sizeof wobbles[0]; i++) {
        make_wild((uint8_t)(3 + i % 3), wobbles[i]);
        for (uint16_t y = 0; y < HEIGHT; y++) {
            for (uint16_t x = 0; x < WIDTH; x++) {
                int32_t position[2];
                tsr_rectify_position(&table, TSR_RECTIFY_LEFT, x, y, position);
                TEST_ASSERT_GREATER_OR_EQUAL(y - table.rows_above[0], position[1] / 256);
            }
        }
    }
}

static void test_every_length_but_one_is_refused(void)
{
    const size_t len = table_make(&identity, bytes);
    struct tsr_rectify_table untouched;
    memset(&table, GUARD, sizeof table);
    untouched = table;
    for (size_t shorter = 0; shorter < len; shorter++) {
        const enum tsr_status status = tsr_rectify_open(&table, bytes, shorter);
        TEST_ASSERT_EQUAL(shorter < 4 ? TSR_ERR_FORMAT : TSR_ERR_SIZE, status);
    }
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_rectify_open(&table, bytes, len + 1));
    TEST_ASSERT_EQUAL_MEMORY(&untouched, &table, sizeof table);
}

static void test_every_bit_is_under_the_crc(void)
{
    const size_t len = table_make(&identity, bytes);
    for (size_t bit = 0; bit < 8 * len; bit++) {
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        TEST_ASSERT_LESS_THAN(TSR_OK, tsr_rectify_open(&table, bytes, len));
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_open(&table, bytes, len));
}

/* One byte changed and the CRC made anew. */
static enum tsr_status open_with(size_t at, uint8_t value)
{
    const size_t len = table_make(&identity, bytes);
    bytes[at] = value;
    table_seal(bytes, len);
    return tsr_rectify_open(&table, bytes, len);
}

static void test_fields_out_of_range(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, open_with(0, 'X'));
    TEST_ASSERT_EQUAL(TSR_ERR_VERSION, open_with(4, TSR_RECTIFY_VERSION + 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(5, 2));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(5, 6));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(5, 255));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(6, 15));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(7, 3)); /* width 851 */
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(8, 15));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(10, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, open_with(13, 2)); /* source height 573 */
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, open_with(14, 40));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, open_with(17, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, open_with(20, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, open_with(24, 0)); /* f = 0 */
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, open_with(28, 0)); /* baseline = 0 */
    TEST_ASSERT_EQUAL(TSR_OK, open_with(30, 9));
}

static void test_arguments(void)
{
    struct tsr_rectify rectify;
    const size_t len = open_plan(&identity);
    struct tsr_gray_view in = source_view();
    struct tsr_gray out = target_frame();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_open(NULL, bytes, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_open(&table, NULL, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_start(NULL, &table, TSR_RECTIFY_LEFT, in, out));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_start(&rectify, NULL, TSR_RECTIFY_LEFT, in, out));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_start(&rectify, &table, (enum tsr_rectify_side)2, in, out));
    in.pixels = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_start(&rectify, &table, TSR_RECTIFY_LEFT, in, out));
    in = source_view();
    in.width--;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_rectify_start(&rectify, &table, TSR_RECTIFY_LEFT, in, out));
    in = source_view();
    in.stride = WIDTH - 1;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_rectify_start(&rectify, &table, TSR_RECTIFY_LEFT, in, out));
    in = source_view();
    out.height++;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_rectify_start(&rectify, &table, TSR_RECTIFY_LEFT, in, out));
    out = target_frame();
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_start(&rectify, &table, TSR_RECTIFY_LEFT, in, out));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_run(&rectify, 0));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_run(NULL, 1));
}

static void test_in_place_needs_room_and_one_size(void)
{
    struct tsr_rectify rectify;
    open_plan(&identity);
    const size_t len = TSR_RECTIFY_KEPT_LEN(WIDTH, table.rows_above[0]);
    struct tsr_gray frame = target_frame();
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF,
                      tsr_rectify_start_in_place(&rectify, &table, TSR_RECTIFY_LEFT, frame, kept, len - 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_start_in_place(&rectify, &table, TSR_RECTIFY_LEFT, frame, NULL, len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_rectify_start_in_place(NULL, &table, TSR_RECTIFY_LEFT, frame, kept, len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_rectify_start_in_place(&rectify, &table, TSR_RECTIFY_LEFT, frame, kept, len));
    struct table_plan larger = identity;
    larger.source_height = HEIGHT + 1;
    open_plan(&larger);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE,
                      tsr_rectify_start_in_place(&rectify, &table, TSR_RECTIFY_LEFT, frame, kept, sizeof kept));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_fields);
    RUN_TEST(test_identity_at_every_step);
    RUN_TEST(test_half_pixel_shift);
    RUN_TEST(test_borders_are_replicated);
    RUN_TEST(test_position_is_what_run_reads);
    RUN_TEST(test_chunks_and_place_make_no_difference);
    RUN_TEST(test_rows_above_bound_every_position);
    RUN_TEST(test_every_length_but_one_is_refused);
    RUN_TEST(test_every_bit_is_under_the_crc);
    RUN_TEST(test_fields_out_of_range);
    RUN_TEST(test_arguments);
    RUN_TEST(test_in_place_needs_room_and_one_size);
    return UNITY_END();
}
