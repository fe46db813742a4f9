/*
 * Prefiltered-view codec: header bytes, every status, capacities, what errors
 * leave untouched, what is held when.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/view.h"
#include "unity.h"

#define WIDTH 21
#define HEIGHT 13
#define TILES TSR_VIEW_TILE_COUNT(WIDTH, HEIGHT)
#define OUT_CAP TSR_VIEW_ENCODED_LEN_MAX(WIDTH, HEIGHT)
#define SCRATCH_LEN TSR_VIEW_SCRATCH_LEN(WIDTH)
#define HELD_LEN TSR_VIEW_HELD_LEN(WIDTH, HEIGHT)

static struct tsr_view_info info;
static struct tsr_view_encoder encoder;
static struct tsr_view_decoder decoder;
static struct tsr_view_held wing, lead;
static uint8_t wing_packed[HELD_LEN], lead_packed[HELD_LEN];
static uint8_t view[WIDTH * HEIGHT];
static uint8_t decoded[WIDTH * HEIGHT];
static uint8_t tiles[TILES];
static uint8_t scratch[SCRATCH_LEN];
static uint8_t out[OUT_CAP + 16];

void setUp(void)
{
    info = (struct tsr_view_info){.width = WIDTH, .height = HEIGHT, .cap = 7, .coarse = true};
    wing = (struct tsr_view_held){.packed = wing_packed, .packed_cap = HELD_LEN};
    lead = (struct tsr_view_held){.packed = lead_packed, .packed_cap = HELD_LEN};
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const unsigned x = i % WIDTH, y = i / WIDTH;
        view[i] = (uint8_t)(x < 8 ? (x * y + x / 3) % 15 : 7 + (x + y) % 3);
    }
    memset(out, 0xa5, sizeof out);
    memset(decoded, 0x5a, sizeof decoded);
    memset(tiles, 1, sizeof tiles);
}
void tearDown(void) {}

static enum tsr_status start(size_t cap)
{
    return tsr_view_encode_start(&encoder, &info, &wing, tiles, out, cap, scratch, SCRATCH_LEN);
}

static size_t encode(void)
{
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, view, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
    return len;
}

static enum tsr_status start_decoding(size_t len)
{
    struct tsr_view_info read;
    return tsr_view_decode_start(&decoder, out, len, &lead, scratch, SCRATCH_LEN, &read);
}

static void decode(size_t len)
{
    TEST_ASSERT_EQUAL(TSR_OK, start_decoding(len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
}

static void expect_same_held(void)
{
    TEST_ASSERT_TRUE(wing.full && lead.full);
    TEST_ASSERT_EQUAL_HEX16(wing.check, lead.check);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wing_packed, lead_packed, HELD_LEN);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const unsigned packed = lead_packed[i / WIDTH * ((WIDTH + 1) / 2) + i % WIDTH / 2];
        TEST_ASSERT_EQUAL(decoded[i], packed >> 4 * (i % WIDTH % 2) & 15);
    }
}

static uint8_t coarse_of(uint8_t pixel)
{
    static const uint8_t of[15] = {0, 0, 3, 3, 5, 5, 6, 7, 8, 9, 9, 11, 11, 14, 14};
    return of[pixel];
}

static void test_exact_and_coarse(void)
{
    for (uint8_t cap = 1; cap <= TSR_VIEW_CAP_MAX; cap++) {
        for (int coarse = 0; coarse <= (cap == TSR_VIEW_CAP_MAX ? 1 : 0); coarse++) {
            info.cap = cap;
            info.coarse = coarse != 0;
            decode(encode());
            for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
                const uint8_t cut = view[i] < 2 * cap ? view[i] : (uint8_t)(2 * cap);
                TEST_ASSERT_EQUAL(coarse != 0 ? coarse_of(view[i]) : cut, decoded[i]);
            }
            expect_same_held();
        }
    }
}

static void test_header_bytes(void)
{
    const uint8_t first[6] = {0x01, 0x1f, WIDTH, 0, HEIGHT, 0};
    (void)encode();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(first, out, sizeof first);
    const uint8_t next[8] = {0x11, 0x1f, WIDTH, 0, HEIGHT, 0, wing.check & 0xff, wing.check >> 8};
    info.against_held = true;
    (void)encode();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(next, out, sizeof next);
    info = (struct tsr_view_info){.width = WIDTH, .height = HEIGHT, .cap = 3};
    (void)encode();
    TEST_ASSERT_EQUAL_HEX8(0x03, out[1]);
}

static void test_tiles_of_the_held_view_are_kept(void)
{
    decode(encode());
    static uint8_t before[WIDTH * HEIGHT];
    memcpy(before, decoded, sizeof before);
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        view[i] = (uint8_t)(14 - view[i]);
        tiles[i / WIDTH / 8 * 3 + i % WIDTH / 8] = (i % WIDTH / 8 + i / WIDTH / 8) % 2 == 0;
    }
    info.against_held = true;
    decode(encode());
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const bool coded = tiles[i / WIDTH / 8 * 3 + i % WIDTH / 8] != 0;
        TEST_ASSERT_EQUAL(coded ? coarse_of(view[i]) : before[i], decoded[i]);
    }
    expect_same_held();
}

static void test_only_against_what_is_held(void)
{
    decode(encode());
    info.against_held = true;
    const size_t len = encode();
    lead_packed[0] ^= 1u; /* not noticed: the check is of what was decoded */
    lead.check ^= 1u;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    TEST_ASSERT_TRUE(lead.full);
    lead.check ^= 1u;
    lead.info.coarse = false;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.info.coarse = true;
    lead.info.cap = 6;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.info.cap = 7;
    lead.info.width--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.info.width++;
    lead.info.height--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    lead.info.height++;
    lead.full = false;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start_decoding(len));
    struct tsr_view_info read;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, tsr_view_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_LEN, &read));
    lead.full = true;
    TEST_ASSERT_EQUAL(TSR_OK, start_decoding(len));
    TEST_ASSERT_FALSE(lead.full);
    wing.full = false;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start(OUT_CAP));
}

