/*
 * Ways with corners, as keys.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tsr::scene
{

namespace
{

constexpr float kTurnS = 0.7F; /* a turn on the spot, after a wait */

Eigen::Vector2f at(const Waypoint &waypoint)
{
    return {waypoint.x, waypoint.y};
}

float heading_of(const Eigen::Vector2f &leg)
{
    return std::atan2(leg.y(), leg.x()) * 180 / std::numbers::pi_v<float>;
}

} // namespace

std::vector<PathKey> path_keys(const Walk &walk, float z)
{
    std::vector<PathKey> keys;
    const auto add = [&](double time_s, const Eigen::Vector2f &point, float ground, float heading_deg) {
        keys.push_back({time_s, {point.x(), point.y(), ground + z}, heading_deg});
    };
    const auto go_to = [&](const Eigen::Vector2f &point, float ground, float heading_deg) {
        const float way = (point - keys.back().position.head<2>()).norm();
        if (way > 1e-4F) {
            add(keys.back().time_s + way / walk.speed_m_s, point, ground, heading_deg);
        }
    };
    const auto &way = walk.way;
    float heading = heading_of(at(way[1]) - at(way[0]));
    add(walk.start_s, at(way[0]), way[0].z, heading);
    for (std::size_t i = 1; i + 1 < way.size(); ++i) {
        const Eigen::Vector2f here = at(way[i]), came = here - at(way[i - 1]), goes = at(way[i + 1]) - here;
        const float next = heading_of(goes);
        if (way[i].wait_s > 0) {
            go_to(here, way[i].z, heading);
            const double arrived_s = keys.back().time_s, wait_s = std::max(way[i].wait_s, 2 * kTurnS);
            add(arrived_s + wait_s - kTurnS, here, way[i].z, heading);
            add(arrived_s + wait_s, here, way[i].z, next);
        } else {
            const float cut = std::min({walk.corner_m, came.norm() / 2, goes.norm() / 2});
            go_to(here - came.normalized() * cut, way[i].z, heading);
            go_to(here + goes.normalized() * cut, way[i].z, next);
        }
        heading = next;
    }
    go_to(at(way.back()), way.back().z, heading);
    return keys;
}

std::vector<PersonKey> person_keys(const Walk &walk)
{
    std::vector<PersonKey> keys;
    for (const PathKey &key : path_keys(walk, 0)) {
        keys.push_back(
            {key.time_s, key.position.x(), key.position.y(), key.heading_deg, Posture::standing, key.position.z()});
    }
    return keys;
}

double end_of(const Walk &walk)
{
    return path_keys(walk, 0).back().time_s;
}

double time_within(const Walk &walk, const Eigen::Vector2f &low, const Eigen::Vector2f &high)
{
    const Path path(path_keys(walk, 0), true);
    const double end_s = path.keys().back().time_s;
    const double start_s = std::max(walk.start_s, 0.0);
    for (int i = 0; start_s + 0.1 * i <= end_s; ++i) {
        const double time_s = start_s + 0.1 * i;
        const Eigen::Vector2f point = path.at(static_cast<std::uint64_t>(time_s * 1e6))->position.head<2>();
        if ((point.array() >= low.array()).all() && (point.array() <= high.array()).all()) {
            return time_s;
        }
    }
    return -1;
}

void settle_events(World &world, double duration_s)
{
    const auto end_us = static_cast<std::uint64_t>(duration_s * 1e6);
    std::erase_if(world.events, [end_us](const Event &event) { return event.time_us > end_us; });
    std::stable_sort(world.events.begin(), world.events.end(),
                     [](const Event &a, const Event &b) { return a.time_us < b.time_us; });
}

void tell(World &world, double time_s, std::string what)
{
    if (time_s > 0) {
        world.events.push_back({static_cast<std::uint64_t>(time_s * 1e6), std::move(what)});
    }
}

} // namespace tsr::scene
