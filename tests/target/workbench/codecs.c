/*
 * The codecs, there and back.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/gray.h"
#include "tsr/codec/map.h"
#include "tsr/codec/map_hold.h"
#include "tsr/codec/picture.h"
#include "tsr/codec/view.h"
#include "tsr/vision/prefilter.h"
#include "tsr/vision/quantise.h"
#include "workbench.h"

#define ROWS_PER_STEP 4u
#define STEP_LOG2_WHOLE 4u /* whole pixels, as other codecs are compared */
#define D0_Q4 (-37)
#define GRAY_NEAR 4u
#define PICTURE_STEP 35u /* of the product's reference image */

static struct tsr_gray_encoder gray_encoder;
static struct tsr_gray_decoder gray_decoder;
static struct tsr_picture_encoder picture_encoder;
static struct tsr_picture_decoder picture_decoder;
static struct tsr_map_encoder map_encoder;
static struct tsr_map_decoder map_decoder;
static uint8_t gray_scratch[TSR_GRAY_SCRATCH_LEN(WORKBENCH_WIDTH_MAX)];
static uint8_t picture_scratch[TSR_PICTURE_SCRATCH_LEN(WORKBENCH_WIDTH_MAX)];
static uint16_t map_scratch[TSR_MAP_SCRATCH_COUNT(WORKBENCH_WIDTH_MAX)];
static uint8_t gray_coded[TSR_GRAY_ENCODED_LEN_MAX(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX)];
static uint8_t gray_decoded[WORKBENCH_PIXELS_MAX];
static uint16_t map_decoded[WORKBENCH_PIXELS_MAX];
static uint16_t map_whole[WORKBENCH_PIXELS_MAX];
static struct tsr_view_encoder view_encoder;
static struct tsr_view_decoder view_decoder;
static uint16_t view_scratch[TSR_VIEW_SCRATCH_LEN(WORKBENCH_WIDTH_MAX) / 2u + 1u];
static uint8_t view_filtered[WORKBENCH_PIXELS_MAX];
static uint8_t view_coded[TSR_VIEW_ENCODED_LEN_MAX(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX)];
static uint8_t view_of_lead[WORKBENCH_PIXELS_MAX];
static uint8_t view_tiles[TSR_VIEW_TILE_COUNT(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX)];
static uint8_t view_packed[2][TSR_VIEW_HELD_LEN(WORKBENCH_WIDTH_MAX, WORKBENCH_HEIGHT_MAX)];
static struct tsr_view_held view_held[2] = {{.packed = view_packed[0], .packed_cap = sizeof view_packed[0]},
                                            {.packed = view_packed[1], .packed_cap = sizeof view_packed[1]}};

static size_t encode_gray(const struct workbench_case *bench, const uint8_t *image, uint8_t near, const char *work)
{
    const struct tsr_gray_info info = {bench->width, bench->height, near};
    size_t len = 0;
    workbench_begin();
    enum tsr_status status =
        tsr_gray_encode_start(&gray_encoder, &info, gray_coded, sizeof gray_coded, gray_scratch, sizeof gray_scratch);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status = tsr_gray_encode_rows(&gray_encoder, image + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    if (status == TSR_OK) {
        status = tsr_gray_encode_finish(&gray_encoder, &len);
    }
    workbench_end(work, (size_t)bench->width * bench->height);
    workbench_expect(status == TSR_OK, work);
    return len;
}

static void decode_gray(const struct workbench_case *bench, size_t len, const char *work)
{
    struct tsr_gray_info info;
    workbench_begin();
    enum tsr_status status =
        tsr_gray_decode_start(&gray_decoder, gray_coded, len, gray_scratch, sizeof gray_scratch, &info);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status =
            tsr_gray_decode_rows(&gray_decoder, gray_decoded + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    workbench_end(work, (size_t)bench->width * bench->height);
    workbench_expect(status == TSR_OK, work);
}

void workbench_run_gray(const struct workbench_case *bench, const uint8_t *left, const uint8_t *right)
{
    size_t pixels = (size_t)bench->width * bench->height;
    size_t len = encode_gray(bench, right, 0, "gray_encode_view");
    workbench_store("gray_coded.out", gray_coded, len);
    decode_gray(bench, len, "gray_decode_view");
    workbench_expect(memcmp(gray_decoded, right, pixels) == 0, "a view is lossless");
    workbench_store("gray_decoded.out", gray_decoded, pixels);

    len = encode_gray(bench, left, GRAY_NEAR, "gray_encode_near");
    workbench_store("near_coded.out", gray_coded, len);
    decode_gray(bench, len, "gray_decode_near");
    workbench_store("near_decoded.out", gray_decoded, pixels);
}

void workbench_run_picture(const struct workbench_case *bench, const uint8_t *left)
{
    const size_t pixels = (size_t)bench->width * bench->height;
    struct tsr_picture_info info = {bench->width, bench->height, PICTURE_STEP, TSR_PICTURE_PRIOR_TRAINED};
    size_t len = 0;
    workbench_begin();
    enum tsr_status status = tsr_picture_encode_start(&picture_encoder, &info, 0, gray_coded, sizeof gray_coded,
                                                      picture_scratch, sizeof picture_scratch);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += TSR_PICTURE_BLOCK) {
        status = tsr_picture_encode_rows(&picture_encoder, left + (size_t)row * bench->width, bench->width,
                                         TSR_PICTURE_BLOCK);
    }
    if (status == TSR_OK) {
        status = tsr_picture_encode_finish(&picture_encoder, &len);
    }
    workbench_end("picture_encode", pixels);
    workbench_expect(status == TSR_OK, "picture encode");
    workbench_store("picture_coded.out", gray_coded, len);

    workbench_begin();
    status =
        tsr_picture_decode_start(&picture_decoder, gray_coded, len, picture_scratch, sizeof picture_scratch, &info);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status = tsr_picture_decode_rows(&picture_decoder, gray_decoded + (size_t)row * bench->width, bench->width,
                                         ROWS_PER_STEP);
    }
    workbench_end("picture_decode", pixels);
    workbench_expect(status == TSR_OK, "picture decode");
    workbench_store("picture_decoded.out", gray_decoded, pixels);
}