static void test_nothing_held(void)
{
    size_t len = 0;
    struct tsr_view_info read;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_start(&encoder, &info, NULL, NULL, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, view, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_start(&decoder, out, len, NULL, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_rows(&decoder, decoded, WIDTH, HEIGHT));
    TEST_ASSERT_EQUAL(coarse_of(view[WIDTH + 3]), decoded[WIDTH + 3]);
    info.against_held = true;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF,
                      tsr_view_encode_start(&encoder, &info, NULL, tiles, out, OUT_CAP, scratch, SCRATCH_LEN));
}

static void check_bad_info(void)
{
    TEST_ASSERT_EQUAL(0, tsr_view_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(OUT_CAP));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
}

static void test_start_refuses_bad_info(void)
{
    TEST_ASSERT_EQUAL(OUT_CAP, tsr_view_encoded_len_max(&info));
    TEST_ASSERT_EQUAL(0, tsr_view_encoded_len_max(NULL));
    const struct tsr_view_info good = info;
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
    info.cap = 6; /* not coarse then */
    check_bad_info();
    info.coarse = false;
    info.cap = TSR_VIEW_CAP_MAX + 1;
    check_bad_info();
    info.cap = 0;
    check_bad_info();
}

static void test_start_refuses(void)
{
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_view_encode_start(NULL, &info, &wing, tiles, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_view_encode_start(&encoder, NULL, &wing, tiles, out, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_view_encode_start(&encoder, &info, &wing, tiles, NULL, OUT_CAP, scratch, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_view_encode_start(&encoder, &info, &wing, tiles, out, OUT_CAP, NULL, SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF,
                      tsr_view_encode_start(&encoder, &info, &wing, tiles, out, OUT_CAP, scratch, SCRATCH_LEN - 1));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(TSR_VIEW_HEADER_LEN_MAX - 1));
    wing.packed_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(OUT_CAP));
    wing.packed_cap++;
    wing.packed = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(OUT_CAP));
    wing.packed = wing_packed;
    info.against_held = true;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG,
                      tsr_view_encode_start(&encoder, &info, &wing, NULL, out, OUT_CAP, scratch, SCRATCH_LEN));
    info.against_held = false;
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
    TEST_ASSERT_EQUAL(TSR_OK, start(TSR_VIEW_HEADER_LEN_MAX));
}

/* A refused call codes nothing: the same view follows and gives the same bytes. */
static void test_refused_rows_change_nothing(void)
{
    static uint8_t expected[OUT_CAP];
    const size_t expected_len = encode();
    memcpy(expected, out, expected_len);
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, start(OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_view_encode_rows(&encoder, view, WIDTH, 5));
    TEST_ASSERT_FALSE(wing.full);
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_encode_rows(NULL, view, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_encode_rows(&encoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_encode_rows(&encoder, view, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_encode_rows(&encoder, view, WIDTH, HEIGHT - 5 + 1));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_view_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(0, len);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, view + 5 * WIDTH, WIDTH, HEIGHT - 5));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_encode_finish(NULL, &len));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_encode_finish(&encoder, NULL));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(expected_len, len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, out, len);
}

