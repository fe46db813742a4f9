/*
 * Adaptive binary range coder: bits in, bytes out, and back, bit-exactly.
 *
 * The coder keeps an interval [low, low + range) of 32-bit precision. A bit
 * with p = P(bit = 1) in UQ0.16 takes the lower part of
 *
 *   bound = (range >> 16) * p
 *
 * when it is 1 and the rest when it is 0; whenever range < 2^24 one byte is
 * shifted out and both grow by 2^8 (G. N. N. Martin, 1979; the renormalisation
 * of LZMA). Carries are added to the bytes already written. docs/codec.md,
 * chapter 1, has every bit. No byte outside the buffers is read or written, no
 * division, no product wider than 32 bits.
 *
 * Each context is one tsr_range_bit, which learns its probability: first
 * quickly, then slowly (docs/codec.md, 1.2). Encoder and decoder must start
 * from the same contexts and make the same calls in the same order.
 *
 * Out and in buffers are *kept* until _finish, or until the decoder is no
 * longer used. Not thread-safe; one coder is one stream.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_RANGE_H
#define TSR_CODEC_RANGE_H

#include <stddef.h>
#include <stdint.h>

#include "tsr/base/status.h"

/* _direct takes 1 .. 16 bits a call. */
#define TSR_RANGE_DIRECT_COUNT_MAX 16
/* Bytes _finish may add. */
#define TSR_RANGE_FINISH_LEN_MAX 4

/* One adaptive probability. */
struct tsr_range_bit {
    uint16_t p_one_q16; /* P(bit = 1), UQ0.16 */
    uint16_t count;     /* bits seen, saturating: selects the learning rate */
};

struct tsr_range_encoder {
    uint8_t *out;
    size_t cap;
    size_t at; /* bytes shifted out so far; > cap once the buffer has overflowed */
    uint32_t low;
    uint32_t range;
};

struct tsr_range_decoder {
    const uint8_t *bytes;
    size_t len;
    size_t at;       /* bytes shifted out so far, equal to the encoder's at the same bit */
    uint32_t offset; /* code value - low */
    uint32_t range;
};

/* Forget what count contexts have learned: P = 1/2. */
void tsr_range_bits_reset(struct tsr_range_bit *bits, size_t count);

/*
 * Start count contexts from what was learned before.
 *
 *   prior   [count], bits 15..4 P(1) in 1/4096, never 0; bits 3..0 the index of the count of bits seen in
 *           {0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 33, 40, 48, 54, 60}: how firmly the prior is held
 */
void tsr_range_bits_load(struct tsr_range_bit *bits, const uint16_t *prior, size_t count);

/* Start a stream in out[cap]; cap may be 0. */
void tsr_range_encode_start(struct tsr_range_encoder *encoder, uint8_t *out, size_t cap);

/* Code one bit (0 or 1) and let its context learn. An overflow is remembered, not returned. */
void tsr_range_encode_bit(struct tsr_range_encoder *encoder, struct tsr_range_bit *context, unsigned bit);

/* Code the low bit_count bits of value, 1..16, as equally likely. Costs bit_count bits. */
void tsr_range_encode_direct(struct tsr_range_encoder *encoder, uint32_t value, unsigned bit_count);

/*
 * End the stream with the fewest bytes that decode, given that the decoder
 * reads zeros beyond the end; trailing zero bytes are dropped.
 *
 * Returns TSR_OK and the stream's length in *len, or TSR_ERR_NOBUF if the
 * stream did not fit; then *len is untouched and out[0..cap) is garbage.
 */
enum tsr_status tsr_range_encode_finish(struct tsr_range_encoder *encoder, size_t *len);

/* Start decoding; any bytes are accepted, len may be 0. */
void tsr_range_decode_start(struct tsr_range_decoder *decoder, const uint8_t *bytes, size_t len);

unsigned tsr_range_decode_bit(struct tsr_range_decoder *decoder, struct tsr_range_bit *context);

uint32_t tsr_range_decode_direct(struct tsr_range_decoder *decoder, unsigned bit_count);

#endif
