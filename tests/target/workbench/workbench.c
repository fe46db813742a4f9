/*
 * Change detection, matching, median, comparison and copy.
 *
 * Stages run in the quanta in which the node runs them, so that the cost of
 * resuming is counted.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "workbench.h"

#include <string.h>

#include "tsr/codec/map.h"
#include "tsr/vision/change.h"
#include "tsr/vision/match.h"
#include "tsr/vision/median.h"
#include "tsr/vision/quantise.h"
#include "tsr/vision/similarity.h"
#include "tsr/vision/zone.h"

#define ROWS_PER_STEP 4u /* ROWS_PER_STEP_DEFAULT of the node */
#define SETTLE_FRAMES 4u /* of change detection, its default */
#define REDUCTION 4u
/* More than any mode of the matcher asks for. */
#define SCRATCH_LEN (WORKBENCH_WIDTH_MAX * (8u * TSR_DISPARITY_COUNT_MAX + 64u))

static uint8_t before[WORKBENCH_PIXELS_MAX];
static uint8_t left[WORKBENCH_PIXELS_MAX];
static uint8_t right[WORKBENCH_PIXELS_MAX];
static _Alignas(8) uint8_t pair[TSR_MATCH_PAIR_LEN(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX, TSR_MATCH_WINDOW_MAX)];
static _Alignas(8) uint8_t scratch[SCRATCH_LEN];
static uint8_t change_state[TSR_CHANGE_STATE_LEN(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX, REDUCTION)];
static uint16_t last_map[WORKBENCH_PIXELS_MAX];
static uint8_t coded[TSR_MAP_ENCODED_LEN_MAX(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX, TSR_DISPARITY_COUNT_MAX, 0)];

static void run_change(const struct workbench_case *bench, size_t pixels)
{
    const struct tsr_change_config config = {.width = bench->width, .height = bench->height, .reduction = REDUCTION};
    const struct tsr_gray_view background = {before, bench->width, bench->height, bench->width};
    const struct tsr_gray_view frame = {left, bench->width, bench->height, bench->width};
    struct tsr_change change;
    struct tsr_change_result result;
    workbench_expect(tsr_change_init(&change, &config, change_state, sizeof change_state) == TSR_OK, "change init");
    for (unsigned i = 0; i < SETTLE_FRAMES; i++) {
        workbench_expect(tsr_change_update(&change, &background, &result) == TSR_OK, "change settle");
    }
    workbench_begin();
    workbench_expect(tsr_change_update(&change, &background, &result) == TSR_OK, "change update");
    workbench_end("change_still", pixels);
    workbench_begin();
    workbench_expect(tsr_change_update(&change, &frame, &result) == TSR_OK, "change update");
    workbench_end("change_moved", pixels);
    workbench_begin();
    workbench_expect(tsr_change_rebase(&change, &frame) == TSR_OK, "change rebase");
    workbench_end("change_rebase", pixels);
    const uint8_t found[3] = {result.changed ? 1 : 0, (uint8_t)(result.changed_cells & 0xffu),
                              (uint8_t)(result.changed_cells >> 8)};
    workbench_store("change_result.out", found, sizeof found);
    workbench_store("change_state.out", change_state, tsr_change_state_len(&config));
}

static void place_view(struct tsr_gray place, const uint8_t *view)
{
    for (size_t y = 0; y < place.height; y++) {
        memcpy(place.pixels + y * place.stride, view + y * place.width, place.width);
    }
}

/* The map stands in pair then. */
static void match_pair(const struct workbench_case *bench, size_t pixels, uint8_t mode, const char *work,
                       const char *out)
{
    const struct tsr_match_config config = {
        .width = bench->width, .height = bench->height, .disparities = bench->disparities, .mode = mode};
    struct tsr_gray left_view = tsr_match_pair_left(pair, &config);
    struct tsr_gray right_view = tsr_match_pair_right(pair, &config);
    place_view(left_view, left);
    place_view(right_view, right);
    uint16_t *map = tsr_match_pair_map(pair);
    struct tsr_match match;
    enum tsr_status status;
    workbench_begin();
    status = tsr_match_start(&match, &config, left_view, right_view, map, pixels, scratch, sizeof scratch);
    workbench_expect(status == TSR_OK, "match start");
    do {
        status = tsr_match_run(&match, ROWS_PER_STEP);
    } while (status == TSR_AGAIN);
    workbench_end(work, (size_t)tsr_match_rows_total(&match) * bench->width * bench->disparities);
    workbench_expect(status == TSR_OK, "match");
    workbench_store(out, map, pixels * sizeof *map);
}

static void run_match(const struct workbench_case *bench, size_t pixels)
{
    uint16_t *map = tsr_match_pair_map(pair);
    match_pair(bench, pixels, TSR_MATCH_SAD, "match", "match.out");
    workbench_run_refinements(bench, map);

    struct tsr_median median;
    enum tsr_status status;
    workbench_begin();
    status = tsr_median_start(&median, bench->width, bench->height, map, pixels, scratch, sizeof scratch);
    workbench_expect(status == TSR_OK, "median start");
    do {
        status = tsr_median_run(&median, ROWS_PER_STEP);
    } while (status == TSR_AGAIN);
    workbench_end("median", pixels);
    workbench_expect(status == TSR_OK, "median");
    workbench_store("median.out", map, pixels * sizeof *map);
}

