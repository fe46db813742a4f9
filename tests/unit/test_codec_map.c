/*
 * Disparity-map codec: header bytes, every status, capacities, what errors leave untouched.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/map.h"
#include "unity.h"

#define WIDTH 20
#define HEIGHT 12
#define OUT_CAP TSR_MAP_ENCODED_LEN_MAX(WIDTH, HEIGHT, 32, 2)
#define SCRATCH_COUNT TSR_MAP_SCRATCH_COUNT(WIDTH)

static const struct tsr_map_info info = {
    .width = WIDTH, .height = HEIGHT, .disparities = 32, .step_log2 = 2, .d0_q4 = -500};
static struct tsr_map_encoder encoder;
static struct tsr_map_decoder decoder;
static uint16_t map[WIDTH * HEIGHT];
static uint16_t decoded[WIDTH * HEIGHT];
static uint16_t scratch[SCRATCH_COUNT];
static uint8_t out[OUT_CAP + 16];

void setUp(void)
{
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const unsigned x = i % WIDTH, y = i / WIDTH;
        map[i] = x < 3 ? TSR_DISPARITY_INVALID : (uint16_t)(4u * ((x / 5) * 20 + (y * x) % 3));
    }
    memset(out, 0xa5, sizeof out);
    memset(decoded, 0x5a, sizeof decoded);
}
void tearDown(void) {}

static enum tsr_status start(size_t cap)
{
    return tsr_map_encode_start(&encoder, &info, out, cap, scratch, SCRATCH_COUNT);
}

static size_t encode(void)
{
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_rows(&encoder, map, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
    return len;
}

static void test_round_trip(void)
{
    struct tsr_map_info read;
    const size_t len = encode();
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_COUNT, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(map, decoded, WIDTH * HEIGHT);
    TEST_ASSERT_EQUAL(WIDTH, read.width);
    TEST_ASSERT_EQUAL(HEIGHT, read.height);
    TEST_ASSERT_EQUAL(32, read.disparities);
    TEST_ASSERT_EQUAL(2, read.step_log2);
    TEST_ASSERT_EQUAL(-500, read.d0_q4);
}

static void test_header_bytes(void)
{
    (void)encode();
    const uint8_t header[TSR_MAP_HEADER_LEN] = {0x03, 0x22, 31, WIDTH, 0, HEIGHT, 0, 0x0c, 0xfe};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(header, out, TSR_MAP_HEADER_LEN);
}

static void test_length_of_literals(void)
{
    TEST_ASSERT_EQUAL(8, TSR_MAP_LABEL_BITS(32, 2));
    TEST_ASSERT_EQUAL(9, TSR_MAP_LABEL_BITS(64, 2));
    TEST_ASSERT_EQUAL(12, TSR_MAP_LABEL_BITS(128, 0));
    TEST_ASSERT_EQUAL(1, TSR_MAP_LABEL_BITS(1, 4));
    for (unsigned disparities = 1; disparities <= TSR_DISPARITY_COUNT_MAX; disparities++) {
        for (unsigned step_log2 = 0; step_log2 <= TSR_MAP_STEP_LOG2_MAX; step_log2++) {
            const unsigned bits = TSR_MAP_LABEL_BITS(disparities, step_log2);
            const unsigned last = disparities * 16u >> step_log2;
            TEST_ASSERT_EQUAL(1, last >> (bits - 1));
        }
    }
    TEST_ASSERT_EQUAL(OUT_CAP, tsr_map_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(0, tsr_map_encoded_len_max(NULL));
}

static void check_bad_info(struct tsr_map_info bad)
{
    TEST_ASSERT_EQUAL(0, tsr_map_encoded_len_max(&bad));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_start(&encoder, &bad, out, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
}

static void test_start_refuses(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_start(NULL, &info, out, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_start(&encoder, NULL, out, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_start(&encoder, &info, NULL, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_start(&encoder, &info, out, OUT_CAP, NULL, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_map_encode_start(&encoder, &info, out, OUT_CAP, scratch, SCRATCH_COUNT - 1));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(TSR_MAP_HEADER_LEN - 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
    TEST_ASSERT_EQUAL(TSR_OK, start(TSR_MAP_HEADER_LEN));
}

static void test_start_refuses_bad_info(void)
{
    struct tsr_map_info bad = info;
    bad.width = 0;
    check_bad_info(bad);
    bad.width = TSR_IMAGE_WIDTH_MAX + 1;
    check_bad_info(bad);
    bad = info;
    bad.height = 0;
    check_bad_info(bad);
    bad.height = TSR_IMAGE_HEIGHT_MAX + 1;
    check_bad_info(bad);
    bad = info;
    bad.disparities = 0;
    check_bad_info(bad);
    bad.disparities = TSR_DISPARITY_COUNT_MAX + 1;
    check_bad_info(bad);
    bad = info;
    bad.step_log2 = TSR_MAP_STEP_LOG2_MAX + 1;
    check_bad_info(bad);
    bad = info;
    bad.near = TSR_MAP_NEAR_MAX + 1;
    check_bad_info(bad);
}

/* A refused call codes nothing: the same map follows and gives the same bytes. */
static void test_refused_rows_change_nothing(void)
{
    static uint8_t expected[OUT_CAP];
    const size_t expected_len = encode();
    memcpy(expected, out, expected_len);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_map_encode_rows(&encoder, map, WIDTH, 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_rows(NULL, map, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_rows(&encoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_encode_rows(&encoder, map, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_encode_rows(&encoder, map, WIDTH, HEIGHT - 5 + 1));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_map_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(0, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_rows(&encoder, map + 5 * WIDTH, WIDTH, HEIGHT - 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_finish(NULL, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_finish(&encoder, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(expected_len, len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, out, len);
}

/* In every column, beside valid and invalid ones, and in a row of odd width. */
static void test_bad_value_loses_the_map(void)
{
    const uint16_t bad_values[] = {1, 2, 3, 511, 512, 0x7ffc, 0x8000, 0xfffe, 0xfffc};
    for (unsigned odd = 0; odd < 2; odd++) {
        struct tsr_map_info shape = info;
        shape.width = (uint16_t)(WIDTH - odd);
        for (unsigned i = 0; i < shape.width * (sizeof bad_values / sizeof *bad_values); i++) {
            uint16_t *const place = &map[WIDTH + i % shape.width];
            const uint16_t kept = *place;
            size_t len = 77;
            *place = bad_values[i / shape.width];
            TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_start(&encoder, &shape, out, OUT_CAP, scratch, SCRATCH_COUNT));
            TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_rows(&encoder, map, WIDTH, 2));
            *place = kept;
            TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_rows(&encoder, map, WIDTH, 1));
            TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_encode_finish(&encoder, &len));
            TEST_ASSERT_EQUAL(77, len);
        }
    }
}

static void test_every_smaller_buffer(void)
{
    const size_t len = encode();
    for (size_t cap = TSR_MAP_HEADER_LEN; cap < len; cap++) {
        size_t untouched = 77;
        memset(out, 0xa5, sizeof out);
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        const enum tsr_status rows = tsr_map_encode_rows(&encoder, map, WIDTH, HEIGHT);
        TEST_ASSERT_TRUE(rows == TSR_ERR_NOBUF || rows == TSR_OK);
        if (rows == TSR_ERR_NOBUF) {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_map_encode_rows(&encoder, map, WIDTH, 1));
        }
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_map_encode_finish(&encoder, &untouched));
        TEST_ASSERT_EQUAL(77, untouched);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out + cap, sizeof out - cap);
    }
}

