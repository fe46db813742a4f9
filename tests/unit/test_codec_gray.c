/*
 * Gray-image codec: header bytes, every status, capacities, what errors leave untouched.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/gray.h"
#include "unity.h"

#define WIDTH 21
#define HEIGHT 13
#define OUT_CAP TSR_GRAY_ENCODED_LEN_MAX(WIDTH, HEIGHT)
#define SCRATCH_LEN TSR_GRAY_SCRATCH_LEN(WIDTH)

static struct tsr_gray_info info;
static struct tsr_gray_encoder encoder;
static struct tsr_gray_decoder decoder;
static uint8_t image[WIDTH * HEIGHT];
static uint8_t decoded[WIDTH * HEIGHT];
static uint8_t scratch[SCRATCH_LEN];
static uint8_t out[OUT_CAP + 16];

void setUp(void)
{
    info = (struct tsr_gray_info){.width = WIDTH, .height = HEIGHT, .near = 0};
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const unsigned x = i % WIDTH, y = i / WIDTH;
        image[i] = (uint8_t)(x < 8 ? 250 + (x * y) % 6 : 10 * y + x * x / 4);
    }
    memset(out, 0xa5, sizeof out);
    memset(decoded, 0x5a, sizeof decoded);
}
void tearDown(void) {}

static enum tsr_status start(size_t cap)
{
    return tsr_gray_encode_start(&encoder, &info, out, cap, scratch, SCRATCH_LEN);
}

static size_t encode(void)
{
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_rows(&encoder, image, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_finish(&encoder, &len));
    return len;
}

static void test_round_trip_within_near(void)
{
    size_t shortest = OUT_CAP;
    for (uint8_t near = 0; near <= TSR_GRAY_NEAR_BY_ACTIVITY; near++) {
        struct tsr_gray_info read;
        info.near = near;
        const size_t len = encode();
        TEST_ASSERT_LESS_THAN(shortest, len);
        shortest = near == 0 ? len : shortest;
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
        for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
            TEST_ASSERT_INT_WITHIN(near == TSR_GRAY_NEAR_BY_ACTIVITY ? TSR_GRAY_NEAR_BY_ACTIVITY_MAX : near, image[i],
                                   decoded[i]);
        }
        TEST_ASSERT_EQUAL(WIDTH, read.width);
        TEST_ASSERT_EQUAL(HEIGHT, read.height);
        TEST_ASSERT_EQUAL(near, read.near);
    }
}

static void test_header_bytes(void)
{
    info.near = 4;
    (void)encode();
    const uint8_t header[TSR_GRAY_HEADER_LEN] = {0x01, 0x04, WIDTH, 0, HEIGHT, 0};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(header, out, TSR_GRAY_HEADER_LEN);
}

static void check_bad_info(void)
{
    TEST_ASSERT_EQUAL(0, tsr_gray_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(OUT_CAP));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
}

static void test_start_refuses_bad_info(void)
{
    TEST_ASSERT_EQUAL(OUT_CAP, tsr_gray_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(0, tsr_gray_encoded_len_max(NULL));
    const struct tsr_gray_info good = info;
    info.width = 0;
    check_bad_info();
    info.width = TSR_IMAGE_WIDTH_MAX + 1;
    check_bad_info();
    info = good;
    info.height = 0;
    check_bad_info();
    info.height = TSR_IMAGE_HEIGHT_MAX + 1;
    check_bad_info();
    info = good;
    info.near = TSR_GRAY_NEAR_BY_ACTIVITY + 1;
    check_bad_info();
}

static void test_start_refuses(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_start(NULL, &info, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_start(&encoder, NULL, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_start(&encoder, &info, NULL, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_start(&encoder, &info, out, OUT_CAP, NULL, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_gray_encode_start(&encoder, &info, out, OUT_CAP, scratch, SCRATCH_LEN - 1));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(TSR_GRAY_HEADER_LEN - 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
    TEST_ASSERT_EQUAL(TSR_OK, start(TSR_GRAY_HEADER_LEN));
}

/* A refused call codes nothing: the same image follows and gives the same bytes. */
static void test_refused_rows_change_nothing(void)
{
    static uint8_t expected[OUT_CAP];
    const size_t expected_len = encode();
    memcpy(expected, out, expected_len);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_gray_encode_rows(&encoder, image, WIDTH, 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_rows(NULL, image, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_rows(&encoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_encode_rows(&encoder, image, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_encode_rows(&encoder, image, WIDTH, HEIGHT - 5 + 1));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_gray_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(0, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_rows(&encoder, image + 5 * WIDTH, WIDTH, HEIGHT - 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_finish(NULL, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_encode_finish(&encoder, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(expected_len, len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, out, len);
}

static void test_every_smaller_buffer(void)
{
    const size_t len = encode();
    for (size_t cap = TSR_GRAY_HEADER_LEN; cap < len; cap++) {
        size_t untouched = 77;
        memset(out, 0xa5, sizeof out);
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        const enum tsr_status rows = tsr_gray_encode_rows(&encoder, image, WIDTH, HEIGHT);
        TEST_ASSERT_TRUE(rows == TSR_ERR_NOBUF || rows == TSR_OK);
        if (rows == TSR_ERR_NOBUF) {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_gray_encode_rows(&encoder, image, WIDTH, 1));
        }
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_gray_encode_finish(&encoder, &untouched));
        TEST_ASSERT_EQUAL(77, untouched);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out + cap, sizeof out - cap);
    }
}

static void check_header_refused(enum tsr_status expected, unsigned at, uint8_t value)
{
    struct tsr_gray_info untouched = {.width = 77};
    const size_t len = encode();
    out[at] = value;
    TEST_ASSERT_EQUAL(expected, tsr_gray_read_info(out, len, &untouched));
    TEST_ASSERT_EQUAL(expected, tsr_gray_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &untouched));
    TEST_ASSERT_EQUAL(77, untouched.width);
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x02);
    check_header_refused(TSR_ERR_VERSION, 0, 0x00);
    check_header_refused(TSR_ERR_VERSION, 0, 0x11);
    check_header_refused(TSR_ERR_VERSION, 1, 0x10);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x09);
    check_header_refused(TSR_ERR_FORMAT, 2, 0);
    check_header_refused(TSR_ERR_FORMAT, 3, 3);
    check_header_refused(TSR_ERR_FORMAT, 4, 0);
    check_header_refused(TSR_ERR_FORMAT, 5, 2);
}

static void test_decode_refuses(void)
{
    struct tsr_gray_info read = {.width = 77};
    const size_t len = encode();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_decode_start(NULL, out, len, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_decode_start(&decoder, NULL, len, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_decode_start(&decoder, out, len, NULL, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_gray_decode_start(&decoder, out, len, scratch, SCRATCH_LEN - 1, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT,
                      tsr_gray_decode_start(&decoder, out, TSR_GRAY_HEADER_LEN - 1, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_read_info(NULL, len, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_read_info(out, len, NULL));
    TEST_ASSERT_EQUAL(77, read.width);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_decode_rows(NULL, decoded, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_decode_rows(&decoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_decode_rows(&decoder, decoded, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_decode_rows(&decoder, decoded, WIDTH, HEIGHT + 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_gray_decode_rows(&decoder, decoded, WIDTH, HEIGHT - 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_decode_rows(&decoder, decoded + (HEIGHT - 1) * WIDTH, WIDTH, 1));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(image, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_decode_rows(&decoder, decoded, WIDTH, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_round_trip_within_near);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_start_refuses);
    RUN_TEST(test_refused_rows_change_nothing);
    RUN_TEST(test_every_smaller_buffer);
    RUN_TEST(test_header_refused);
    RUN_TEST(test_decode_refuses);
    return UNITY_END();
}
