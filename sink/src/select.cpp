/* The discard rule. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/sink/select.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace tsr
{
namespace
{

constexpr double kSquaresPerPx2 = TSR_DISPARITY_ONE_Q4 * TSR_DISPARITY_ONE_Q4;
/* The node's defaults, tsr/vision/similarity.h. */
constexpr std::size_t kBlockSide = 4;
constexpr std::size_t kDifferentPixelsMin = 128;
constexpr std::size_t kDifferentShare = 600; /* one pixel in so many */

struct Sums {
    std::uint64_t both = 0;
    std::uint64_t either = 0;
    std::uint64_t squares_q8 = 0;
    std::uint64_t clipped_squares_q8 = 0;
};

/* A rectangle of both maps. */
Sums sum_rectangle(const DecodedMap &a, const DecodedMap &b, std::size_t x0, std::size_t y0, std::size_t x1,
                   std::size_t y1, std::uint64_t clip_square_q8)
{
    Sums sums;
    for (std::size_t y = y0; y < y1; y++) {
        for (std::size_t x = x0; x < x1; x++) {
            const std::uint16_t da = a.disparity_q4[y * a.info.width + x];
            const std::uint16_t db = b.disparity_q4[y * a.info.width + x];
            const bool a_valid = da != TSR_DISPARITY_INVALID;
            const bool b_valid = db != TSR_DISPARITY_INVALID;
            sums.either += a_valid || b_valid ? 1 : 0;
            if (a_valid && b_valid) {
                const auto difference = static_cast<std::uint64_t>(std::abs(int{da} - int{db}));
                sums.both++;
                sums.squares_q8 += difference * difference;
                sums.clipped_squares_q8 += std::min(difference * difference, clip_square_q8);
            }
        }
    }
    return sums;
}

/* Blocks that cover the least area counted as a difference. */
int default_blocks(std::size_t width, std::size_t height)
{
    const std::size_t pixels = std::max(kDifferentPixelsMin, width * height / kDifferentShare);
    return static_cast<int>(std::max<std::size_t>(1, pixels / (kBlockSide * kBlockSide)));
}

} // namespace

MapComparison compare_maps(const DecodedMap &a, const DecodedMap &b, const SiteThresholds &thresholds)
{
    const std::size_t width = a.info.width;
    const std::size_t height = a.info.height;
    if (b.info.width != width || b.info.height != height) {
        throw std::invalid_argument("compare_maps: two sizes");
    }
    const std::size_t side = kBlockSide;
    const double clip_q4 = thresholds.similarity_clip_px * TSR_DISPARITY_ONE_Q4;
    const auto clip_square_q8 = static_cast<std::uint64_t>(clip_q4 * clip_q4);
    MapComparison result;
    for (std::size_t y = 0; y + side <= height; y += side) {
        for (std::size_t x = 0; x + side <= width; x += side) {
            const Sums block = sum_rectangle(a, b, x, y, x + side, y + side, clip_square_q8);
            const bool counts = 2 * block.both >= side * side;
            if (counts && static_cast<double>(block.clipped_squares_q8) >
                              thresholds.similarity_px2 * kSquaresPerPx2 * static_cast<double>(block.both)) {
                result.different_blocks++;
            }
        }
    }
    const Sums whole = sum_rectangle(a, b, 0, 0, width, height, clip_square_q8);
    if (whole.both > 0) {
        result.mse_px2 = static_cast<double>(whole.squares_q8) / (kSquaresPerPx2 * static_cast<double>(whole.both));
    }
    if (whole.either > 0) {
        result.overlap = static_cast<double>(whole.both) / static_cast<double>(whole.either);
    }
    const int blocks_min =
        thresholds.similarity_blocks > 0 ? thresholds.similarity_blocks : default_blocks(width, height);
    result.similar = result.different_blocks < blocks_min && result.overlap >= thresholds.similarity_overlap_min;
    return result;
}

std::optional<MapComparison> Selector::judge(std::uint16_t node, const DecodedMap &map)
{
    auto found = last_kept_.find(node);
    if (found == last_kept_.end()) {
        const auto stored = store_.last_kept(node);
        found = last_kept_.emplace(node, stored ? decode_map(stored->coded_map) : std::nullopt).first;
    }
    std::optional<DecodedMap> &last = found->second;
    if (!last || last->info.width != map.info.width || last->info.height != map.info.height) {
        last = map;
        return std::nullopt;
    }
    const MapComparison comparison = compare_maps(*last, map, thresholds_);
    if (!comparison.similar) {
        last = map;
    }
    return comparison;
}

} // namespace tsr
