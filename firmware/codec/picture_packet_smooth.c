/*
 * The decoder's filter over the blocks of a picture that have come.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <string.h>

#include "picture_block.h"
#include "tsr/codec/picture_packet.h"

/* Block (x, y) of those marked. */
static void smooth_block(const struct tsr_picture_info *info, const uint8_t *picture, size_t stride,
                         const uint8_t *marks, size_t x, size_t y, uint8_t *out, size_t out_stride)
{
    const size_t across = TSR_PICTURE_BLOCKS(info->width), down = TSR_PICTURE_BLOCKS(info->height);
    const uint8_t *mark = marks + y * across + x;
    const size_t first_x = TSR_PICTURE_BLOCK * x, first_y = TSR_PICTURE_BLOCK * y;
    const size_t width = info->width - first_x, height = info->height - first_y;
    const size_t rows = height < TSR_PICTURE_BLOCK ? height : TSR_PICTURE_BLOCK;
    const bool has_above = y > 0 && mark[-(ptrdiff_t)across] != 0, has_below = y + 1u < down && mark[across] != 0;
    struct tsr_picture_line line = {
        .has_left = x > 0 && mark[-1] != 0,
        .has_right = x + 1u < across && mark[1] != 0,
        .limit = (uint8_t)(*mark - 1u),
        .count = (uint8_t)(width < TSR_PICTURE_BLOCK ? width : TSR_PICTURE_BLOCK),
    };
    for (size_t i = 0; i < rows; i++) {
        line.y = (uint8_t)i;
        line.here = picture + (first_y + i) * stride + first_x;
        line.above = i > 0 || has_above ? line.here - stride : line.here;
        line.below = i + 1u < rows || has_below ? line.here + stride : line.here;
        uint8_t *to = out + (first_y + i) * out_stride + first_x;
        if (*mark != 0) {
            tsr_picture_smooth_line(&line, to);
        } else {
            memcpy(to, line.here, line.count);
        }
    }
}

enum tsr_status tsr_picture_packets_smooth(const struct tsr_picture_info *info, const uint8_t *picture, size_t stride,
                                           const uint8_t *marks, uint8_t *out, size_t out_stride)
{
    if (picture == NULL || marks == NULL || out == NULL || tsr_picture_encoded_len_max(info) == 0) {
        return TSR_ERR_ARG;
    }
    if (stride < info->width || out_stride < info->width) {
        return TSR_ERR_SIZE;
    }
    for (size_t y = 0; y < TSR_PICTURE_BLOCKS(info->height); y++) {
        for (size_t x = 0; x < TSR_PICTURE_BLOCKS(info->width); x++) {
            smooth_block(info, picture, stride, marks, x, y, out, out_stride);
        }
    }
    return TSR_OK;
}
