/*
 * Paths of keys.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/path.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace tsr::scene
{

Path::Path(std::vector<PathKey> keys, bool stays) : keys_(std::move(keys)), stays_(stays)
{
    travelled_m_.push_back(0);
    for (std::size_t i = 1; i < keys_.size(); ++i) {
        travelled_m_.push_back(travelled_m_.back() + (keys_[i].position - keys_[i - 1].position).norm());
    }
}

std::optional<Path::Place> Path::at(std::uint64_t time_us) const
{
    const double time_s = static_cast<double>(time_us) / 1e6;
    const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                       [](double t, const PathKey &key) { return t < key.time_s; });
    const bool outside = next == keys_.begin() || next == keys_.end();
    if (outside) {
        const std::size_t i = next == keys_.begin() ? 0 : keys_.size() - 1;
        const bool ends_now = next == keys_.end() && time_s == keys_.back().time_s;
        if (!stays_ && !ends_now) {
            return std::nullopt;
        }
        return Place{keys_[i].position, keys_[i].heading_deg, travelled_m_[i], 0, i, 0};
    }
    const auto i = static_cast<std::size_t>(next - keys_.begin()) - 1;
    const PathKey &from = keys_[i], &to = keys_[i + 1];
    const double duration_s = to.time_s - from.time_s;
    const auto share = static_cast<float>((time_s - from.time_s) / duration_s);
    Place place;
    place.position = from.position + share * (to.position - from.position);
    const float turn = std::remainder(to.heading_deg - from.heading_deg, 360.0F);
    place.heading_deg = from.heading_deg + share * turn;
    place.travelled_m = travelled_m_[i] + share * (travelled_m_[i + 1] - travelled_m_[i]);
    place.speed_m_s = (travelled_m_[i + 1] - travelled_m_[i]) / static_cast<float>(duration_s);
    place.key = i;
    place.share = share;
    return place;
}

Eigen::Affine3f pose_of(const Path::Place &place)
{
    const float angle = place.heading_deg * std::numbers::pi_v<float> / 180;
    return Eigen::Translation3f(place.position) * Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ());
}

Motion follow(Path path)
{
    return [path = std::make_shared<const Path>(std::move(path))](
               std::uint64_t time_us) -> std::optional<Eigen::Affine3f> {
        const auto place = path->at(time_us);
        return place ? std::optional(pose_of(*place)) : std::nullopt;
    };
}

} // namespace tsr::scene
