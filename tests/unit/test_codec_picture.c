/*
 * Picture codec: header bytes, every status, capacities, what errors leave untouched.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/picture.h"

#define FRAME_WIDTH 21
#define FRAME_HEIGHT 13
#define FRAME_HEADER_LEN TSR_PICTURE_HEADER_LEN
#define FRAME_OUT_CAP TSR_PICTURE_ENCODED_LEN_MAX(FRAME_WIDTH, FRAME_HEIGHT)
#define FRAME_SCRATCH_LEN TSR_PICTURE_SCRATCH_LEN(FRAME_WIDTH)
#define FRAME(name) tsr_picture_##name
#define FRAME_ENCODE_START(encoder, info, out, out_cap, scratch, scratch_cap)                                          \
    tsr_picture_encode_start(encoder, info, 0, out, out_cap, scratch, scratch_cap)
#define FRAME_DECODE_START(decoder, bytes, len, scratch, scratch_cap, info)                                            \
    tsr_picture_decode_start(decoder, bytes, len, scratch, scratch_cap, info)
#include "codec_frame.h"

void setUp(void)
{
    info = (struct tsr_picture_info){
        .width = FRAME_WIDTH, .height = FRAME_HEIGHT, .step = 24, .prior = TSR_PICTURE_PRIOR_TRAINED};
    for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
        const unsigned x = i % FRAME_WIDTH, y = i / FRAME_WIDTH;
        image[i] = (uint8_t)(x < 8 ? 250 + (x * y) % 6 : 10 * y + x * x / 4);
    }
    frame_set_up();
}
void tearDown(void) {}

/* A finer step costs more. With the finest, what is left is what smoothing does to this picture's edges. */
static void test_round_trip_of_every_step(void)
{
    size_t len_before = FRAME_OUT_CAP;
    for (uint8_t step = 0; step <= TSR_PICTURE_STEP_MAX; step = (uint8_t)(step + 9)) {
        unsigned long error = 0;
        info.step = step;
        const size_t len = encode();
        const struct tsr_picture_info read = decode(len);
        for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
            const int difference = (int)image[i] - (int)decoded[i];
            error += (unsigned long)(difference * difference);
        }
        TEST_ASSERT_LESS_THAN(len_before, len);
        TEST_ASSERT_LESS_THAN(step == 0 ? 4u * FRAME_WIDTH * FRAME_HEIGHT : 6000u * FRAME_WIDTH * FRAME_HEIGHT, error);
        len_before = len;
        TEST_ASSERT_EQUAL(step, read.step);
        TEST_ASSERT_EQUAL(TSR_PICTURE_PRIOR_TRAINED, read.prior);
    }
}

/* A flat picture is the first block's mean: nothing else is coded, and smoothing keeps it. */
static void test_flat_picture_is_exact(void)
{
    for (unsigned gray = 0; gray < 256; gray += 5) {
        memset(image, (int)gray, sizeof image);
        info.step = 0;
        const size_t len = encode();
        TEST_ASSERT_LESS_THAN(20, len);
        (void)decode(len);
        for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
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
    TEST_ASSERT_EQUAL(TSR_OK,
                      tsr_picture_encode_start(&encoder, &info, 0, out, sizeof out, scratch, FRAME_SCRATCH_LEN));
    for (unsigned i = 0; i < TSR_PICTURE_CONTEXT_COUNT; i++) {
        TEST_ASSERT_LESS_OR_EQUAL(4094u << 4, encoder.model.contexts[i].p_one_q16);
        TEST_ASSERT_GREATER_OR_EQUAL(2u << 4, encoder.model.contexts[i].p_one_q16);
    }
}

static void test_header_bytes(void)
{
    info.step = 37;
    (void)encode();
    const uint8_t header[TSR_PICTURE_HEADER_LEN] = {0x01, 0x40 | 37, FRAME_WIDTH, 0, FRAME_HEIGHT, 0};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(header, out, TSR_PICTURE_HEADER_LEN);
}

static void test_start_refuses_bad_info(void)
{
    const struct tsr_picture_info good = info;
    info.step = TSR_PICTURE_STEP_MAX + 1;
    check_bad_info();
    info = good;
    info.prior = TSR_PICTURE_PRIOR_TRAINED + 1;
    check_bad_info();
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x11);
    check_header_refused(TSR_ERR_VERSION, 1, 0x80);
    check_header_refused(TSR_ERR_VERSION, 1, 0xff);
}

int main(void)
{
    UNITY_BEGIN();
    FRAME_RUN_CONTRACT();
    RUN_TEST(test_round_trip_of_every_step);
    RUN_TEST(test_flat_picture_is_exact);
    RUN_TEST(test_target_is_met);
    RUN_TEST(test_prior_of_contexts);
    RUN_TEST(test_prior_is_within_bounds);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_header_refused);
    return UNITY_END();
}
