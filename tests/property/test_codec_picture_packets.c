/*
 * Pictures in packets: each decodes alone and in any order to the same blocks, which are close to the picture; what is
 * lost loses its own blocks and no others; no packet outgrows its size, whatever the picture holds; the filter leaves
 * what has not come and does what the codec of whole pictures does.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "codec_content.h"
#include "tsr/codec/picture_packet.h"

#define PACKETS(name) tsr_picture_##name
#define PACKETS_MARKS_LEN(width, height) TSR_PICTURE_MARKS_LEN(width, height)
#define PACKETS_MISSING(info, marks) tsr_picture_packets_missing(info, marks)
#define PACKETS_UNITS(info) ((uint32_t)TSR_PICTURE_MARKS_LEN((info)->width, (info)->height))
#define PACKETS_HAVE(info, marks, x, y) (marks[(y) / 8u * TSR_PICTURE_BLOCKS((info)->width) + (x) / 8u] != 0)
#include "codec_packets_property.h"

static struct tsr_picture_info draw_info(struct codec_random *random)
{
    return (struct tsr_picture_info){.width = (uint16_t)(1 + codec_random_below(random, PACKETS_WIDTH_MAX)),
                                     .height = (uint16_t)(1 + codec_random_below(random, PACKETS_HEIGHT_MAX)),
                                     .step = (uint8_t)codec_random_below(random, TSR_PICTURE_STEP_MAX + 1),
                                     .prior = TSR_PICTURE_PRIOR_TRAINED};
}

static uint8_t draw_pixel(struct codec_random *random, unsigned content, unsigned x, unsigned y)
{
    return pick(random, (enum content)(content % CONTENT_COUNT), x, y);
}

/* What comes in order; test_fine_pictures judges it. */
static unsigned expect(const struct tsr_picture_info *info, size_t stride, uint8_t id, unsigned count)
{
    receive_nothing();
    for (unsigned i = 0; i < count; i++) {
        (void)receive(info, stride, id, i);
    }
    memcpy(expected, decoded, sizeof expected);
    return 0;
}

/* With the finest step a smooth picture comes back nearly as it was. */
static void test_fine_pictures(void)
{
    for (unsigned shape = 0; shape < 40; shape++) {
        const struct tsr_picture_info info = {.width = (uint16_t)(1 + 7 * shape % 90),
                                              .height = (uint16_t)(1 + 11 * shape % 70),
                                              .step = 0,
                                              .prior = TSR_PICTURE_PRIOR_TRAINED};
        for (unsigned i = 0; i < (unsigned)info.width * info.height; i++) {
            image[i] = (uint8_t)(40 + i % info.width + i / info.width * 2);
        }
        (void)expect(&info, info.width, 1, send_all(&info, info.width, PACKETS_CAP_MAX, 1));
        for (unsigned i = 0; i < (unsigned)info.width * info.height; i++) {
            TEST_ASSERT_INT_WITHIN(3, image[i], decoded[i]);
        }
    }
}

/* One packet holds all blocks of a small picture of one strip, which so are those of the codec of whole pictures. */
static void test_same_as_whole_pictures(void)
{
    static struct tsr_picture_encoder whole;
    static struct tsr_picture_decoder back;
    static uint8_t bytes[TSR_PICTURE_ENCODED_LEN_MAX(32, 40)], scratch[TSR_PICTURE_SCRATCH_LEN(32)];
    static uint8_t smoothed[32 * 40], wanted[32 * 40];
    struct tsr_picture_info info = {.width = 29, .height = 37, .step = 36, .prior = TSR_PICTURE_PRIOR_TRAINED}, read;
    struct codec_random random = codec_random_of_seed(5);
    const size_t w = info.width;
    size_t len = 0;
    for (unsigned i = 0; i < w * info.height; i++) {
        image[i] = (uint8_t)(i * i / 700 + codec_random_below(&random, 9));
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_start(&whole, &info, 0, bytes, sizeof bytes, scratch, sizeof scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_rows(&whole, image, w, info.height));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&whole, &len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_start(&back, bytes, len, scratch, sizeof scratch, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_decode_rows(&back, wanted, w, info.height));
    TEST_ASSERT_EQUAL(1, send_all(&info, w, PACKETS_CAP_MAX, 0));
    (void)expect(&info, w, 0, 1);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_packets_smooth(&info, decoded, w, marks, smoothed, w));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wanted, smoothed, w * info.height);
}

int main(int argc, char **argv)
{
    program = argc > 0 ? argv[0] : "";
    UNITY_BEGIN();
    RUN_TEST(test_random_images);
    RUN_TEST(test_damaged_packets);
    RUN_TEST(test_fine_pictures);
    RUN_TEST(test_same_as_whole_pictures);
    return UNITY_END();
}