static void check_header_refused(enum tsr_status expected, unsigned at, uint8_t value)
{
    struct tsr_map_info untouched = {.width = 77};
    const size_t len = encode();
    out[at] = value;
    TEST_ASSERT_EQUAL(expected, tsr_map_read_info(out, len, &untouched));
    TEST_ASSERT_EQUAL(expected, tsr_map_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_COUNT, &untouched));
    TEST_ASSERT_EQUAL(77, untouched.width);
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x01);
    check_header_refused(TSR_ERR_VERSION, 0, 0x02);
    check_header_refused(TSR_ERR_VERSION, 0, 0x23);
    check_header_refused(TSR_ERR_VERSION, 1, 0x02);
    check_header_refused(TSR_ERR_VERSION, 1, 0x12);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x25);
    check_header_refused(TSR_ERR_FORMAT, 2, 128);
    check_header_refused(TSR_ERR_FORMAT, 3, 0);
    check_header_refused(TSR_ERR_FORMAT, 4, 3);
    check_header_refused(TSR_ERR_FORMAT, 5, 0);
    check_header_refused(TSR_ERR_FORMAT, 6, 2);
}

static void test_decode_start_refuses(void)
{
    struct tsr_map_info untouched = {.width = 77};
    const size_t len = encode();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_decode_start(NULL, out, len, NULL, scratch, SCRATCH_COUNT, &untouched));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_decode_start(&decoder, NULL, len, NULL, scratch, SCRATCH_COUNT, &untouched));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_decode_start(&decoder, out, len, NULL, NULL, SCRATCH_COUNT, &untouched));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_COUNT, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF,
                      tsr_map_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_COUNT - 1, &untouched));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_map_decode_start(&decoder, out, TSR_MAP_HEADER_LEN - 1, NULL, scratch,
                                                           SCRATCH_COUNT, &untouched));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_read_info(NULL, len, &untouched));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_read_info(out, len, NULL));
    TEST_ASSERT_EQUAL(77, untouched.width);
}

