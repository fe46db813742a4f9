/*
 * Gray images against a held one: header bytes, every status, capacities, what errors leave untouched, what is held
 * when, which tiles have changed.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/gray_history.h"

#define FRAME_WIDTH 21
#define FRAME_HEIGHT 13
#define FRAME_HEADER_LEN TSR_GRAY_HISTORY_HEADER_LEN_MAX
#define FRAME_OUT_CAP TSR_GRAY_HISTORY_ENCODED_LEN_MAX(FRAME_WIDTH, FRAME_HEIGHT)
#define FRAME_SCRATCH_LEN TSR_GRAY_HISTORY_SCRATCH_LEN(FRAME_WIDTH)
#define HELD_LEN (FRAME_WIDTH * FRAME_HEIGHT)

static struct tsr_gray_held wing, lead;
static uint8_t wing_pixels[HELD_LEN], lead_pixels[HELD_LEN];
static uint8_t tiles[TSR_VIEW_TILE_COUNT(FRAME_WIDTH, FRAME_HEIGHT)];

#define FRAME(name) tsr_gray_history_##name
#define FRAME_ENCODE_START(encoder, info, out, out_cap, scratch, scratch_cap)                                          \
    tsr_gray_history_encode_start(encoder, info, &wing, tiles, out, out_cap, scratch, scratch_cap)
#define FRAME_DECODE_START(decoder, bytes, len, scratch, scratch_cap, info)                                            \
    tsr_gray_history_decode_start(decoder, bytes, len, &lead, scratch, scratch_cap, info)
#include "codec_frame.h"

void setUp(void)
{
    info = (struct tsr_gray_history_info){.width = FRAME_WIDTH, .height = FRAME_HEIGHT};
    wing = (struct tsr_gray_held){.pixels = wing_pixels, .pixels_cap = HELD_LEN};
    lead = (struct tsr_gray_held){.pixels = lead_pixels, .pixels_cap = HELD_LEN};
    for (unsigned i = 0; i < FRAME_PIXELS; i++) {
        const unsigned x = i % FRAME_WIDTH, y = i / FRAME_WIDTH;
        image[i] = (uint8_t)(x < 8 ? 250 + (x * y) % 6 : 10 * y + x * x / 4);
    }
    frame_set_up();
    memset(tiles, 1, sizeof tiles);
}
void tearDown(void) {}

static enum tsr_status start_decoding(size_t len)
{
    struct tsr_gray_history_info read;
    return tsr_gray_history_decode_start(&decoder, out, len, &lead, scratch, FRAME_SCRATCH_LEN, &read);
}

static void expect_same_held(void)
{
    TEST_ASSERT_TRUE(wing.full && lead.full);
    TEST_ASSERT_EQUAL_HEX16(wing.check, lead.check);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wing_pixels, lead_pixels, HELD_LEN);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(decoded, lead_pixels, HELD_LEN);
}

/* An image on its own has the bytes of tsr/codec/gray.h, whose decoder refuses what is against another one. */
static void test_same_as_gray_on_its_own(void)
{
    static struct tsr_gray_encoder gray;
    static uint8_t bytes[TSR_GRAY_ENCODED_LEN_MAX(FRAME_WIDTH, FRAME_HEIGHT)];
    for (uint8_t near = 0; near <= TSR_GRAY_NEAR_BY_ACTIVITY; near++) {
        struct tsr_gray_info gray_info = {FRAME_WIDTH, FRAME_HEIGHT, near};
        size_t len = 0;
        info.near = near;
        info.against_held = false;
        TEST_ASSERT_EQUAL(TSR_OK,
                          tsr_gray_encode_start(&gray, &gray_info, bytes, sizeof bytes, scratch, FRAME_SCRATCH_LEN));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_rows(&gray, image, FRAME_WIDTH, FRAME_HEIGHT));
        TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_encode_finish(&gray, &len));
        TEST_ASSERT_EQUAL(len, encode());
        TEST_ASSERT_EQUAL_HEX8_ARRAY(bytes, out, len);
        TEST_ASSERT_EQUAL(near, decode(len).near);
        expect_same_held();
        info.against_held = true;
        TEST_ASSERT_EQUAL(TSR_ERR_VERSION, tsr_gray_read_info(out, encode(), &gray_info));
    }
}

