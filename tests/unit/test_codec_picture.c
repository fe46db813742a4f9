/*
 * Picture codec: header bytes, every status, capacities, what errors leave untouched.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/picture.h"
#include "unity.h"

#define WIDTH 21
#define HEIGHT 13
#define OUT_CAP TSR_PICTURE_ENCODED_LEN_MAX(WIDTH, HEIGHT)
#define SCRATCH_LEN TSR_PICTURE_SCRATCH_LEN(WIDTH)

static struct tsr_picture_info info;
static struct tsr_picture_encoder encoder;
static struct tsr_picture_decoder decoder;
static uint8_t image[WIDTH * HEIGHT];
static uint8_t decoded[WIDTH * HEIGHT];
static uint8_t scratch[SCRATCH_LEN];
static uint8_t out[OUT_CAP + 16];

void setUp(void)
{
    info = (struct tsr_picture_info){.width = WIDTH, .height = HEIGHT, .step = 24, .prior = TSR_PICTURE_PRIOR_TRAINED};
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
    return tsr_picture_encode_start(&encoder, &info, 0, out, cap, scratch, SCRATCH_LEN);
}

static size_t encode(void)
{
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_rows(&encoder, image, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&encoder, &len));
    return len;
}

/* A finer step costs more. With the finest, what is left is what smoothing does to this picture's edges. */
static void test_round_trip_of_every_step(void)
{
    size_t len_before = OUT_CAP;
    for (uint8_t step = 0; step <= TSR_PICTURE_STEP_MAX; step = (uint8_t)(step + 9)) {
        struct tsr_picture_info read;
        unsigned long error = 0;
        info.step = step;
        const size_t len = encode();
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
        for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
            const int difference = (int)image[i] - (int)decoded[i];
            error += (unsigned long)(difference * difference);
        }
        TEST_ASSERT_LESS_THAN(len_before, len);
        TEST_ASSERT_LESS_THAN(step == 0 ? 4u * WIDTH * HEIGHT : 6000u * WIDTH * HEIGHT, error);
        len_before = len;
        TEST_ASSERT_EQUAL(WIDTH, read.width);
        TEST_ASSERT_EQUAL(HEIGHT, read.height);
        TEST_ASSERT_EQUAL(step, read.step);
        TEST_ASSERT_EQUAL(TSR_PICTURE_PRIOR_TRAINED, read.prior);
    }
}

/* A flat picture is the first block's mean: nothing else is coded, and smoothing keeps it. */
static void test_flat_picture_is_exact(void)
{
    struct tsr_picture_info read;
    for (unsigned gray = 0; gray < 256; gray += 5) {
        memset(image, (int)gray, sizeof image);
        info.step = 0;
        const size_t len = encode();
        TEST_ASSERT_LESS_THAN(20, len);
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &read));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
        for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
            TEST_ASSERT_INT_WITHIN(1 + (int)gray / 32, gray, decoded[i]);
            TEST_ASSERT_EQUAL(decoded[0], decoded[i]);
        }
    }
}

static size_t encode_to(uint32_t target_len, const uint8_t *pixels, uint8_t *bytes, size_t cap)
{
    static uint8_t wide_scratch[TSR_PICTURE_SCRATCH_LEN(160)];
    const struct tsr_picture_info wide = {160, 120, 40, TSR_PICTURE_PRIOR_TRAINED};
    size_t len = 0;
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_picture_encode_start(&encoder, &wide, target_len, bytes, cap, wide_scratch, sizeof wide_scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_rows(&encoder, pixels, 160, 120));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&encoder, &len));
    return len;
}

/* The step follows the target up and down, from the same first step. */
static void test_target_is_met(void)
{
    static uint8_t pixels[160 * 120], bytes[TSR_PICTURE_ENCODED_LEN_MAX(160, 120)];
    uint32_t noise = 1;
    for (unsigned i = 0; i < sizeof pixels; i++) {
        noise = noise * 1664525u + 1013904223u;
        const unsigned x = i % 160, y = i / 160;
        pixels[i] = (uint8_t)((x * x / 90 + y * y / 70 + (noise >> 27)) & 255u);
    }
    for (uint32_t target_len = 800; target_len <= 6400; target_len *= 2) {
        const size_t len = encode_to(target_len, pixels, bytes, sizeof bytes);
        TEST_ASSERT_UINT_WITHIN(target_len / 8, target_len, len);
    }
}

static void test_prior_of_contexts(void)
{
    const uint16_t prior[3] = {0x8000, 0x0015, 0xffff};
    struct tsr_range_bit bits[3];
    tsr_range_bits_load(bits, prior, 3);
    TEST_ASSERT_EQUAL(0x8000, bits[0].p_one_q16);
    TEST_ASSERT_EQUAL(0, bits[0].count);
    TEST_ASSERT_EQUAL(0x0010, bits[1].p_one_q16);
    TEST_ASSERT_EQUAL(6, bits[1].count);
    TEST_ASSERT_EQUAL(0xfff0, bits[2].p_one_q16);
    TEST_ASSERT_EQUAL(60, bits[2].count);
}

/* No probability of the table is beyond what contexts learn: 2 .. 4094 in 2^-12. */
static void test_prior_is_within_bounds(void)
{
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_start(&encoder, &info, 0, out, sizeof out, scratch, SCRATCH_LEN));
    for (unsigned i = 0; i < TSR_PICTURE_CONTEXT_COUNT; i++) {
        TEST_ASSERT_LESS_OR_EQUAL(4094u << 4, encoder.model.contexts[i].p_one_q16);
        TEST_ASSERT_GREATER_OR_EQUAL(2u << 4, encoder.model.contexts[i].p_one_q16);
    }
}

