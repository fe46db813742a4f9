/*
 * The demo's scene: recorded folders for two pairs, from a real stereo pair.
 *
 * The Aloe pair (Middlebury 2006, Hirschmueller and Scharstein, CVPR 2007, as
 * shipped by OpenCV's documentation) with its ground truth, shown to a camera
 * for 90 seconds at one frame a second with fresh sensor noise in each frame:
 *
 *    0 s   nothing changes
 *   30 s   the light on the lower half of the scene grows by 30 %
 *   60 s   an object enters: a box of known disparity, composited into both
 *          views and the ground truth
 *
 * Written twice: 320x240 for a binocular node and 160x120 for a two-board
 * pair, with site.toml. Equal seeds give equal bytes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STAGE_STAGE_H
#define TSR_STAGE_STAGE_H

#include <cstdint>
#include <filesystem>

namespace tsr
{

struct StageOptions {
    std::filesystem::path pictures; /* folder with aloeL.jpg, aloeR.jpg, aloeGT.png, box.png */
    std::filesystem::path out;
    std::uint64_t seed = 1;
};

/* Throws InputError for a picture that cannot be read or a folder that cannot be written. */
void write_stage(const StageOptions &options);

} // namespace tsr

#endif