static void test_header_bytes(void)
{
    info.near = 3;
    (void)encode();
    const uint8_t next[8] = {0x11, 0x03, FRAME_WIDTH, 0, FRAME_HEIGHT, 0, wing.check & 0xff, wing.check >> 8};
    info.against_held = true;
    const size_t len = encode();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(next, out, sizeof next);
    struct tsr_gray_history_info read;
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_gray_history_read_info(out, 7, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_read_info(out, len, &read));
    TEST_ASSERT_TRUE(read.against_held);
}

static void test_tiles_of_the_held_image_are_kept(void)
{
    (void)decode(encode());
    static uint8_t before[FRAME_PIXELS];
    memcpy(before, decoded, sizeof before);
    for (unsigned i = 0; i < FRAME_PIXELS; i++) {
        image[i] = (uint8_t)~image[i];
        tiles[i / FRAME_WIDTH / 8 * 3 + i % FRAME_WIDTH / 8] = (i % FRAME_WIDTH / 8 + i / FRAME_WIDTH / 8) % 2 == 0;
    }
    info.against_held = true;
    (void)decode(encode());
    for (unsigned i = 0; i < FRAME_PIXELS; i++) {
        const bool coded = tiles[i / FRAME_WIDTH / 8 * 3 + i % FRAME_WIDTH / 8] != 0;
        TEST_ASSERT_EQUAL(coded ? image[i] : before[i], decoded[i]);
    }
    expect_same_held();
}

static void test_only_against_what_is_held(void)
{
    (void)decode(encode());
    info.against_held = true;
    const size_t len = encode();
    lead.check ^= 1u;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    TEST_ASSERT_TRUE(lead.full);
    lead.check ^= 1u;
    lead.width--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.width++;
    lead.height--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.height++;
    lead.full = false;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.full = true;
    lead.pixels_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start_decoding(len));
    lead.pixels_cap++;
    TEST_ASSERT_EQUAL(TSR_OK, start_decoding(len));
    TEST_ASSERT_FALSE(lead.full);
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_gray_history_decode_rows(&decoder, decoded, FRAME_WIDTH, FRAME_HEIGHT - 1));
    TEST_ASSERT_FALSE(lead.full);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_decode_rows(&decoder, decoded, FRAME_WIDTH, 1));
    TEST_ASSERT_TRUE(lead.full);
}

static void test_start_refuses_what_is_held(void)
{
    info.against_held = true;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start(FRAME_OUT_CAP));
    wing = (struct tsr_gray_held){
        .pixels = wing_pixels, .pixels_cap = HELD_LEN, .width = FRAME_WIDTH, .height = FRAME_HEIGHT, .full = true};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_history_encode_start(&encoder, &info, &wing, NULL, out, FRAME_OUT_CAP,
                                                                 scratch, FRAME_SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_history_encode_start(&encoder, &info, NULL, tiles, out, FRAME_OUT_CAP,
                                                                 scratch, FRAME_SCRATCH_LEN));
    wing.pixels_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(FRAME_OUT_CAP));
    wing.pixels_cap++;
    wing.pixels = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(FRAME_OUT_CAP));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
}

static void test_lost_images_are_not_held(void)
{
    const size_t len = encode();
    for (size_t cap = FRAME_HEADER_LEN; cap < len; cap++) {
        size_t untouched = 77;
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        (void)tsr_gray_history_encode_rows(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT);
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_gray_history_encode_finish(&encoder, &untouched));
        TEST_ASSERT_FALSE(wing.full);
    }
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 1, 0x10);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x09);
    info.near = TSR_GRAY_NEAR_BY_ACTIVITY + 1;
    frame_set_up();
    check_bad_info();
}

