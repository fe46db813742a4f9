/*
 * How strongly one radio hears another: path loss, shadowing, fading.
 *
 *   level(a, b, t) = tx - L0 - 10 n log10(d / 1 m) + shadow(a, b) + fade(a, b, t)
 *
 * Shadowing is normal in dB and drawn once for a link. Fading is normal in dB
 * and drawn anew every period, each link at a phase of its own; in between it
 * runs linearly. Both are hashes of seed and link, the same in both
 * directions, and end at three standard deviations.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_AIR_PROPAGATION_H
#define TSR_HAL_AIR_PROPAGATION_H

#include <array>
#include <cstddef>
#include <cstdint>

#include "tsr/hal/air/model.h"

namespace tsr::air
{

using Position = std::array<double, 3>; /* m */

class Propagation
{
  public:
    explicit Propagation(const AirModel &model);

    /* Level of a link without fading, dBm. Below 0.1 m it stays what it is there. */
    int mean_q4(const Position &p_a, std::size_t a, const Position &p_b, std::size_t b) const;
    int fading_q4(std::size_t a, std::size_t b, std::uint64_t time_us) const;
    /* The most that fading adds. */
    int fading_max_q4() const;
    /* No link that is longer reaches this level, whatever shadowing and fading draw; at least 0.1 m. */
    double range_m(int dbm_q4) const;

  private:
    AirModel model_;
    std::int64_t shadowing_q4_;
    std::int64_t fading_q4_; /* of the draws: more than what is left between them */
    std::uint64_t period_us_;
};

} // namespace tsr::air

#endif