static void test_every_smaller_buffer(void)
{
    const size_t len = encode();
    for (size_t cap = TSR_VIEW_HEADER_LEN_MAX; cap < len; cap++) {
        size_t untouched = 77;
        memset(out, 0xa5, sizeof out);
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        const enum tsr_status rows = tsr_view_encode_rows(&encoder, view, WIDTH, HEIGHT);
        TEST_ASSERT_TRUE(rows == TSR_ERR_NOBUF || rows == TSR_OK);
        if (rows == TSR_ERR_NOBUF) {
            TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_view_encode_rows(&encoder, view, WIDTH, 1));
        }
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_view_encode_finish(&encoder, &untouched));
        TEST_ASSERT_EQUAL(77, untouched);
        TEST_ASSERT_FALSE(wing.full);
        TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out + cap, sizeof out - cap);
    }
}

static void check_header_refused(enum tsr_status expected, unsigned at, uint8_t value)
{
    struct tsr_view_info untouched = {.width = 77};
    const size_t len = encode();
    out[at] = value;
    TEST_ASSERT_EQUAL(expected, tsr_view_read_info(out, len, &untouched));
    TEST_ASSERT_EQUAL(expected, tsr_view_decode_start(&decoder, out, len, &lead, scratch, SCRATCH_LEN, &untouched));
    TEST_ASSERT_EQUAL(77, untouched.width);
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 0, 0x02);
    check_header_refused(TSR_ERR_VERSION, 0, 0x00);
    check_header_refused(TSR_ERR_VERSION, 0, 0x21);
    check_header_refused(TSR_ERR_VERSION, 1, 0x0f);
    check_header_refused(TSR_ERR_VERSION, 1, 0x17);
    check_header_refused(TSR_ERR_VERSION, 1, 0x2f);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x1e);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x00);
    check_header_refused(TSR_ERR_FORMAT, 2, 0);
    check_header_refused(TSR_ERR_FORMAT, 3, 3);
    check_header_refused(TSR_ERR_FORMAT, 4, 0);
    check_header_refused(TSR_ERR_FORMAT, 5, 2);
}

static void test_decode_refuses(void)
{
    struct tsr_view_info read = {.width = 77};
    info.coarse = false;
    size_t len = encode();
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_decode_start(NULL, out, len, &lead, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_decode_start(&decoder, NULL, len, &lead, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_decode_start(&decoder, out, len, &lead, NULL, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_decode_start(&decoder, out, len, &lead, scratch, SCRATCH_LEN, NULL));
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_view_decode_start(&decoder, out, len, &lead, scratch, SCRATCH_LEN - 1, &read));
    lead.packed_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_view_decode_start(&decoder, out, len, &lead, scratch, SCRATCH_LEN, &read));
    lead.packed_cap++;
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_view_decode_start(&decoder, out, 5, &lead, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_read_info(NULL, len, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_read_info(out, len, NULL));
    TEST_ASSERT_EQUAL(77, read.width);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_start(&decoder, out, len, &lead, scratch, SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_decode_rows(NULL, decoded, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_decode_rows(&decoder, NULL, WIDTH, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_decode_rows(&decoder, decoded, WIDTH - 1, 1));
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_decode_rows(&decoder, decoded, WIDTH, HEIGHT + 1));
    TEST_ASSERT_EACH_EQUAL_HEX8(0x5a, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_view_decode_rows(&decoder, decoded, WIDTH, HEIGHT - 1));
    TEST_ASSERT_FALSE(lead.full);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_rows(&decoder, decoded + (HEIGHT - 1) * WIDTH, WIDTH, 1));
    TEST_ASSERT_TRUE(lead.full);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(view, decoded, sizeof decoded);
    TEST_ASSERT_EQUAL(TSR_ERR_SIZE, tsr_view_decode_rows(&decoder, decoded, WIDTH, 1));
    info.against_held = true;
    len = encode();
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_view_read_info(out, TSR_VIEW_HEADER_LEN_MAX - 1, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_read_info(out, TSR_VIEW_HEADER_LEN_MAX, &read));
    TEST_ASSERT_TRUE(read.against_held);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_exact_and_coarse);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_tiles_of_the_held_view_are_kept);
    RUN_TEST(test_only_against_what_is_held);
    RUN_TEST(test_nothing_held);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_start_refuses);
    RUN_TEST(test_refused_rows_change_nothing);
    RUN_TEST(test_every_smaller_buffer);
    RUN_TEST(test_header_refused);
    RUN_TEST(test_decode_refuses);
    return UNITY_END();
}
