/* Path loss, shadowing, fading. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/hal/air/propagation.h"

#include <algorithm>

#include "tsr/hal/air/chance.h"
#include "tsr/hal/air/decibel.h"

namespace tsr::air
{
namespace
{

constexpr double kNearestM = 0.1;
constexpr double kFarthestM = 1e7; /* more than a site is wide: a range without a bound in practice */
/* Between two draws of variance 1 a line has (1 - t)^2 + t^2, on average 2/3: the draws make up for it. */
constexpr double kInterpolationGain = 1.2247448713915890491; /* sqrt(3/2) */
constexpr std::uint64_t kShadowingKey = 0x736861646f77u;
constexpr std::uint64_t kFadingKey = 0x666164696e67u;

std::uint64_t link_key(std::uint64_t seed, std::size_t a, std::size_t b)
{
    return mix(mix(mix(seed) + std::min(a, b)) + std::max(a, b));
}

std::int64_t rounded_q16(std::int64_t value_q16)
{
    return (value_q16 + 0x8000) >> 16;
}

} // namespace

Propagation::Propagation(const AirModel &model)
    : model_(model), shadowing_q4_(level_q4(model.shadowing_db)),
      fading_q4_(level_q4(model.fading_db * kInterpolationGain)),
      period_us_(std::max<std::uint64_t>(model.fading_period_ms, 1) * 1000)
{
}

int Propagation::mean_q4(const Position &p_a, std::size_t a, const Position &p_b, std::size_t b) const
{
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        squared += (p_a[axis] - p_b[axis]) * (p_a[axis] - p_b[axis]);
    }
    /* 10 log10 of the square is 20 log10 of the distance. */
    const double distance_db = decibels(std::max(squared, kNearestM * kNearestM)) / 2;
    int level = level_q4(model_.tx_power_dbm - model_.reference_loss_db - model_.path_loss_exponent * distance_db);
    if (shadowing_q4_ != 0) {
        level += static_cast<int>(rounded_q16(shadowing_q4_ * normal_q16(link_key(model_.seed ^ kShadowingKey, a, b))));
    }
    return level;
}

int Propagation::fading_q4(std::size_t a, std::size_t b, std::uint64_t time_us) const
{
    if (fading_q4_ == 0) {
        return 0;
    }
    const std::uint64_t key = link_key(model_.seed ^ kFadingKey, a, b);
    const std::uint64_t shifted_us = time_us + key % period_us_;
    const std::uint64_t period = shifted_us / period_us_;
    const auto part_q16 = static_cast<std::int64_t>((shifted_us % period_us_ << 16) / period_us_);
    const std::int64_t from = normal_q16(mix(key + period));
    const std::int64_t to = normal_q16(mix(key + period + 1));
    const std::int64_t value_q16 = from + rounded_q16((to - from) * part_q16);
    return static_cast<int>(rounded_q16(fading_q4_ * value_q16));
}

int Propagation::fading_max_q4() const
{
    return static_cast<int>(kNormalMax * fading_q4_);
}

double Propagation::range_m(int dbm_q4) const
{
    const double most_q4 = static_cast<double>(kNormalMax * (shadowing_q4_ + fading_q4_) + 1 - dbm_q4);
    const double loss_db = model_.tx_power_dbm + most_q4 / 16 - model_.reference_loss_db;
    const double decades_db = 10 * loss_db / (10 * model_.path_loss_exponent);
    if (decades_db >= decibels(kFarthestM)) {
        return kFarthestM;
    }
    return std::max(ratio_of(decades_db), kNearestM);
}

} // namespace tsr::air
