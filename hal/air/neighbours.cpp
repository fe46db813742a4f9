/* The grid and the lists. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/hal/air/neighbours.h"

#include <algorithm>
#include <cmath>

namespace tsr::air
{

/* Cells are as wide as the longest link, so both ends are in the same cell or in two that touch. */
Neighbours::Neighbours(const Propagation &propagation, int floor_q4)
    : propagation_(propagation), mean_min_q4_(floor_q4 - propagation.fading_max_q4()),
      cell_m_(propagation.range_m(floor_q4))
{
}

std::size_t Neighbours::add(const Position &position_m)
{
    const std::size_t added = positions_.size();
    Cell home{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        home[axis] = static_cast<std::int64_t>(std::floor(position_m[axis] / cell_m_));
    }
    std::vector<Link> found;
    for (int nearby = 0; nearby < 27; ++nearby) {
        const auto cell =
            cells_.find({home[0] + nearby % 3 - 1, home[1] + nearby / 3 % 3 - 1, home[2] + nearby / 9 - 1});
        if (cell == cells_.end()) {
            continue;
        }
        for (const std::uint32_t other : cell->second) {
            const int mean_q4 = propagation_.mean_q4(positions_[other], other, position_m, added);
            ++compared_;
            if (mean_q4 >= mean_min_q4_) {
                found.push_back({other, mean_q4});
                links_[other].push_back({static_cast<std::uint32_t>(added), mean_q4});
            }
        }
    }
    std::sort(found.begin(), found.end(), [](const Link &a, const Link &b) { return a.radio < b.radio; });
    positions_.push_back(position_m);
    links_.push_back(std::move(found));
    cells_[home].push_back(static_cast<std::uint32_t>(added));
    return added;
}

} // namespace tsr::air
