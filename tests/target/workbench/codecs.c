/*
 * The three codecs, there and back.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "tsr/codec/gray.h"
#include "tsr/codec/map.h"
#include "tsr/codec/picture.h"
#include "workbench.h"

#define ROWS_PER_STEP 4u
#define STEP_LOG2 2u
#define D0_Q4 (-37)
#define REFERENCE_NEAR 4u
#define PICTURE_STEP 34u

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
    workbench_store("view_coded.out", gray_coded, len);
    decode_gray(bench, len, "gray_decode_view");
    workbench_expect(memcmp(gray_decoded, right, pixels) == 0, "a view is lossless");
    workbench_store("view_decoded.out", gray_decoded, pixels);

    len = encode_gray(bench, left, REFERENCE_NEAR, "gray_encode_reference");
    workbench_store("reference_coded.out", gray_coded, len);
    decode_gray(bench, len, "gray_decode_reference");
    workbench_store("reference_decoded.out", gray_decoded, pixels);
}

void workbench_run_picture(const struct workbench_case *bench, const uint8_t *left)
{
    const size_t pixels = (size_t)bench->width * bench->height;
    struct tsr_picture_info info = {bench->width, bench->height, PICTURE_STEP, TSR_PICTURE_PRIOR_TRAINED};
    size_t len = 0;
    workbench_begin();
    enum tsr_status status = tsr_picture_encode_start(&picture_encoder, &info, 0, gray_coded, sizeof gray_coded,
                                                      picture_scratch, sizeof picture_scratch);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status =
            tsr_picture_encode_rows(&picture_encoder, left + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
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

size_t workbench_run_map(const struct workbench_case *bench, const uint16_t *map, uint8_t *coded, size_t coded_cap)
{
    size_t pixels = (size_t)bench->width * bench->height;
    const size_t scratch_count = sizeof map_scratch / sizeof map_scratch[0];
    struct tsr_map_info info = {bench->width, bench->height, bench->disparities, STEP_LOG2, D0_Q4};
    size_t len = 0;
    workbench_begin();
    enum tsr_status status = tsr_map_encode_start(&map_encoder, &info, coded, coded_cap, map_scratch, scratch_count);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status = tsr_map_encode_rows(&map_encoder, map + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    if (status == TSR_OK) {
        status = tsr_map_encode_finish(&map_encoder, &len);
    }
    workbench_end("map_encode", pixels);
    workbench_expect(status == TSR_OK, "map encode");
    workbench_store("map_coded.out", coded, len);

    workbench_begin();
    status = tsr_map_decode_start(&map_decoder, coded, len, map_scratch, scratch_count, &info);
    for (unsigned row = 0; row < bench->height && status >= TSR_OK; row += ROWS_PER_STEP) {
        status =
            tsr_map_decode_rows(&map_decoder, map_decoded + (size_t)row * bench->width, bench->width, ROWS_PER_STEP);
    }
    workbench_end("map_decode", pixels);
    workbench_expect(status == TSR_OK && memcmp(map_decoded, map, pixels * sizeof *map) == 0, "map decode");
    workbench_store("map_decoded.out", map_decoded, pixels * sizeof *map);
    return len;
}
