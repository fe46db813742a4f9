/*
 * The 8-point integer transform of pictures, docs/codec.md, 5.5.
 *
 * Each of count rows of 8 numbers in `in` becomes a column of out, which is 8
 * wide; two passes transform a block. in and out are different arrays.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PICTURE_DCT_H
#define TSR_CODEC_PICTURE_DCT_H

#include <stddef.h>
#include <stdint.h>

#define TSR_PICTURE_DCT_SIZE 8u

/* Forward, as in H.264's reference software. */
void tsr_picture_transform(const int32_t *in, int32_t *out, size_t count);

/* Inverse: ITU-T H.264, 8.5.13. */
void tsr_picture_transform_back(const int32_t *in, int32_t *out, size_t count);

#endif