static void test_compare(void)
{
    uint8_t excess[sizeof tiles];
    struct tsr_view_change change = {.tiles = excess, .tiles_cap = sizeof excess};
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_gray_history_compare(&wing, image, FRAME_WIDTH, 0, FRAME_HEIGHT, &change));
    (void)encode();
    image[3] = (uint8_t)(image[3] - 60);                                      /* tile 0: 59 beyond, .9 a pixel */
    image[9 * FRAME_WIDTH + 17] = (uint8_t)(image[9 * FRAME_WIDTH + 17] + 3); /* tile 5, of 25 pixels: 2 beyond */
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_compare(&wing, image, FRAME_WIDTH, 0, 8, &change));
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_gray_history_compare(&wing, image + 8 * FRAME_WIDTH, FRAME_WIDTH, 8, FRAME_HEIGHT - 8, &change));
    const uint8_t expected[sizeof tiles] = {59, 0, 0, 0, 0, 2 * 64 / 25};
    TEST_ASSERT_EQUAL_UINT8_ARRAY(expected, excess, sizeof excess);
    TEST_ASSERT_EQUAL(5, change.stronger); /* all that did not fall */
    TEST_ASSERT_EQUAL(6, change.weaker);
    TEST_ASSERT_EQUAL(1, tsr_view_choose(&change, sizeof excess, 20));
    TEST_ASSERT_EQUAL(1, excess[0]);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_history_compare(&wing, image, FRAME_WIDTH - 1, 0, 8, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_history_compare(&wing, image, FRAME_WIDTH, 4, 8, &change));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_gray_history_compare(&wing, image, FRAME_WIDTH, 8, 6, &change));
    change.tiles_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_gray_history_compare(&wing, image, FRAME_WIDTH, 0, 8, &change));
}

/* An object changes its own tiles, another light changes all. */
static void test_light_and_object(void)
{
    static uint8_t held_pixels[64 * 64], fresh[64 * 64], changed[64];
    const struct tsr_gray_held held = {
        .pixels = held_pixels, .pixels_cap = sizeof held_pixels, .width = 64, .height = 64, .full = true};
    struct tsr_view_change change = {.tiles = changed, .tiles_cap = sizeof changed};
    for (unsigned i = 0; i < sizeof fresh; i++) {
        held_pixels[i] = (uint8_t)(i * 7 % 200);
        fresh[i] = (uint8_t)(held_pixels[i] + (i % 64 < 24 && i < 64 * 24 ? 40 : 0)); /* 9 of 64 tiles */
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_compare(&held, fresh, 64, 0, 64, &change));
    TEST_ASSERT_EQUAL(9, tsr_view_choose(&change, sizeof changed, 0));
    for (unsigned i = 0; i < sizeof fresh; i++) {
        fresh[i] = (uint8_t)(held_pixels[i] + 1); /* nothing beyond the noise in any tile */
    }
    TEST_ASSERT_EQUAL(TSR_OK, tsr_gray_history_compare(&held, fresh, 64, 0, 64, &change));
    TEST_ASSERT_EACH_EQUAL_UINT8(0, changed, sizeof changed);
    TEST_ASSERT_EQUAL(64, tsr_view_choose(&change, sizeof changed, 0));
}

int main(void)
{
    UNITY_BEGIN();
    FRAME_RUN_CONTRACT();
    RUN_TEST(test_same_as_gray_on_its_own);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_tiles_of_the_held_image_are_kept);
    RUN_TEST(test_only_against_what_is_held);
    RUN_TEST(test_start_refuses_what_is_held);
    RUN_TEST(test_lost_images_are_not_held);
    RUN_TEST(test_header_refused);
    RUN_TEST(test_compare);
    RUN_TEST(test_light_and_object);
    return UNITY_END();
}
