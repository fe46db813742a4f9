/*
 * Transform, prediction and quantiser of pictures, docs/codec.md, 5.3 to 5.5.
 *
 * A coefficient at row u (vertical frequency) and column v is at 8 u + v.
 * Two scales: *forward*, what the forward transform makes of pixels, and
 * *inverse*, what the inverse one turns into 64 times a pixel. At (u, v)
 *
 *   inverse = 64 forward / (n[u] n[v]),   n = 8, 289/32, 5, 289/32 twice
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PICTURE_TRANSFORM_H
#define TSR_CODEC_PICTURE_TRANSFORM_H

#include <stdint.h>

#define TSR_PICTURE_COEFFICIENTS 64u
#define TSR_PICTURE_LEVEL_MAX 2051
#define TSR_PICTURE_ACTIVITY_MAX 4u

/* Position of each coefficient in the order of coding: JPEG's zigzag. */
extern const uint8_t tsr_picture_zigzag[TSR_PICTURE_COEFFICIENTS];

enum tsr_picture_mode {
    TSR_PICTURE_MEAN,     /* of the row above and the column on the left */
    TSR_PICTURE_PLANE,    /* both fade out: H.264's and HEVC's planar mode, its first two frequencies */
    TSR_PICTURE_VERTICAL, /* every row is the row above */
    TSR_PICTURE_HORIZONTAL,
};

/* The decoded pixels around a block. */
struct tsr_picture_border {
    int16_t above[8]; /* coefficients of the row above, inverse scale, as of a block of equal rows */
    int16_t left[8];
    uint8_t above_last, left_last; /* the last pixel of each */
};

/* What is coded of one block. */
struct tsr_picture_block {
    uint8_t mode;       /* enum tsr_picture_mode */
    uint8_t activity;   /* half octaves of the step above the band's */
    uint8_t last;       /* coefficients up to the last that is not 0, in zigzag order */
    int16_t levels[64]; /* in zigzag order */
};

/* Quantiser of index 0 .. 95, in 1/64 gray level: 64 * 2^(index / 8), rounded. */
uint32_t tsr_picture_step_q6(unsigned index);

/* above and left are 8 pixels each, left ones stride apart. */
void tsr_picture_border_of(struct tsr_picture_border *border, const uint8_t *above, const uint8_t *left,
                           size_t left_stride);

/* Encoder: half octaves by which the block's activity raises the step, 0 .. TSR_PICTURE_ACTIVITY_MAX. */
uint8_t tsr_picture_activity(const uint8_t *pixels, size_t stride);

/* Encoder: choose block->mode and quantise to block->levels and last with step_q6. */
void tsr_picture_quantise(struct tsr_picture_block *block, const struct tsr_picture_border *border, uint32_t step_q6,
                          const uint8_t *pixels, size_t stride);

/* The decoded block, before smoothing. */
void tsr_picture_reconstruct(const struct tsr_picture_block *block, const struct tsr_picture_border *border,
                             uint32_t step_q6, uint8_t *pixels, size_t stride);

#endif
