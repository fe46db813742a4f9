/*
 * Prefiltered-view codec: header bytes, every status, capacities, what errors
 * leave untouched, what is held when.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/codec/view.h"

#define FRAME_WIDTH 21
#define FRAME_HEIGHT 13
#define FRAME_HEADER_LEN TSR_VIEW_HEADER_LEN_MAX
#define FRAME_OUT_CAP TSR_VIEW_ENCODED_LEN_MAX(FRAME_WIDTH, FRAME_HEIGHT)
#define FRAME_SCRATCH_LEN TSR_VIEW_SCRATCH_LEN(FRAME_WIDTH)
#define HELD_LEN TSR_VIEW_HELD_LEN(FRAME_WIDTH, FRAME_HEIGHT)

static struct tsr_view_held wing, lead;
static uint8_t wing_packed[HELD_LEN], lead_packed[HELD_LEN];
static uint8_t tiles[TSR_VIEW_TILE_COUNT(FRAME_WIDTH, FRAME_HEIGHT)];

#define FRAME(name) tsr_view_##name
#define FRAME_ENCODE_START(encoder, info, out, out_cap, scratch, scratch_cap)                                          \
    tsr_view_encode_start(encoder, info, &wing, tiles, out, out_cap, scratch, scratch_cap)
#define FRAME_DECODE_START(decoder, bytes, len, scratch, scratch_cap, info)                                            \
    tsr_view_decode_start(decoder, bytes, len, &lead, scratch, scratch_cap, info)
#include "codec_frame.h"

void setUp(void)
{
    info = (struct tsr_view_info){.width = FRAME_WIDTH, .height = FRAME_HEIGHT, .cap = 7, .coarse = true};
    wing = (struct tsr_view_held){.packed = wing_packed, .packed_cap = HELD_LEN};
    lead = (struct tsr_view_held){.packed = lead_packed, .packed_cap = HELD_LEN};
    for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
        const unsigned x = i % FRAME_WIDTH, y = i / FRAME_WIDTH;
        image[i] = (uint8_t)(x < 8 ? (x * y + x / 3) % 15 : 7 + (x + y) % 3);
    }
    frame_set_up();
    memset(tiles, 1, sizeof tiles);
}
void tearDown(void) {}

static enum tsr_status start_decoding(size_t len)
{
    struct tsr_view_info read;
    return tsr_view_decode_start(&decoder, out, len, &lead, scratch, FRAME_SCRATCH_LEN, &read);
}

static void expect_same_held(void)
{
    TEST_ASSERT_TRUE(wing.full && lead.full);
    TEST_ASSERT_EQUAL_HEX16(wing.check, lead.check);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(wing_packed, lead_packed, HELD_LEN);
    for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
        const unsigned packed = lead_packed[i / FRAME_WIDTH * ((FRAME_WIDTH + 1) / 2) + i % FRAME_WIDTH / 2];
        TEST_ASSERT_EQUAL(decoded[i], packed >> 4 * (i % FRAME_WIDTH % 2) & 15);
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
            (void)decode(encode());
            for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
                const uint8_t cut = image[i] < 2 * cap ? image[i] : (uint8_t)(2 * cap);
                TEST_ASSERT_EQUAL(coarse != 0 ? coarse_of(image[i]) : cut, decoded[i]);
            }
            expect_same_held();
        }
    }
}

static void test_header_bytes(void)
{
    const uint8_t first[6] = {0x01, 0x1f, FRAME_WIDTH, 0, FRAME_HEIGHT, 0};
    (void)encode();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(first, out, sizeof first);
    const uint8_t next[8] = {0x11, 0x1f, FRAME_WIDTH, 0, FRAME_HEIGHT, 0, wing.check & 0xff, wing.check >> 8};
    info.against_held = true;
    (void)encode();
    TEST_ASSERT_EQUAL_HEX8_ARRAY(next, out, sizeof next);
    info = (struct tsr_view_info){.width = FRAME_WIDTH, .height = FRAME_HEIGHT, .cap = 3};
    (void)encode();
    TEST_ASSERT_EQUAL_HEX8(0x03, out[1]);
}

static void test_tiles_of_the_held_view_are_kept(void)
{
    (void)decode(encode());
    static uint8_t before[FRAME_WIDTH * FRAME_HEIGHT];
    memcpy(before, decoded, sizeof before);
    for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
        image[i] = (uint8_t)(14 - image[i]);
        tiles[i / FRAME_WIDTH / 8 * 3 + i % FRAME_WIDTH / 8] = (i % FRAME_WIDTH / 8 + i / FRAME_WIDTH / 8) % 2 == 0;
    }
    info.against_held = true;
    (void)decode(encode());
    for (unsigned i = 0; i < FRAME_WIDTH * FRAME_HEIGHT; i++) {
        const bool coded = tiles[i / FRAME_WIDTH / 8 * 3 + i % FRAME_WIDTH / 8] != 0;
        TEST_ASSERT_EQUAL(coded ? coarse_of(image[i]) : before[i], decoded[i]);
    }
    expect_same_held();
}

static void test_only_against_what_is_held(void)
{
    (void)decode(encode());
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
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF,
                      tsr_view_decode_start(&decoder, out, len, NULL, scratch, FRAME_SCRATCH_LEN, &read));
    lead.full = true;
    TEST_ASSERT_EQUAL(TSR_OK, start_decoding(len));
    TEST_ASSERT_FALSE(lead.full);
    wing.full = false;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, start(FRAME_OUT_CAP));
}

static void test_nothing_held(void)
{
    size_t len = 0;
    struct tsr_view_info read;
    TEST_ASSERT_EQUAL(
        TSR_OK, tsr_view_encode_start(&encoder, &info, NULL, NULL, out, FRAME_OUT_CAP, scratch, FRAME_SCRATCH_LEN));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_rows(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_encode_finish(&encoder, &len));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_start(&decoder, out, len, NULL, scratch, FRAME_SCRATCH_LEN, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_rows(&decoder, decoded, FRAME_WIDTH, FRAME_HEIGHT));
    TEST_ASSERT_EQUAL(coarse_of(image[FRAME_WIDTH + 3]), decoded[FRAME_WIDTH + 3]);
    info.against_held = true;
    TEST_ASSERT_EQUAL(TSR_ERR_NOREF, tsr_view_encode_start(&encoder, &info, NULL, tiles, out, FRAME_OUT_CAP, scratch,
                                                           FRAME_SCRATCH_LEN));
}

static void test_start_refuses_bad_info(void)
{
    info.cap = 6; /* not coarse then */
    check_bad_info();
    info.coarse = false;
    info.cap = TSR_VIEW_CAP_MAX + 1;
    check_bad_info();
    info.cap = 0;
    check_bad_info();
}

