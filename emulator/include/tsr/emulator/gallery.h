/*
 * A few maps that stand for all of a run, with pictures of truth and error.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_GALLERY_H
#define TSR_EMULATOR_GALLERY_H

#include <filesystem>
#include <string>
#include <vector>

#include "tsr/emulator/pictures.h"
#include "tsr/emulator/run_record.h"
#include "tsr/host/image_file.h"

namespace tsr
{

inline constexpr std::size_t kGalleryMax = 8;
inline constexpr double kErrorShownPx = 2; /* from there on an error is drawn as the largest */

struct GalleryMap {
    const ReceivedMap *map = nullptr; /* of the run's record */
    const SitePair *pair = nullptr;
    std::string why; /* "best", "median", "worst", "newest", or several; empty: all are shown */
};

/*
 * All maps if they are kGalleryMax at most. Otherwise, by the part of the pixels that are right within 1 px, the
 * best, the median and the worst, and the newest; then, evenly over time, others of pairs not yet shown.
 */
std::vector<GalleryMap> choose_maps(const RunRecord &run);

/* Beside each map that was compared: FILE-truth.png, coloured as the map's own picture, and FILE-error.png. Throws
 * InputError. */
void write_truth_pictures(const std::filesystem::path &out, const std::vector<GalleryMap> &maps, Pictures &pictures);

/* |error| of each pixel: none dark, kErrorShownPx bright, no match gray, no truth black. Sizes agree. */
RgbImage colour_error(const FloatImage &map, const FloatImage &truth);

} // namespace tsr

#endif
