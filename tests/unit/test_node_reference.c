/*
 * The reference image: the left view as the picture codec has it, before matching.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "fake_node.h"
#include "unity.h"

#define WAITS_MAX 20000u

static struct tsr_node_config config;
static struct fake_node fake;

void setUp(void)
{
    memset(&fake, 0, sizeof fake);
    config = fake_config(TSR_ROLE_BINOCULAR);
}
void tearDown(void)
{
    fake_node_stop(&fake);
}

/* Go on until the node comes to a phase. */
static void reach(enum tsr_node_phase phase)
{
    for (unsigned i = 0; i < WAITS_MAX && tsr_node_get_phase(&fake.node) != phase; i++) {
        (void)fake_node_run(&fake, 1);
        fake.now_us += 200;
        tsr_node_on_timer(&fake.node, fake.now_us);
        fake_node_transmitted(&fake, TSR_RADIO_ACKED);
        fake_camera_finish(&fake, false, TSR_OK);
        fake_camera_finish(&fake, true, TSR_OK);
    }
    TEST_ASSERT_EQUAL_STRING(tsr_phase_name(phase), tsr_phase_name(tsr_node_get_phase(&fake.node)));
}

static void start_and_reach(enum tsr_node_phase phase)
{
    TEST_ASSERT_EQUAL(TSR_OK, fake_node_start(&fake, &config));
    reach(phase);
}

/* The left view as one call codes it. */
static size_t code_left_view(uint8_t *coded, size_t cap)
{
    static struct tsr_picture_encoder encoder;
    static uint8_t scratch[TSR_PICTURE_SCRATCH_LEN(FAKE_WIDTH)];
    const struct tsr_gray view = tsr_match_pair_left(fake.node.pair, &config.match);
    const struct tsr_picture_info info = {FAKE_WIDTH, FAKE_HEIGHT, config.reference_step, TSR_PICTURE_PRIOR_TRAINED};
    size_t len = 0;
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_start(&encoder, &info, 0, coded, cap, scratch, sizeof scratch));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_rows(&encoder, view.pixels, view.stride, FAKE_HEIGHT));
    TEST_ASSERT_EQUAL(TSR_OK, tsr_picture_encode_finish(&encoder, &len));
    return len;
}

/* Whole bands a step, whatever the quantum; the bytes do not depend on it. */
static void test_coded_in_bands(void)
{
    const struct {
        uint8_t rows_per_step;
        uint32_t rows;
    } quanta[] = {{0, 8}, {1, 8}, {8, 8}, {9, 16}, {255, FAKE_HEIGHT}};
    for (unsigned i = 0; i < sizeof quanta / sizeof quanta[0]; i++) {
        static uint8_t coded[TSR_PICTURE_ENCODED_LEN_MAX(FAKE_WIDTH, FAKE_HEIGHT)];
        config.rows_per_step = quanta[i].rows_per_step;
        start_and_reach(TSR_PHASE_REFERENCE);
        const size_t len = code_left_view(coded, sizeof coded);
        for (uint32_t left = FAKE_HEIGHT; left > 0;) {
            const uint32_t rows = left < quanta[i].rows ? left : quanta[i].rows;
            const struct tsr_node_outcome outcome = tsr_node_step(&fake.node, fake.now_us);
            TEST_ASSERT_EQUAL(TSR_WORK_REFERENCE_ENCODE, outcome.work);
            TEST_ASSERT_EQUAL(rows * FAKE_WIDTH, outcome.units);
            left -= rows;
        }
        TEST_ASSERT_EQUAL(TSR_PHASE_MATCHING, tsr_node_get_phase(&fake.node));
        TEST_ASSERT_EQUAL(len, fake.node.reference_len);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(coded, fake.node.message + TSR_MESSAGE_HEADER_LEN + TSR_BODY_MAP_HEADER_LEN, len);
        TEST_ASSERT_EQUAL(0, fake.node.counters.references_omitted);
        fake_node_stop(&fake);
    }
}

static void test_none(void)
{
    config.reference_step = TSR_REFERENCE_NONE;
    start_and_reach(TSR_PHASE_MATCHING);
    TEST_ASSERT_EQUAL(0, fake.node.reference_len);
    reach(TSR_PHASE_SENDING);
    TEST_ASSERT_EQUAL(0, fake.node.counters.references_omitted);
}

/* A map of noise has its room and no more: it goes alone. */
static void test_no_room_for_both(void)
{
    config.change.width = config.match.width = config.similarity.width = 160;
    config.change.height = config.match.height = config.similarity.height = 120;
    config.match.uniqueness_percent = config.match.texture_min = config.match.lr_tolerance_px = TSR_MATCH_TEST_OFF;
    config.reference_step = 0;
    start_and_reach(TSR_PHASE_SENDING);
    TEST_ASSERT_EQUAL(0, fake.node.reference_len);
    TEST_ASSERT_EQUAL(1, fake.node.counters.references_omitted);
    TEST_ASSERT_EQUAL(0, fake.node.counters.maps_lost);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_coded_in_bands);
    RUN_TEST(test_none);
    RUN_TEST(test_no_room_for_both);
    return UNITY_END();
}