static void test_start_refuses_what_is_held(void)
{
    wing.packed_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start(FRAME_OUT_CAP));
    wing.packed_cap++;
    wing.packed = NULL;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, start(FRAME_OUT_CAP));
    wing.packed = wing_packed;
    info.against_held = true;
    TEST_ASSERT_EQUAL(TSR_ERR_ARG, tsr_view_encode_start(&encoder, &info, &wing, NULL, out, FRAME_OUT_CAP, scratch,
                                                         FRAME_SCRATCH_LEN));
    TEST_ASSERT_EACH_EQUAL_HEX8(0xa5, out, sizeof out);
    info.against_held = false;
    const size_t len = encode();
    lead.packed_cap--;
    TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, start_decoding(len));
}

/* Nothing is held from _start until the last row, and if the view is lost. */
static void test_held_only_when_complete(void)
{
    const size_t len = encode();
    TEST_ASSERT_TRUE(wing.full);
    TEST_ASSERT_EQUAL(TSR_OK, start(FRAME_OUT_CAP));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_view_encode_rows(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT - 1));
    TEST_ASSERT_FALSE(wing.full);
    TEST_ASSERT_EQUAL(TSR_OK, start_decoding(len));
    TEST_ASSERT_EQUAL(TSR_AGAIN, tsr_view_decode_rows(&decoder, decoded, FRAME_WIDTH, FRAME_HEIGHT - 1));
    TEST_ASSERT_FALSE(lead.full);
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_decode_rows(&decoder, decoded, FRAME_WIDTH, 1));
    TEST_ASSERT_TRUE(lead.full);
    for (size_t cap = TSR_VIEW_HEADER_LEN_MAX; cap < len; cap++) {
        size_t untouched = 77;
        TEST_ASSERT_EQUAL(TSR_OK, start(cap));
        (void)tsr_view_encode_rows(&encoder, image, FRAME_WIDTH, FRAME_HEIGHT);
        TEST_ASSERT_EQUAL(TSR_ERR_NOBUF, tsr_view_encode_finish(&encoder, &untouched));
        TEST_ASSERT_FALSE(wing.full);
    }
}

static void test_header_refused(void)
{
    check_header_refused(TSR_ERR_VERSION, 1, 0x0f);
    check_header_refused(TSR_ERR_VERSION, 1, 0x17);
    check_header_refused(TSR_ERR_VERSION, 1, 0x2f);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x1e);
    check_header_refused(TSR_ERR_FORMAT, 1, 0x00);
    struct tsr_view_info read;
    info.against_held = true;
    (void)encode();
    TEST_ASSERT_EQUAL(TSR_ERR_FORMAT, tsr_view_read_info(out, TSR_VIEW_HEADER_LEN_MAX - 1, &read));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_view_read_info(out, TSR_VIEW_HEADER_LEN_MAX, &read));
    TEST_ASSERT_TRUE(read.against_held);
}

int main(void)
{
    UNITY_BEGIN();
    FRAME_RUN_CONTRACT();
    RUN_TEST(test_exact_and_coarse);
    RUN_TEST(test_header_bytes);
    RUN_TEST(test_tiles_of_the_held_view_are_kept);
    RUN_TEST(test_only_against_what_is_held);
    RUN_TEST(test_nothing_held);
    RUN_TEST(test_start_refuses_bad_info);
    RUN_TEST(test_start_refuses_what_is_held);
    RUN_TEST(test_held_only_when_complete);
    RUN_TEST(test_header_refused);
    return UNITY_END();
}
