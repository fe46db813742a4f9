/*
 * Pictures coded for their questions, by tools/train/picture_prior.py.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "prior_trace.h"
#include "tsr/codec/picture.h"

static struct tsr_picture_encoder encoder;
static struct tsr_picture_decoder decoder;
static uint8_t scratch[TSR_PICTURE_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];
static uint8_t coded[TSR_PICTURE_ENCODED_LEN_MAX(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)];

/* Code a picture and decode it in place; what was asked goes to trace. Returns its length, 0 if the codec refuses. */
size_t prior_trace_picture(uint8_t *pixels, unsigned width, unsigned height, unsigned step, unsigned prior,
                           uint32_t *trace, size_t trace_cap, size_t *trace_count)
{
    struct tsr_picture_info info = {(uint16_t)width, (uint16_t)height, (uint8_t)step, (uint8_t)prior};
    size_t len = 0;
    prior_trace_start(encoder.model.contexts, trace, trace_cap);
    if (tsr_picture_encode_start(&encoder, &info, 0, coded, sizeof coded, scratch, sizeof scratch) != TSR_OK ||
        tsr_picture_encode_rows(&encoder, pixels, width, (uint16_t)height) != TSR_OK ||
        tsr_picture_encode_finish(&encoder, &len) != TSR_OK ||
        tsr_picture_decode_start(&decoder, coded, len, scratch, sizeof scratch, &info) != TSR_OK ||
        tsr_picture_decode_rows(&decoder, pixels, width, (uint16_t)height) != TSR_OK) {
        return 0;
    }
    *trace_count = prior_trace_count();
    return len;
}