static void test_header_bytes(void)
{
    info.step = 37;
    (void)encode();
    const uint8_t header[TSR_PICTURE_HEADER_LEN] = {0x01, 0x40 | 37, WIDTH, 0, HEIGHT, 0};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(header, out, TSR_PICTURE_HEADER_LEN);
}

static void check_bad_info(void)
{
    TEST_ASSERT_EQUAL(0, tsr_picture_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(OUT_CAP));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
}

static void test_start_refuses_bad_info(void)
{
    TEST_ASSERT_EQUAL(OUT_CAP, tsr_picture_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(0, tsr_picture_encoded_len_max(NULL));
    const struct tsr_picture_info good = info;
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
    info.step = TSR_PICTURE_STEP_MAX + 1;
    check_bad_info();
    info = good;
    info.prior = TSR_PICTURE_PRIOR_TRAINED + 1;
    check_bad_info();
}

static void test_start_refuses(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_start(NULL, &info, 0, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_start(&encoder, NULL, 0, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_start(&encoder, &info, 0, NULL, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_start(&encoder, &info, 0, out, OUT_CAP, NULL, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF,
                      tsr_picture_encode_start(&encoder, &info, 0, out, OUT_CAP, scratch, SCRATCH_LEN - 1));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(TSR_PICTURE_HEADER_LEN - 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
    TEST_ASSERT_EQUAL(TSR_OK, start(TSR_PICTURE_HEADER_LEN));
}

/* A refused call codes nothing: the same image follows and gives the same bytes. */
static void test_refused_rows_change_nothing(void)
{
    static uint8_t expected[OUT_CAP];
    const size_t expected_len = encode();
    memcpy(expected, out, expected_len);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_picture_encode_rows(&encoder, image, WIDTH, 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_rows(NULL, image, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_rows(&encoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_encode_rows(&encoder, image, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_encode_rows(&encoder, image, WIDTH, HEIGHT - 5 + 1));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_picture_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(0, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_rows(&encoder, image + 5 * WIDTH, WIDTH, HEIGHT - 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_finish(NULL, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_encode_finish(&encoder, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(expected_len, len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, out, len);
}

static void test_every_smaller_buffer(void)
{
    const size_t len = encode();
    for (size_t cap = TSR_PICTURE_HEADER_LEN; cap < len; cap++) {
        size_t untouched = 77;
        memset(out, 0xa5, sizeof out);
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        const enum tsr_status rows = tsr_picture_encode_rows(&encoder, image, WIDTH, HEIGHT);
        TEST_ASSERT_TRUE(rows == TSR_ERR_NOBUF || rows == TSR_OK);
        if (rows == TSR_ERR_NOBUF) {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_picture_encode_rows(&encoder, image, WIDTH, 1));
        }
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_picture_encode_finish(&encoder, &untouched));
        TEST_ASSERT_EQUAL(77, untouched);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out + cap, sizeof out - cap);
    }
}

static void check_header_refused(enum tsr_status expected, unsigned at, uint8_t value)
{
    struct tsr_picture_info untouched = {.width = 77};
    const size_t len = encode();
    out[at] = value;
    TEST_ASSERT_EQUAL(expected, tsr_picture_read_info(out, len, &untouched));
    TEST_ASSERT_EQUAL(expected, tsr_picture_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &untouched));
    TEST_ASSERT_EQUAL(77, untouched.width);
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x02);
    check_header_refused(TSR_ERR_VERSION, 0, 0x00);
    check_header_refused(TSR_ERR_VERSION, 0, 0x11);
    check_header_refused(TSR_ERR_VERSION, 1, 0x80);
    check_header_refused(TSR_ERR_VERSION, 1, 0xff);
    check_header_refused(TSR_ERR_FORMAT, 2, 0);
    check_header_refused(TSR_ERR_FORMAT, 3, 3);
    check_header_refused(TSR_ERR_FORMAT, 4, 0);
    check_header_refused(TSR_ERR_FORMAT, 5, 2);
}

static void test_decode_refuses(void)
{
    struct tsr_picture_info read = {.width = 77};
    const size_t len = encode();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_decode_start(NULL, out, len, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_decode_start(&decoder, NULL, len, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_decode_start(&decoder, out, len, NULL, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_picture_decode_start(&decoder, out, len, scratch, SCRATCH_LEN - 1, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT,
                      tsr_picture_decode_start(&decoder, out, TSR_PICTURE_HEADER_LEN - 1, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_read_info(NULL, len, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_read_info(out, len, NULL));
    TEST_ASSERT_EQUAL(77, read.width);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_start(&decoder, out, len, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_decode_rows(NULL, decoded, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_picture_decode_rows(&decoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_decode_rows(&decoder, decoded, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_decode_rows(&decoder, decoded, WIDTH, HEIGHT + 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_picture_decode_rows(&decoder, decoded, WIDTH, HEIGHT - 1));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_rows(&decoder, decoded + (HEIGHT - 1) * WIDTH, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_picture_decode_rows(&decoder, decoded, WIDTH, 1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_round_trip_of_every_step);
    RUN_TEST(test_flat_picture_is_exact);
    RUN_TEST(test_target_is_met);
    RUN_TEST(test_prior_of_contexts);
    RUN_TEST(test_prior_is_within_bounds);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_start_refuses);
    RUN_TEST(test_refused_rows_change_nothing);
    RUN_TEST(test_every_smaller_buffer);
    RUN_TEST(test_header_refused);
    RUN_TEST(test_decode_refuses);
    return UNITY_END();
}