static void test_decode_rows_refuses(void)
{
    struct tsr_map_info read;
    const size_t len = encode();
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_COUNT, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_decode_rows(NULL, decoded, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_map_decode_rows(&decoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_decode_rows(&decoder, decoded, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_decode_rows(&decoder, decoded, WIDTH, HEIGHT + 1));
    TEST_ASSERT_EACH_EQUAL_HEX16(0x5a5a, decoded, WIDTH * HEIGHT);
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_map_decode_rows(&decoder, decoded, WIDTH, HEIGHT - 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_rows(&decoder, decoded + (HEIGHT - 1) * WIDTH, WIDTH, 1));
    TEST_ASSERT_EQUAL_UINT16_ARRAY(map, decoded, WIDTH * HEIGHT);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_decode_rows(&decoder, decoded, WIDTH, 1));
}

static void decode_all(const uint8_t *bytes, size_t len, const struct tsr_map_reference *against)
{
    struct tsr_map_info read;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_start(&decoder, bytes, len, against, scratch, SCRATCH_COUNT, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
}

/* One step off at most, and matches exactly where they were. */
static void test_near(void)
{
    struct tsr_map_info near = info;
    near.near = 1;
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_start(&encoder, &near, out, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_rows(&encoder, map, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL_HEX8(0x2a, out[1]);
    decode_all(out, len, NULL);
    unsigned different = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        TEST_ASSERT_EQUAL(map[i] == TSR_DISPARITY_INVALID, decoded[i] == TSR_DISPARITY_INVALID);
        TEST_ASSERT_UINT16_WITHIN(4, map[i], decoded[i]);
        different += map[i] != decoded[i];
    }
    TEST_ASSERT_GREATER_THAN(0, different);
    TEST_ASSERT_LESS_THAN(encode(), len);
}

static void test_against_a_reference(void)
{
    static uint16_t earlier[HEIGHT * (WIDTH + 3)];
    struct tsr_map_reference against = {earlier, WIDTH + 3, 0x1234};
    struct tsr_map_info read = {.width = 77};
    const size_t alone_len = encode();
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        earlier[i / WIDTH * (WIDTH + 3) + i % WIDTH] = i % WIDTH == 13 ? TSR_DISPARITY_INVALID : map[i];
    }
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_map_encode_start_against(&encoder, &info, &against, out, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_rows(&encoder, map, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_encode_finish(&encoder, &len));
    TEST_ASSERT_LESS_THAN(alone_len, len);
    const uint8_t header[] = {0x13, 0x22, 31, WIDTH, 0, HEIGHT, 0, 0x0c, 0xfe, 0x34, 0x12};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(header, out, sizeof header);
    decode_all(out, len, &against);
    TEST_ASSERT_EQUAL_UINT16_ARRAY(map, decoded, WIDTH * HEIGHT);

    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, tsr_map_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_COUNT, &read));
    against.id++;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, tsr_map_decode_start(&decoder, out, len, &against, scratch, SCRATCH_COUNT, &read));
    against.id--;
    against.stride = WIDTH - 1;
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_map_decode_start(&decoder, out, len, &against, scratch, SCRATCH_COUNT, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE,
                      tsr_map_encode_start_against(&encoder, &info, &against, out, OUT_CAP, scratch, SCRATCH_COUNT));
    against.map = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_map_encode_start_against(&encoder, &info, &against, out, OUT_CAP, scratch, SCRATCH_COUNT));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_map_read_info(out, TSR_MAP_HEADER_LEN, &read));
    TEST_ASSERT_EQUAL(77, read.width);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_map_read_info(out, TSR_MAP_HEADER_LEN_MAX, &read));
    TEST_ASSERT_TRUE(read.has_reference);
    TEST_ASSERT_EQUAL_HEX16(0x1234, read.reference_id);
}

