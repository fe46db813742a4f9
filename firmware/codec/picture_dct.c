/*
 * The integer transform of 8 numbers, there and back, without a multiplication.
 * A file of its own, so that each is there once.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "picture_dct.h"

void tsr_picture_transform(const int32_t *in, int32_t *out, size_t count)
{
    for (const int32_t *const end = in + TSR_PICTURE_DCT_SIZE * count; in != end; in += TSR_PICTURE_DCT_SIZE, out++) {
        const int32_t s0 = in[0] + in[7], s1 = in[1] + in[6], s2 = in[2] + in[5], s3 = in[3] + in[4];
        const int32_t d0 = in[0] - in[7], d1 = in[1] - in[6], d2 = in[2] - in[5], d3 = in[3] - in[4];
        const int32_t a0 = s0 + s3, a1 = s1 + s2, a2 = s0 - s3, a3 = s1 - s2;
        const int32_t b0 = d1 + d2 + d0 + (d0 >> 1), b1 = d0 - d3 - d2 - (d2 >> 1);
        const int32_t b2 = d0 + d3 - d1 - (d1 >> 1), b3 = d1 - d2 + d3 + (d3 >> 1);
        out[0] = a0 + a1;
        out[TSR_PICTURE_DCT_SIZE] = b0 + (b3 >> 2);
        out[2 * TSR_PICTURE_DCT_SIZE] = a2 + (a3 >> 1);
        out[3 * TSR_PICTURE_DCT_SIZE] = b1 + (b2 >> 2);
        out[4 * TSR_PICTURE_DCT_SIZE] = a0 - a1;
        out[5 * TSR_PICTURE_DCT_SIZE] = b2 - (b1 >> 2);
        out[6 * TSR_PICTURE_DCT_SIZE] = (a2 >> 1) - a3;
        out[7 * TSR_PICTURE_DCT_SIZE] = (b0 >> 2) - b3;
    }
}

void tsr_picture_transform_back(const int32_t *in, int32_t *out, size_t count)
{
    for (const int32_t *const end = in + TSR_PICTURE_DCT_SIZE * count; in != end; in += TSR_PICTURE_DCT_SIZE, out++) {
        const int32_t a0 = in[0] + in[4], a1 = in[0] - in[4], a2 = (in[2] >> 1) - in[6], a3 = in[2] + (in[6] >> 1);
        const int32_t e0 = a0 + a3, e1 = a1 + a2, e2 = a1 - a2, e3 = a0 - a3;
        const int32_t b0 = in[5] - in[3] - in[7] - (in[7] >> 1), b1 = in[1] + in[7] - in[3] - (in[3] >> 1);
        const int32_t b2 = in[7] - in[1] + in[5] + (in[5] >> 1), b3 = in[3] + in[5] + in[1] + (in[1] >> 1);
        const int32_t o0 = b0 + (b3 >> 2), o1 = b1 + (b2 >> 2), o2 = (b1 >> 2) - b2, o3 = b3 - (b0 >> 2);
        out[0] = e0 + o3;
        out[TSR_PICTURE_DCT_SIZE] = e1 + o2;
        out[2 * TSR_PICTURE_DCT_SIZE] = e2 + o1;
        out[3 * TSR_PICTURE_DCT_SIZE] = e3 + o0;
        out[4 * TSR_PICTURE_DCT_SIZE] = e3 - o0;
        out[5 * TSR_PICTURE_DCT_SIZE] = e2 - o1;
        out[6 * TSR_PICTURE_DCT_SIZE] = e1 - o2;
        out[7 * TSR_PICTURE_DCT_SIZE] = e0 - o3;
    }
}
