/*
 * One side of a range coder: the model is written once and runs in both
 * directions, so encoder and decoder cannot disagree.
 *
 * Every question takes the bit that the encoder knows and returns the bit that
 * was coded; a decoder ignores the argument.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_RANGE_PORT_H
#define TSR_CODEC_RANGE_PORT_H

#include <stdbool.h>

#include "tsr/codec/range.h"

/* A magnitude's contexts: 13 choose one of 14 buckets, 10 its half. */
#define TSR_MAGNITUDE_BUCKET_LAST 13u
#define TSR_MAGNITUDE_CONTEXT_COUNT (TSR_MAGNITUDE_BUCKET_LAST + 10u)
#define TSR_MAGNITUDE_MAX 2049u
#define TSR_MAGNITUDE_SINGLES 4u

/* Exactly one of the two is not null. */
struct tsr_range_port {
    struct tsr_range_encoder *encoder;
    struct tsr_range_decoder *decoder;
};

static inline bool tsr_port_bit(const struct tsr_range_port *port, struct tsr_range_bit *context, bool bit)
{
    if (port->encoder != NULL) {
        tsr_range_encode_bit(port->encoder, context, bit);
        return bit;
    }
    return tsr_range_decode_bit(port->decoder, context) != 0;
}

static inline uint32_t tsr_port_direct(const struct tsr_range_port *port, uint32_t value, unsigned bit_count)
{
    if (port->encoder != NULL) {
        tsr_range_encode_direct(port->encoder, value, bit_count);
        return value;
    }
    return tsr_range_decode_direct(port->decoder, bit_count);
}

/* Bits shifted out so far: the same number on both sides at the same pixel. */
static inline size_t tsr_port_spent_bits(const struct tsr_range_port *port)
{
    return 8u * (port->encoder != NULL ? port->encoder->at : port->decoder->at);
}

/* -1, 0, +1 as 0, 1, 2: where a neighbour lies seen from the prediction. */
static inline unsigned tsr_side_of(unsigned neighbour, unsigned predicted)
{
    return 1u + (neighbour > predicted) - (neighbour < predicted);
}

/* The median of W, N and W + N - NW: LOCO-I's edge-detecting prediction. */
static inline uint16_t tsr_median_prediction(uint16_t w, uint16_t n, uint16_t nw)
{
    const uint16_t high = w > n ? w : n;
    const uint16_t low = w > n ? n : w;
    return nw >= high ? low : nw <= low ? high : (uint16_t)(w + n - nw);
}

/* The bucket of a magnitude: the first TSR_MAGNITUDE_SINGLES hold one each, then 2, 4, 8 ... */
static inline unsigned tsr_magnitude_bucket(uint32_t magnitude)
{
    unsigned bucket = magnitude < TSR_MAGNITUDE_SINGLES ? magnitude : TSR_MAGNITUDE_SINGLES;
    while (bucket >= TSR_MAGNITUDE_SINGLES && bucket < TSR_MAGNITUDE_BUCKET_LAST &&
           (magnitude - 2u) >> (bucket - 2u) != 0) {
        bucket++;
    }
    return bucket;
}

/* Code 0 <= magnitude <= TSR_MAGNITUDE_MAX: the bucket in unary, then the place in it. */
uint32_t tsr_port_magnitude(const struct tsr_range_port *port,
                            struct tsr_range_bit contexts[TSR_MAGNITUDE_CONTEXT_COUNT], uint32_t magnitude);

#endif