/* One of 256 constant streams asks for a difference that leaves the range. */
static void test_label_out_of_range(void)
{
    struct tsr_map_info read;
    (void)encode();
    enum tsr_status status = TSR_OK;
    for (unsigned value = 0; value < 256 && status != TSR_ERR_FORMAT; value++) {
        memset(out + TSR_MAP_HEADER_LEN, (int)value, OUT_CAP - TSR_MAP_HEADER_LEN);
        memset(decoded, 0x5a, sizeof decoded);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_map_decode_start(&decoder, out, OUT_CAP, NULL, scratch, SCRATCH_COUNT, &read));
        status = tsr_map_decode_rows(&decoder, decoded, WIDTH, HEIGHT);
    }
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, status);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        TEST_ASSERT_TRUE(decoded[i] == TSR_DISPARITY_INVALID || (decoded[i] < 512 && decoded[i] % 4 == 0));
    }
    TEST_ASSERT_EQUAL_HEX16(TSR_DISPARITY_INVALID, decoded[WIDTH * HEIGHT - 1]);
    memset(decoded, 0x5a, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_map_decode_rows(&decoder, decoded, WIDTH, 1));
    TEST_ASSERT_EACH_EQUAL_HEX16(0x5a5a, decoded, WIDTH * HEIGHT);
}

static void test_state_is_small(void)
{
    const size_t scratch_len = TSR_MAP_SCRATCH_COUNT(320) * sizeof(uint16_t);
    TEST_ASSERT_LESS_OR_EQUAL(6 * 1024, sizeof(struct tsr_map_encoder) + scratch_len);
    TEST_ASSERT_LESS_OR_EQUAL(6 * 1024, sizeof(struct tsr_map_decoder) + scratch_len);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_round_trip);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_length_of_literals);
    RUN_TEST(test_start_refuses);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_refused_rows_change_nothing);
    RUN_TEST(test_bad_value_loses_the_map);
    RUN_TEST(test_every_smaller_buffer);
    RUN_TEST(test_header_refused);
    RUN_TEST(test_decode_start_refuses);
    RUN_TEST(test_decode_rows_refuses);
    RUN_TEST(test_near);
    RUN_TEST(test_against_a_reference);
    RUN_TEST(test_label_out_of_range);
    RUN_TEST(test_state_is_small);
    return UNITY_END();
}
