/*
 * Crop, shrink and pick.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/stage/picture.h"

#include <algorithm>
#include <cmath>

namespace tsr
{

Picture make_picture(int width, int height, float value)
{
    return {width, height,
            std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value)};
}

Picture from_gray(const GrayImage &image)
{
    return {image.width, image.height, std::vector<float>(image.pixels.begin(), image.pixels.end())};
}

Picture from_gray16(const GrayImage16 &image)
{
    return {image.width, image.height, std::vector<float>(image.pixels.begin(), image.pixels.end())};
}

Picture crop_to_shape(const Picture &picture, int width, int height)
{
    const int crop_width = std::min(picture.width, picture.height * width / height);
    const int crop_height = std::min(picture.height, picture.width * height / width);
    const int x0 = (picture.width - crop_width) / 2;
    const int y0 = (picture.height - crop_height) / 2;
    Picture crop = make_picture(crop_width, crop_height, 0);
    for (int y = 0; y < crop_height; ++y) {
        for (int x = 0; x < crop_width; ++x) {
            crop.at(x, y) = picture.at(x0 + x, y0 + y);
        }
    }
    return crop;
}

namespace
{

/* Shrink along x; the weight of a source pixel is the part of it covered. */
Picture shrink_rows(const Picture &picture, int width)
{
    Picture result = make_picture(width, picture.height, 0);
    const double scale = static_cast<double>(picture.width) / width;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double begin = x * scale;
            const double end = std::min<double>(begin + scale, picture.width);
            double sum = 0;
            for (int source = static_cast<int>(begin); source < end; ++source) {
                const double covered = std::min<double>(end, source + 1) - std::max<double>(begin, source);
                sum += covered * static_cast<double>(picture.at(source, y));
            }
            result.at(x, y) = static_cast<float>(sum / (end - begin));
        }
    }
    return result;
}

Picture transpose(const Picture &picture)
{
    Picture result = make_picture(picture.height, picture.width, 0);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            result.at(y, x) = picture.at(x, y);
        }
    }
    return result;
}

} // namespace

Picture shrink(const Picture &picture, int width, int height)
{
    return transpose(shrink_rows(transpose(shrink_rows(picture, width)), height));
}

Picture pick(const Picture &picture, int width, int height)
{
    Picture result = make_picture(width, height, 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            result.at(x, y) =
                picture.at((2 * x + 1) * picture.width / (2 * width), (2 * y + 1) * picture.height / (2 * height));
        }
    }
    return result;
}

} // namespace tsr
