/*
 * The range coder for contexts of a fixed rate, in registers.
 *
 * The map codec's contexts start from a trained prior, so they need no count of
 * bits seen (docs/codec.md, 1.6): one uint16_t each, P(1) in UQ0.16. A side is
 * one direction of one stream, taken from the coder's struct before a row and
 * put back after it; everything is inline, and a constant direction leaves one
 * direction's code.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_RANGE_FIXED_H
#define TSR_CODEC_RANGE_FIXED_H

#include <stdbool.h>

#include "tsr/codec/range.h"

#define TSR_RANGE_RENORMALISE_BELOW (1u << 24)

/* The context forgets within about 2^shift bits. */
static inline void tsr_fixed_learn(uint16_t *context, bool bit, unsigned shift)
{
    const uint32_t p = *context;
    *context = (uint16_t)(bit ? p + ((65536u - p) >> shift) : p - (p >> shift));
}

/* low += amount; a carry goes into the bytes before it, unless they are beyond the buffer. */
static inline void tsr_encoder_raise(struct tsr_range_encoder *encoder, uint32_t amount)
{
    encoder->low += amount;
    if (encoder->low < amount && encoder->at <= encoder->cap) {
        size_t i = encoder->at;
        while (i > 0 && ++encoder->out[i - 1] == 0) {
            i--;
        }
    }
}

static inline void tsr_encoder_renormalise(struct tsr_range_encoder *encoder)
{
    while (encoder->range < TSR_RANGE_RENORMALISE_BELOW) {
        if (encoder->at < encoder->cap) {
            encoder->out[encoder->at] = (uint8_t)(encoder->low >> 24);
        }
        encoder->at++;
        encoder->low <<= 8;
        encoder->range <<= 8;
    }
}

static inline void tsr_fixed_encode(struct tsr_range_encoder *encoder, uint16_t *context, bool bit, unsigned shift)
{
    const uint32_t bound = (encoder->range >> 16) * *context;
    tsr_fixed_learn(context, bit, shift);
    if (bit) {
        encoder->range = bound;
    } else {
        tsr_encoder_raise(encoder, bound);
        encoder->range -= bound;
    }
    tsr_encoder_renormalise(encoder);
}

static inline void tsr_fixed_encode_direct(struct tsr_range_encoder *encoder, uint32_t value, unsigned bit_count)
{
    encoder->range >>= bit_count;
    tsr_encoder_raise(encoder, encoder->range * value);
    tsr_encoder_renormalise(encoder);
}

static inline void tsr_decoder_renormalise(struct tsr_range_decoder *decoder)
{
    while (decoder->range < TSR_RANGE_RENORMALISE_BELOW) {
        const size_t i = decoder->at + 4u;
        decoder->offset = decoder->offset << 8 | (i < decoder->len ? decoder->bytes[i] : 0u);
        decoder->at++;
        decoder->range <<= 8;
    }
}

static inline bool tsr_fixed_decode(struct tsr_range_decoder *decoder, uint16_t *context, unsigned shift)
{
    const uint32_t bound = (decoder->range >> 16) * *context;
    const bool bit = decoder->offset < bound;
    tsr_fixed_learn(context, bit, shift);
    if (bit) {
        decoder->range = bound;
    } else {
        decoder->offset -= bound;
        decoder->range -= bound;
    }
    tsr_decoder_renormalise(decoder);
    return bit;
}

#endif
