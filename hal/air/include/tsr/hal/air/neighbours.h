/*
 * Who can matter to whom: for each radio the links worth keeping, found by a
 * grid over positions. A radio costs what its neighbourhood costs; radios far
 * away are neither compared nor stored.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_NEIGHBOURS_H
#define TSR_HAL_AIR_NEIGHBOURS_H

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "tsr/hal/air/propagation.h"

namespace tsr::air
{

struct Link {
    std::uint32_t radio = 0;  /* the other end */
    std::int32_t mean_q4 = 0; /* dBm */
};

class Neighbours
{
  public:
    /* Keeps links that can reach floor_q4 (dBm) at their best. propagation is kept. */
    Neighbours(const Propagation &propagation, int floor_q4);

    /* The new radio's index counts from 0. */
    std::size_t add(const Position &position_m);
    /* In order of their index; the same links stand in the lists of both ends. */
    const std::vector<Link> &of(std::size_t radio) const { return links_[radio]; }
    /* How often two radios were compared. */
    std::uint64_t compared() const { return compared_; }

  private:
    using Cell = std::array<std::int64_t, 3>;

    const Propagation &propagation_;
    int mean_min_q4_;
    double cell_m_;
    std::uint64_t compared_ = 0;
    std::vector<Position> positions_;
    std::vector<std::vector<Link>> links_;
    std::map<Cell, std::vector<std::uint32_t>> cells_;
};

} // namespace tsr::air

#endif
