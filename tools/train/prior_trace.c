/*
 * Record what the contexts of a codec are asked, and fit the prior that would
 * have coded it in the fewest bits. tools/train/picture_prior.py and packet_prior.py build
 * this with the codec, whose tsr_range_encode_bit is renamed to prior_trace_bit.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <math.h>
#include <stdlib.h>

#include "tsr/codec/gray_packet.h"
#include "tsr/codec/picture.h"
#include "tsr/codec/view_packet.h"

#define P_CANDIDATES 11
#define COUNT_CANDIDATES 16

static struct tsr_picture_encoder encoder;
static struct tsr_picture_decoder decoder;
static uint8_t scratch[TSR_PICTURE_SCRATCH_LEN(TSR_IMAGE_WIDTH_MAX)];
static uint8_t coded[TSR_PICTURE_ENCODED_LEN_MAX(TSR_IMAGE_WIDTH_MAX, TSR_IMAGE_HEIGHT_MAX)];
static uint32_t *asked; /* 2 * context + bit */
static size_t asked_cap, asked_count;
static const struct tsr_range_bit *contexts_asked;

/* What these contexts are asked goes to trace from now on. */
void prior_trace_start(const struct tsr_range_bit *contexts, uint32_t *trace, size_t trace_cap)
{
    contexts_asked = contexts;
    asked = trace;
    asked_cap = trace_cap;
    asked_count = 0;
}

const struct tsr_range_bit *prior_trace_gray_contexts(const struct tsr_gray_packet_encoder *packets)
{
    return packets->state.model.contexts;
}

const struct tsr_range_bit *prior_trace_view_contexts(const struct tsr_view_packet_encoder *packets)
{
    return packets->state.model.contexts;
}

size_t prior_trace_count(void)
{
    return asked_count;
}

void prior_trace_bit(struct tsr_range_encoder *range, struct tsr_range_bit *context, unsigned bit)
{
    if (asked_count < asked_cap) {
        asked[asked_count++] = 2u * (uint32_t)(context - contexts_asked) + bit;
    }
    tsr_range_encode_bit(range, context, bit);
}

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
    *trace_count = asked_count;
    return len;
}

/* Bits that streams cost with this prior: bits[begins[s] .. begins[s + 1]) is stream s, which starts anew. */
static double cost_of(uint16_t prior, const uint8_t *bits, const size_t *begins, size_t stream_count, double limit)
{
    double cost = 0;
    uint8_t sink[8];
    for (size_t s = 0; s < stream_count && cost < limit; s++) {
        struct tsr_range_bit context;
        tsr_range_bits_load(&context, &prior, 1);
        for (size_t i = begins[s]; i < begins[s + 1]; i++) {
            struct tsr_range_encoder range;
            const double one = context.p_one_q16 / 65536.0;
            cost -= log2(bits[i] != 0 ? one : 1 - one);
            tsr_range_encode_start(&range, sink, sizeof sink);
            tsr_range_encode_bit(&range, &context, bits[i]); /* for what the context learns */
        }
    }
    return cost;
}

/* The best prior of one context, and its cost in bits. */
uint16_t prior_fit(const uint8_t *bits, const size_t *begins, size_t stream_count, double *cost)
{
    const size_t count = begins[stream_count] - begins[0];
    size_t ones = 0;
    for (size_t i = begins[0]; i < begins[stream_count]; i++) {
        ones += bits[i];
    }
    const double mean = ((double)ones + 0.4) / ((double)count + 0.8);
    uint16_t best = 0x8000;
    *cost = HUGE_VAL;
    for (int i = 0; i < P_CANDIDATES; i++) {
        const double odds = log(mean / (1 - mean)) + 0.25 * (i - P_CANDIDATES / 2);
        const double p_q12 = floor(4096 / (1 + exp(-odds)) + 0.5);
        const unsigned kept_q12 = p_q12 < 8 ? 8u : p_q12 > 4088 ? 4088u : (unsigned)p_q12;
        for (unsigned j = 0; j < COUNT_CANDIDATES; j++) {
            const uint16_t tried = (uint16_t)(kept_q12 << 4 | j);
            const double spent = cost_of(tried, bits, begins, stream_count, *cost);
            if (spent < *cost) {
                *cost = spent;
                best = tried;
            }
        }
    }
    return best;
}
