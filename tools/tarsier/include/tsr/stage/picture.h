/*
 * Float pictures for staging scenes: crop, shrink by area, read from gray.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STAGE_PICTURE_H
#define TSR_STAGE_PICTURE_H

#include <vector>

#include "tsr/host/image_file.h"

namespace tsr
{

struct Picture { /* row-major, pixels[y * width + x] */
    int width = 0;
    int height = 0;
    std::vector<float> pixels;

    float &at(int x, int y)
    {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    float at(int x, int y) const
    {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

Picture make_picture(int width, int height, float value);
Picture from_gray(const GrayImage &image);
Picture from_gray16(const GrayImage16 &image);
/* The largest centred part with the shape width : height. */
Picture crop_to_shape(const Picture &picture, int width, int height);
/* Mean of the covered area; width and height not larger than the picture's. */
Picture shrink(const Picture &picture, int width, int height);
/* The nearest pixel, for values that must not mix (disparities). */
Picture pick(const Picture &picture, int width, int height);

} // namespace tsr

#endif
