/*
 * Prefiltered coarse views coded for their questions, by tools/train/view_prior.py.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stdbool.h>

#include "prior_trace.h"
#include "tsr/codec/view.h"
#include "tsr/vision/prefilter.h"

static struct tsr_view_encoder encoder;
static uint8_t scratch[TSR_VIEW_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];
static uint8_t coded[TSR_VIEW_ENCODED_LEN_MAX(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)];
static uint8_t packed[TSR_VIEW_HELD_LEN(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)];
static uint8_t tiles[TSR_VIEW_TILE_COUNT(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)];
static struct tsr_view_held held = {.packed = packed, .packed_cap = sizeof packed};

static bool prefilter(uint8_t *gray, uint16_t width, uint16_t height)
{
    static uint16_t rows[TSR_PREFILTER_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX) / sizeof(uint16_t)];
    struct tsr_prefilter filter;
    const struct tsr_gray frame = {gray, width, height, width};
    return tsr_prefilter_start(&filter, frame, TSR_VIEW_CAP_MAX, (uint8_t *)rows, sizeof rows) == TSR_OK &&
           tsr_prefilter_run(&filter, height) == TSR_OK;
}

/* Which tiles a wing would code. */
static bool choose(const uint8_t *filtered, uint16_t width, uint16_t height)
{
    struct tsr_view_change change = {.tiles = tiles, .tiles_cap = sizeof tiles};
    if (tsr_view_compare(&held, filtered, width, 0, height, &change) != TSR_OK) {
        return false;
    }
    (void)tsr_view_choose(&change, TSR_VIEW_TILE_COUNT(width, height), 0);
    return true;
}

/*
 * Prefilter a gray view in place and code it coarsely, on its own or, if it is the next one, against the view of the
 * call before; what was asked goes to trace. Returns its length, 0 if the codec refuses.
 */
size_t prior_trace_view(uint8_t *gray, unsigned width, unsigned height, bool is_next, uint32_t *trace, size_t trace_cap,
                        size_t *trace_count)
{
    const struct tsr_view_info info = {(uint16_t)width, (uint16_t)height, TSR_VIEW_CAP_MAX, .coarse = true,
                                       .against_held = is_next};
    size_t len = 0;
    prior_trace_start(encoder.model.contexts, trace, trace_cap);
    if (!prefilter(gray, info.width, info.height) || (is_next && !choose(gray, info.width, info.height)) ||
        tsr_view_encode_start(&encoder, &info, &held, is_next ? tiles : NULL, coded, sizeof coded, scratch,
                              sizeof scratch) != TSR_OK ||
        tsr_view_encode_rows(&encoder, gray, width, info.height) != TSR_OK ||
        tsr_view_encode_finish(&encoder, &len) != TSR_OK) {
        return 0;
    }
    *trace_count = prior_trace_count();
    return len;
}
