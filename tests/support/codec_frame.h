/*
 * What the codecs of gray images, views and pictures promise alike, as unit tests. A test includes this
 * header after the codec's and after it has defined
 *
 *   FRAME(name)         tsr_<codec>_<name>
 *   FRAME_WIDTH, FRAME_HEIGHT, and of that size FRAME_OUT_CAP, FRAME_SCRATCH_LEN
 *   FRAME_HEADER_LEN    room that encode_start asks for
 *   FRAME_ENCODE_START(encoder, info, out, out_cap, scratch, scratch_cap)
 *   FRAME_DECODE_START(decoder, bytes, len, scratch, scratch_cap, info)
 *
 * and calls frame_set_up() from setUp() and FRAME_RUN_CONTRACT() from main().
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TESTS_CODEC_FRAME_H
#define TSR_TESTS_CODEC_FRAME_H

#include <string.h>

#include "unity.h"

#define FRAME_PIXELS (FRAME_WIDTH * FRAME_HEIGHT)

static struct FRAME(info) info;
static struct FRAME(encoder) encoder;
static struct FRAME(decoder) decoder;
static uint8_t image[FRAME_PIXELS];
static uint8_t decoded[FRAME_PIXELS];
static uint8_t scratch[FRAME_SCRATCH_LEN];
static uint8_t out[FRAME_OUT_CAP + 16];

/* Where nothing shall be written. */
static void frame_set_up(void)
{
    memset(out, 0xa5, sizeof out);
    memset(decoded, 0x5a, sizeof decoded);
}

static enum tsr_status start(size_t cap)
{
    return FRAME_ENCODE_START(&encoder, &info, out, cap, scratch, FRAME_SCRATCH_LEN);
}

static size_t encode(void)
{
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(FRAME_OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_OK, FRAME(encode_rows)(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, FRAME(encode_finish)(&encoder, &len));
    return len;
}

/* Of len bytes of out; gives what the header says. */
static struct FRAME(info) decode(size_t len)
{
    struct FRAME(info) read;
    TEST_ASSERT_EQUAL(TSR_OK, FRAME_DECODE_START(&decoder, out, len, scratch, FRAME_SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_OK, FRAME(decode_rows)(&decoder, decoded, FRAME_WIDTH, FRAME_HEIGHT));
    TEST_ASSERT_EQUAL(FRAME_WIDTH, read.width);
    TEST_ASSERT_EQUAL(FRAME_HEIGHT, read.height);
    return read;
}

static void check_bad_info(void)
{
    TEST_ASSERT_EQUAL(0, FRAME(encoded_len_max)(&info));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(FRAME_OUT_CAP));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
}

static void test_start_refuses_bad_sizes(void)
{
    const struct FRAME(info) good = info;
    TEST_ASSERT_EQUAL(FRAME_OUT_CAP, FRAME(encoded_len_max)(&info));
    TEST_ASSERT_EQUAL(0, FRAME(encoded_len_max)(NULL));
    info.width = 0;
    check_bad_info();
    info.width = TSR_IMAGE_WIDTH_MAX + 1;
    check_bad_info();
    info = good;
    info.height = 0;
    check_bad_info();
    info.height = TSR_IMAGE_HEIGHT_MAX + 1;
    check_bad_info();
}

static void test_start_refuses(void)
{
    const size_t cap = FRAME_OUT_CAP, room = FRAME_SCRATCH_LEN;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_ENCODE_START(NULL, &info, out, cap, scratch, room));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_ENCODE_START(&encoder, NULL, out, cap, scratch, room));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_ENCODE_START(&encoder, &info, NULL, cap, scratch, room));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_ENCODE_START(&encoder, &info, out, cap, NULL, room));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, FRAME_ENCODE_START(&encoder, &info, out, cap, scratch, room - 1));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(FRAME_HEADER_LEN - 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
    TEST_ASSERT_EQUAL(TSR_OK, start(FRAME_HEADER_LEN));
}

