/*
 * Which maps add something: the discard rule at the sink.
 *
 *   MSE   = mean of (a - b)^2 over pixels valid in both       docs/math.md, eq. (20)
 *   MSE_k = mean of min((a - b)^2, clip^2) in block k          eq. (21)
 *   similar <=> fewer than similarity_blocks blocks have MSE_k > similarity_px2,   eq. (22)
 *               and valid in both / valid in either >= similarity_overlap_min
 *
 * The node's rule (tsr/vision/similarity.h) with the site's thresholds, and a
 * second condition for what appears or vanishes where there was no match; that
 * condition and every default are ours. Blocks are 8x8 below a width of 256, else
 * 16x16, count when half of their pixels are valid in both, and never reach over
 * the last full block.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_SELECT_H
#define TSR_SINK_SELECT_H

#include <cstdint>
#include <map>
#include <optional>

#include "tsr/host/site.h"
#include "tsr/sink/decoded_map.h"
#include "tsr/sink/store.h"

namespace tsr
{

struct MapComparison {
    double mse_px2 = 0.0; /* 0 if no pixel is valid in both */
    double overlap = 1.0; /* valid in both / valid in either; 1 if none is valid in either */
    int different_blocks = 0;
    bool similar = true;
};

/* Two maps of one size. */
MapComparison compare_maps(const DecodedMap &a, const DecodedMap &b, const SiteThresholds &thresholds);

/* Remembers each pair's last kept map. */
class Selector
{
  public:
    /* Both are kept as long as the selector is used. */
    Selector(const SiteThresholds &thresholds, const Store &store) : thresholds_(thresholds), store_(store) {}

    /* Compares map with the last kept one of node and remembers it if it is
     * kept. Nothing: it is the first (or the first of its size), and kept. */
    std::optional<MapComparison> judge(std::uint16_t node, const DecodedMap &map);
    /* Forget what was judged since the last commit: the store knows. */
    void reload() { last_kept_.clear(); }

  private:
    const SiteThresholds &thresholds_;
    const Store &store_;
    std::map<std::uint16_t, std::optional<DecodedMap>> last_kept_;
};

} // namespace tsr

#endif
