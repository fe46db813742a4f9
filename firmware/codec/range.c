/*
 * Adaptive binary range coder.
 *
 * The encoder's low is the lower 32 bits of a number whose upper bytes are
 * already in out: a carry is added there. Such a carry runs over bytes 0xff and
 * leaves zeros, so its cost is constant on average.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "range_inline.h"

#define RANGE_FIRST 0xffffffffu
#define P_HALF_Q16 0x8000u
#define P_MIN_Q16 32u /* 2^-11 */
#define P_MAX_Q16 (65536u - P_MIN_Q16)
#define COUNT_MAX 60u

/* Share of the error learned after n bits: floor(655360 / (10 n + 16)), UQ0.16.
 * 1 / (n + 1.6) is close to the mean of all bits seen; the last entry makes it
 * a window of about 60 bits. */
static const uint16_t rates_q16[COUNT_MAX + 1] = {
    40960, 25206, 18204, 14246, 11702, 9929, 8623, 7620, 6826, 6182, 5649, 5201, 4818, 4488, 4201, 3947,
    3723,  3523,  3343,  3181,  3034,  2899, 2776, 2664, 2560, 2463, 2374, 2291, 2214, 2141, 2073, 2010,
    1950,  1894,  1840,  1790,  1742,  1697, 1654, 1614, 1575, 1538, 1503, 1469, 1437, 1406, 1376, 1348,
    1321,  1295,  1270,  1245,  1222,  1200, 1178, 1157, 1137, 1118, 1099, 1081, 1063};

void tsr_range_bits_reset(struct tsr_range_bit *bits, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        bits[i].p_one_q16 = P_HALF_Q16;
        bits[i].count = 0;
    }
}

void tsr_range_bits_load(struct tsr_range_bit *bits, const uint16_t *prior, size_t count)
{
    static const uint8_t counts[16] = {0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 33, 40, 48, 54, 60};
    for (size_t i = 0; i < count; i++) {
        bits[i].p_one_q16 = prior[i] & 0xfff0u;
        bits[i].count = counts[prior[i] & 15u];
    }
}

static void learn(struct tsr_range_bit *context, unsigned bit)
{
    const uint32_t rate_q16 = rates_q16[context->count];
    const uint32_t p = context->p_one_q16;
    if (bit != 0) {
        context->p_one_q16 = (uint16_t)(p + (((P_MAX_Q16 - p) * rate_q16) >> 16));
    } else {
        context->p_one_q16 = (uint16_t)(p - (((p - P_MIN_Q16) * rate_q16) >> 16));
    }
    if (context->count < COUNT_MAX) {
        context->count++;
    }
}

void tsr_range_encode_start(struct tsr_range_encoder *encoder, uint8_t *out, size_t cap)
{
    encoder->out = out;
    encoder->cap = cap;
    encoder->at = 0;
    encoder->low = 0;
    encoder->range = RANGE_FIRST;
}

void tsr_range_encode_bit(struct tsr_range_encoder *encoder, struct tsr_range_bit *context, unsigned bit)
{
    const uint32_t bound = (encoder->range >> 16) * context->p_one_q16;
    if (bit != 0) {
        encoder->range = bound;
    } else {
        tsr_encoder_raise(encoder, bound);
        encoder->range -= bound;
    }
    learn(context, bit);
    tsr_encoder_renormalise(encoder);
}

void tsr_range_encode_direct(struct tsr_range_encoder *encoder, uint32_t value, unsigned bit_count)
{
    tsr_encode_direct(encoder, value & ((1u << bit_count) - 1u), bit_count);
}

/* The number in [low, low + range) with the most zero bytes at its end becomes the tail. */
enum tsr_status tsr_range_encode_finish(struct tsr_range_encoder *encoder, size_t *len)
{
    unsigned tail_len = 0;
    uint32_t rise = 0;
    for (; tail_len < TSR_RANGE_FINISH_LEN_MAX; tail_len++) {
        const uint32_t below = UINT32_MAX >> (8 * tail_len);
        rise = (below - encoder->low + 1u) & below;
        if (rise < encoder->range) {
            break;
        }
        rise = 0;
    }
    tsr_encoder_raise(encoder, rise);
    for (unsigned i = 0; i < tail_len; i++) {
        tsr_encoder_shift_out(encoder);
    }
    if (encoder->at > encoder->cap) {
        return TSR_ERR_NOBUF;
    }
    while (encoder->at > 0 && encoder->out[encoder->at - 1] == 0) {
        encoder->at--;
    }
    *len = encoder->at;
    return TSR_OK;
}

void tsr_range_decode_start(struct tsr_range_decoder *decoder, const uint8_t *bytes, size_t len)
{
    decoder->bytes = bytes;
    decoder->len = len;
    decoder->at = 0;
    decoder->range = RANGE_FIRST;
    decoder->offset = 0;
    for (size_t i = 0; i < 4; i++) {
        decoder->offset = decoder->offset << 8 | tsr_decoder_byte(decoder, i);
    }
}

unsigned tsr_range_decode_bit(struct tsr_range_decoder *decoder, struct tsr_range_bit *context)
{
    const uint32_t bound = (decoder->range >> 16) * context->p_one_q16;
    const unsigned bit = decoder->offset < bound;
    if (bit != 0) {
        decoder->range = bound;
    } else {
        decoder->offset -= bound;
        decoder->range -= bound;
    }
    learn(context, bit);
    tsr_decoder_renormalise(decoder);
    return bit;
}

uint32_t tsr_range_decode_direct(struct tsr_range_decoder *decoder, unsigned bit_count)
{
    decoder->range >>= bit_count;
    uint32_t value = 0;
    for (unsigned i = bit_count; i > 0; i--) {
        const uint32_t half = decoder->range << (i - 1);
        value <<= 1;
        if (decoder->offset >= half) {
            decoder->offset -= half;
            value |= 1u;
        }
    }
    tsr_decoder_renormalise(decoder);
    return value;
}