static void prefilter_view(const struct workbench_case *bench, const uint8_t *right)
{
    struct tsr_gray frame = {view_filtered, bench->width, bench->height, bench->width};
    struct tsr_prefilter filter;
    memcpy(view_filtered, right, (size_t)bench->width * bench->height);
    workbench_begin();
    enum tsr_status status =
        tsr_prefilter_start(&filter, frame, TSR_VIEW_CAP_MAX, (uint8_t *)view_scratch, sizeof view_scratch);
    while (status >= TSR_OK && tsr_prefilter_run(&filter, ROWS_PER_STEP) == TSR_AGAIN) {
    }
    workbench_end("view_prefilter", (size_t)bench->width * bench->height);
    workbench_expect(status == TSR_OK, "view prefilter");
}

static size_t encode_view(const struct workbench_case *bench, const struct tsr_view_info *info, const char *work)
{
    size_t len = 0;
    workbench_begin();
    enum tsr_status status = tsr_view_encode_start(&view_encoder, info, &view_held[0], view_tiles, view_coded,
                                                   sizeof view_coded, (uint8_t *)view_scratch, sizeof view_scratch);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status = tsr_view_encode_rows(&view_encoder, view_filtered + (size_t)row * bench->width, bench->width,
                                      ROWS_PER_STEP);
    }
    if (status == TSR_OK) {
        status = tsr_view_encode_finish(&view_encoder, &len);
    }
    workbench_end(work, (size_t)bench->width * bench->height);
    workbench_expect(status == TSR_OK, work);
    return len;
}