/* The whole map as a zone: a surface visits it three times. */
static void run_zone(const struct workbench_case *bench)
{
    static struct tsr_zone zone;
    const struct tsr_zone_config config = {.part = {0, 0, bench->width, bench->height}, .kind = TSR_ZONE_SURFACE};
    enum tsr_status status;
    workbench_begin();
    status = tsr_zone_start(&zone, &config, tsr_match_pair_map(pair), bench->width, bench->height);
    workbench_expect(status == TSR_OK, "zone start");
    do {
        status = tsr_zone_run(&zone, ROWS_PER_STEP);
    } while (status == TSR_AGAIN);
    struct tsr_zone_result result = tsr_zone_get_result(&zone);
    workbench_end("zone", (size_t)tsr_zone_rows_done(&zone) * bench->width);
    workbench_expect(status == TSR_OK, "zone");
    const uint32_t found[3] = {result.valid, result.counted, result.disparity_q8};
    workbench_store("zone.out", found, sizeof found);
}

static void run_other_modes(const struct workbench_case *bench, size_t pixels)
{
    match_pair(bench, pixels, TSR_MATCH_SAD8, "match_sad8", "match_sad8.out");
    match_pair(bench, pixels, TSR_MATCH_CENSUS, "match_census", "match_census.out");
    match_pair(bench, pixels, TSR_MATCH_SMOOTH, "match_smooth", "match_smooth.out");
    match_pair(bench, pixels, TSR_MATCH_RAW, "match_raw", "match_raw.out");
    match_pair(bench, pixels, TSR_MATCH_SSD, "match_ssd", "match_ssd.out");
}

/* The node charges a map's pixels once for quantising and once for comparing. */
static void run_compare(const struct workbench_case *bench, size_t pixels)
{
    uint16_t *map = tsr_match_pair_map(pair);
    workbench_begin();
    for (unsigned row = 0; row < bench->height; row += ROWS_PER_STEP) {
        enum tsr_status status = tsr_quantise(map + (size_t)row * bench->width, (size_t)ROWS_PER_STEP * bench->width,
                                              WORKBENCH_STEP_LOG2, bench->disparities);
        workbench_expect(status == TSR_OK, "quantise");
    }
    workbench_end("quantise", pixels);
    workbench_store("quantise.out", map, pixels * sizeof *map);

    workbench_begin();
    memcpy(last_map, map, pixels * sizeof *map);
    workbench_end("copy", pixels * sizeof *map);
    for (size_t i = 0; i < pixels; i++) { /* another map of the same scene: one row down, one step nearer */
        uint16_t value = map[i >= bench->width ? i - bench->width : i];
        last_map[i] = value == TSR_DISPARITY_INVALID ? value : (uint16_t)(value + (1u << WORKBENCH_STEP_LOG2));
    }

    const struct tsr_similarity_config config = {.width = bench->width, .height = bench->height};
    struct tsr_similarity similarity;
    struct tsr_similarity_result result;
    enum tsr_status status;
    workbench_begin();
    status = tsr_similarity_start(&similarity, &config, map, last_map, pixels);
    workbench_expect(status == TSR_OK, "similarity start");
    do {
        status = tsr_similarity_run(&similarity, ROWS_PER_STEP);
    } while (status == TSR_AGAIN);
    workbench_end("similarity", pixels);
    workbench_expect(status == TSR_OK && tsr_similarity_get_result(&similarity, &result) == TSR_OK, "similarity");
    const uint32_t found[5] = {tsr_similarity_mse_q8(&result), result.both_count, result.one_count, result.blocks,
                               result.different_blocks};
    workbench_store("similarity.out", found, sizeof found);
}

/* The map that a lead makes of its wing's view, as the sink gets it. */
static void run_lead(const struct workbench_case *bench, size_t pixels, const uint8_t *seen)
{
    const struct tsr_match_config config = {.width = bench->width,
                                            .height = bench->height,
                                            .disparities = bench->disparities,
                                            .right_is_prefiltered = true};
    struct tsr_gray left_view = tsr_match_pair_left(pair, &config);
    struct tsr_gray right_view = tsr_match_pair_right(pair, &config);
    place_view(left_view, left);
    place_view(right_view, seen);
    uint16_t *map = tsr_match_pair_map(pair);
    struct tsr_match match;
    struct tsr_median median;
    workbench_expect(
        tsr_match_start(&match, &config, left_view, right_view, map, pixels, scratch, sizeof scratch) == TSR_OK &&
            tsr_match_run(&match, UINT16_MAX) == TSR_OK &&
            tsr_median_start(&median, bench->width, bench->height, map, pixels, scratch, sizeof scratch) == TSR_OK &&
            tsr_median_run(&median, UINT16_MAX) == TSR_OK &&
            tsr_quantise(map, pixels, WORKBENCH_STEP_LOG2, bench->disparities) == TSR_OK,
        "a lead's map");
    workbench_store("lead_map.out", map, pixels * sizeof *map);
}

void workbench_run(const struct workbench_case *bench)
{
    size_t pixels = (size_t)bench->width * bench->height;
    workbench_expect(bench->width <= WORKBENCH_WIDTH_MAX && bench->height <= WORKBENCH_HEIGHT_MAX &&
                         bench->height % ROWS_PER_STEP == 0,
                     "width or height");
    workbench_load("before.gray", before, pixels);
    workbench_load("left.gray", left, pixels);
    workbench_load("right.gray", right, pixels);
    run_change(bench, pixels);
    workbench_run_gray(bench, left, right);
    const uint8_t *seen = workbench_run_view(bench, left, right);
    workbench_run_picture(bench, left);
    workbench_run_rectify(bench, left);
    run_match(bench, pixels);
    run_zone(bench);
    run_compare(bench, pixels);
    size_t coded_len = workbench_run_map(bench, tsr_match_pair_map(pair), coded, sizeof coded);
    workbench_run_seals(coded, coded_len);
    run_other_modes(bench, pixels);
    run_lead(bench, pixels, seen);
    workbench_store_work();
}