/* A refused call codes nothing: the same image follows and gives the same bytes. */
static void test_refused_rows_change_nothing(void)
{
    static uint8_t expected[FRAME_OUT_CAP];
    const size_t expected_len = encode();
    memcpy(expected, out, expected_len);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(FRAME_OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_AGAIN, FRAME(encode_rows)(&encoder, image, FRAME_WIDTH, 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(encode_rows)(NULL, image, FRAME_WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(encode_rows)(&encoder, NULL, FRAME_WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, FRAME(encode_rows)(&encoder, image, FRAME_WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, FRAME(encode_rows)(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT - 5 + 1));
    TEST_ASSERT_EQUAL(TSR_AGAIN, FRAME(encode_finish)(&encoder, &len));
    TEST_ASSERT_EQUAL(0, len);
    TEST_ASSERT_EQUAL(TSR_OK, FRAME(encode_rows)(&encoder, image + 5 * FRAME_WIDTH, FRAME_WIDTH, FRAME_HEIGHT - 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(encode_finish)(NULL, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(encode_finish)(&encoder, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, FRAME(encode_finish)(&encoder, &len));
    TEST_ASSERT_EQUAL(expected_len, len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, out, len);
}

static void test_every_smaller_buffer(void)
{
    const size_t len = encode();
    for (size_t cap = FRAME_HEADER_LEN; cap < len; cap++) {
        size_t untouched = 77;
        memset(out, 0xa5, sizeof out);
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        const enum tsr_status rows = FRAME(encode_rows)(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT);
        TEST_ASSERT_TRUE(rows == TSR_ERR_NOBUF || rows == TSR_OK);
        if (rows == TSR_ERR_NOBUF) {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, FRAME(encode_rows)(&encoder, image, FRAME_WIDTH, 1));
        }
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, FRAME(encode_finish)(&encoder, &untouched));
        TEST_ASSERT_EQUAL(77, untouched);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out + cap, sizeof out - cap);
    }
}

static void check_header_refused(enum tsr_status expected, unsigned at, uint8_t value)
{
    struct FRAME(info) untouched = {.width = 77};
    const size_t len = encode();
    out[at] = value;
    TEST_ASSERT_EQUAL(expected, FRAME(read_info)(out, len, &untouched));
    TEST_ASSERT_EQUAL(expected, FRAME_DECODE_START(&decoder, out, len, scratch, FRAME_SCRATCH_LEN, &untouched));
    TEST_ASSERT_EQUAL(77, untouched.width);
}

static void test_common_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x02);
    check_header_refused(TSR_ERR_VERSION, 0, 0x00);
    check_header_refused(TSR_ERR_VERSION, 0, 0x21);
    check_header_refused(TSR_ERR_FORMAT, 2, 0);
    check_header_refused(TSR_ERR_FORMAT, 3, 3);
    check_header_refused(TSR_ERR_FORMAT, 4, 0);
    check_header_refused(TSR_ERR_FORMAT, 5, 2);
}

static void test_decode_refuses(void)
{
    struct FRAME(info) read = {.width = 77};
    const size_t len = encode(), room = FRAME_SCRATCH_LEN;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_DECODE_START(NULL, out, len, scratch, room, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_DECODE_START(&decoder, NULL, len, scratch, room, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_DECODE_START(&decoder, out, len, NULL, room, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME_DECODE_START(&decoder, out, len, scratch, room, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, FRAME_DECODE_START(&decoder, out, len, scratch, room - 1, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, FRAME_DECODE_START(&decoder, out, 5, scratch, room, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(read_info)(NULL, len, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(read_info)(out, len, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, FRAME(read_info)(out, 5, &read));
    TEST_ASSERT_EQUAL(77, read.width);
}

static void test_decode_rows_refuses(void)
{
    static uint8_t expected[FRAME_PIXELS];
    const size_t len = encode();
    (void)decode(len);
    memcpy(expected, decoded, sizeof decoded);
    memset(decoded, 0x5a, sizeof decoded);
    struct FRAME(info) read;
    TEST_ASSERT_EQUAL(TSR_OK, FRAME_DECODE_START(&decoder, out, len, scratch, FRAME_SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(decode_rows)(NULL, decoded, FRAME_WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, FRAME(decode_rows)(&decoder, NULL, FRAME_WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, FRAME(decode_rows)(&decoder, decoded, FRAME_WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, FRAME(decode_rows)(&decoder, decoded, FRAME_WIDTH, FRAME_HEIGHT + 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, decoded, sizeof decoded);
    uint8_t *last_row = decoded + (FRAME_HEIGHT - 1) * FRAME_WIDTH;
    TEST_ASSERT_EQUAL(TSR_AGAIN, FRAME(decode_rows)(&decoder, decoded, FRAME_WIDTH, FRAME_HEIGHT - 1));
    TEST_ASSERT_EQUAL(TSR_OK, FRAME(decode_rows)(&decoder, last_row, FRAME_WIDTH, 1));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, FRAME(decode_rows)(&decoder, decoded, FRAME_WIDTH, 1));
}

#define FRAME_RUN_CONTRACT()                                                                                           \
    do {                                                                                                               \
        RUN_TEST(test_start_refuses_bad_sizes);                                                                        \
        RUN_TEST(test_start_refuses);                                                                                  \
        RUN_TEST(test_refused_rows_change_nothing);                                                                    \
        RUN_TEST(test_every_smaller_buffer);                                                                           \
        RUN_TEST(test_common_header_refused);                                                                          \
        RUN_TEST(test_decode_refuses);                                                                                 \
        RUN_TEST(test_decode_rows_refuses);                                                                            \
    } while (0)

#endif