static void decode_view(const struct workbench_case *bench, size_t len, const char *work)
{
    struct tsr_view_info info;
    workbench_begin();
    enum tsr_status status = tsr_view_decode_start(&view_decoder, view_coded, len, &view_held[1],
                                                   (uint8_t *)view_scratch, sizeof view_scratch, &info);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status =
            tsr_view_decode_rows(&view_decoder, gray_decoded + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    workbench_end(work, (size_t)bench->width * bench->height);
    workbench_expect(status == TSR_OK && view_held[0].check == view_held[1].check, work);
}

/* On its own, exact and coarse, then a third of it against what is held: the left view stands for what has changed. */
const uint8_t *workbench_run_view(const struct workbench_case *bench, const uint8_t *left, const uint8_t *right)
{
    size_t pixels = (size_t)bench->width * bench->height;
    struct tsr_view_info info = {.width = bench->width, .height = bench->height, .cap = TSR_VIEW_CAP_MAX};
    prefilter_view(bench, right);
    size_t len = encode_view(bench, &info, "view_encode_exact");
    decode_view(bench, len, "view_decode_exact");
    workbench_expect(memcmp(gray_decoded, view_filtered, pixels) == 0, "an exact view is lossless");
    workbench_store("view_exact.out", view_coded, len);
    info.coarse = true;
    len = encode_view(bench, &info, "view_encode");
    workbench_store("view_coded.out", view_coded, len);
    decode_view(bench, len, "view_decode");
    memcpy(view_of_lead, gray_decoded, pixels);

    prefilter_view(bench, left);
    info.against_held = true;
    workbench_begin();
    struct tsr_view_change change = {.tiles = view_tiles, .tiles_cap = sizeof view_tiles};
    enum tsr_status status = tsr_view_compare(&view_held[0], view_filtered, bench->width, 0, bench->height, &change);
    change.stronger = change.weaker = 0; /* tiles are to be kept */
    (void)tsr_view_choose(&change, TSR_VIEW_TILE_COUNT(bench->width, bench->height), 0);
    workbench_end("view_compare", pixels);
    workbench_expect(status == TSR_OK, "view compare");
    len = encode_view(bench, &info, "view_encode_next");
    workbench_store("view_next.out", view_coded, len);
    decode_view(bench, len, "view_decode_next");
    workbench_store("view_decoded.out", gray_decoded, pixels);
    return view_of_lead;
}

/* There and back at a step, against the reference if there is one; the coded map stays in coded. */
static size_t code_map(const struct workbench_case *bench, const uint16_t *map, uint8_t step_log2,
                       const struct tsr_map_reference *reference, const char *encode, const char *decode,
                       uint8_t *coded, size_t coded_cap)
{
    size_t pixels = (size_t)bench->width * bench->height;
    const size_t scratch_count = sizeof map_scratch / sizeof map_scratch[0];
    struct tsr_map_info info = {.width = bench->width,
                                .height = bench->height,
                                .disparities = bench->disparities,
                                .step_log2 = step_log2,
                                .d0_q4 = D0_Q4};
    size_t len = 0;
    workbench_begin();
    enum tsr_status status =
        reference != NULL
            ? tsr_map_encode_start_against(&map_encoder, &info, reference, coded, coded_cap, map_scratch, scratch_count)
            : tsr_map_encode_start(&map_encoder, &info, coded, coded_cap, map_scratch, scratch_count);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status = tsr_map_encode_rows(&map_encoder, map + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    if (status == TSR_OK) {
        status = tsr_map_encode_finish(&map_encoder, &len);
    }
    workbench_end(encode, pixels);
    workbench_expect(status == TSR_OK, encode);

    workbench_begin();
    status = tsr_map_decode_start(&map_decoder, coded, len, reference, map_scratch, scratch_count, &info);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status =
            tsr_map_decode_rows(&map_decoder, map_decoded + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    workbench_end(decode, pixels);
    workbench_expect(status == TSR_OK && memcmp(map_decoded, map, pixels * sizeof *map) == 0, decode);
    return len;
}

/* A later map, in which a sixteenth of the view came nearer: held to the earlier one, and coded against it. */
static void run_later_map(const struct workbench_case *bench, const uint16_t *map, uint8_t *coded, size_t coded_cap)
{
    const size_t pixels = (size_t)bench->width * bench->height;
    const struct tsr_map_info info = {.width = bench->width, .height = bench->height};
    const struct tsr_map_reference earlier = {map, bench->width, 1};
    uint16_t *later = map_whole;
    memcpy(later, map, pixels * sizeof *map);
    for (unsigned y = bench->height / 4u; y < bench->height / 2u; y++) {
        for (unsigned x = bench->width / 4u; x < bench->width / 2u; x++) {
            later[y * bench->width + x] = (uint16_t)((bench->disparities - 2u) * TSR_DISPARITY_ONE_Q4);
        }
    }
    workbench_begin();
    const enum tsr_status status = tsr_map_hold(&info, &earlier, later, bench->width, map_scratch,
                                                sizeof map_scratch / sizeof map_scratch[0], NULL);
    workbench_end("map_hold", pixels);
    workbench_expect(status == TSR_OK, "map_hold");
    const size_t len =
        code_map(bench, later, WORKBENCH_STEP_LOG2, &earlier, "map_encode_later", "map_decode_later", coded, coded_cap);
    workbench_store("map_later.out", coded, len);
}

size_t workbench_run_map(const struct workbench_case *bench, const uint16_t *map, uint8_t *coded, size_t coded_cap)
{
    size_t pixels = (size_t)bench->width * bench->height;
    memcpy(map_whole, map, pixels * sizeof *map);
    workbench_expect(tsr_quantise(map_whole, pixels, STEP_LOG2_WHOLE, bench->disparities) == TSR_OK, "quantise");
    (void)code_map(bench, map_whole, STEP_LOG2_WHOLE, NULL, "map_encode_whole", "map_decode_whole", coded, coded_cap);

    run_later_map(bench, map, coded, coded_cap);

    size_t len = code_map(bench, map, WORKBENCH_STEP_LOG2, NULL, "map_encode", "map_decode", coded, coded_cap);
    workbench_store("map_coded.out", coded, len);
    workbench_store("map_decoded.out", map_decoded, pixels * sizeof *map);
    return len;
}
