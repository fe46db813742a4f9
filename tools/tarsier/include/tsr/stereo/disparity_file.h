/*
 * Files of disparity maps in pixels: PFM (+infinity = no value, tsr/host/pfm.h)
 * and PNG of 16 bits,
 *
 *   d = value / 256 px,  0 = no value        (KITTI stereo 2012, development kit)
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STEREO_DISPARITY_FILE_H
#define TSR_STEREO_DISPARITY_FILE_H

#include <filesystem>

#include "tsr/host/pfm.h"

namespace tsr
{

inline constexpr int kDisparityPngScale = 256;

enum class DisparityFormat {
    kPfm,
    kPng
};

/* By the name's ending; throws InputError with this field for any but .pfm and .png. */
DisparityFormat disparity_format(const std::filesystem::path &file, const char *field);

/* The format is told by the first bytes. Throws InputError: neither format,
 * damaged, colour, or values of 8 bits. */
FloatImage read_disparity_file(const std::filesystem::path &file);

/* By the name's ending. A PNG holds 0 <= d < 256 px, to nearest; 0 px is
 * written as 1/256, since 0 means no value. */
void write_disparity_file(const std::filesystem::path &file, const FloatImage &map);

} // namespace tsr

#endif
