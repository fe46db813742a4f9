/*
 * Steps of the range coder that are short enough to be everywhere: raising and
 * shifting out, and the contexts of a fixed rate, docs/codec.md, 1.6.
 *
 * The map codec's contexts start from a trained prior, so they need no count of
 * bits seen: one uint16_t each, P(1) in UQ0.16.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_RANGE_INLINE_H
#define TSR_CODEC_RANGE_INLINE_H

#include <stdbool.h>

#include "tsr/codec/range.h"

#define TSR_RANGE_RENORMALISE_BELOW (1u << 24)

/* The context forgets within about 2^shift bits. */
static inline void tsr_fixed_learn(uint16_t *context, bool bit, unsigned shift)
{
    const uint32_t p = *context;
    *context = (uint16_t)(bit ? p + ((65536u - p) >> shift) : p - (p >> shift));
}

/* low += amount; a carry goes into the bytes before it. The number stays below
 * 1, so a carry always meets a byte that is not 0xff, unless bytes beyond cap
 * are missing from the chain: then the stream is lost anyway. */
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

static inline void tsr_encoder_shift_out(struct tsr_range_encoder *encoder)
{
    if (encoder->at < encoder->cap) {
        encoder->out[encoder->at] = (uint8_t)(encoder->low >> 24);
    }
    encoder->at++;
    encoder->low <<= 8;
}

static inline void tsr_encoder_renormalise(struct tsr_range_encoder *encoder)
{
    while (encoder->range < TSR_RANGE_RENORMALISE_BELOW) {
        tsr_encoder_shift_out(encoder);
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

static inline void tsr_encode_direct(struct tsr_range_encoder *encoder, uint32_t value, unsigned bit_count)
{
    encoder->range >>= bit_count;
    tsr_encoder_raise(encoder, encoder->range * value);
    tsr_encoder_renormalise(encoder);
}

/* at counts what the encoder has shifted out; the decoder has read 4 bytes more. Zeros follow the end. */
static inline uint32_t tsr_decoder_byte(const struct tsr_range_decoder *decoder, size_t ahead)
{
    const size_t i = decoder->at + ahead;
    return i < decoder->len ? decoder->bytes[i] : 0u;
}

static inline void tsr_decoder_renormalise(struct tsr_range_decoder *decoder)
{
    while (decoder->range < TSR_RANGE_RENORMALISE_BELOW) {
        decoder->offset = decoder->offset << 8 | tsr_decoder_byte(decoder, 4);
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
