/*
 * Captures of a virtual scene.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scenario/virtual_camera.h"

#include <cmath>

#include "tsr/scene/hash.h"

namespace tsr
{

namespace
{

scene::SensorModel seeded(scene::SensorModel model, std::uint64_t seed)
{
    model.seed = seed;
    return model;
}

std::uint64_t seed_of(const Scenario &scenario, const StagedCamera &camera)
{
    return scene::hash64(scene::hash64(scenario.seed) + 2u * camera.node + (camera.right ? 1u : 0u));
}

} // namespace

VirtualCamera::VirtualCamera(const Scenario &scenario, const Staging &staging, const StagedCamera &camera)
    : staging_(staging), view_(*staging.geometry, camera.camera),
      sensor_(seeded(scenario.camera.sensor, seed_of(scenario, camera))), last_sensor_(sensor_),
      seed_(seed_of(scenario, camera)),
      jitter_us_(camera.right ? static_cast<std::uint64_t>(std::llround(scenario.camera.jitter_us)) : 0)
{
}

std::uint64_t VirtualCamera::jittered(std::uint64_t time_us) const
{
    const std::uint64_t late = scene::hash64(seed_ ^ time_us) % (2 * jitter_us_ + 1);
    return time_us + late < jitter_us_ ? 0 : time_us + late - jitter_us_;
}

void VirtualCamera::render(scene::RayCaster &caster, std::uint64_t time_us)
{
    layers_ = &view_.render(caster, jittered(time_us));
}

void VirtualCamera::expose(std::uint64_t time_us, const tsr_gray &image)
{
    if (master_ != nullptr) {
        sensor_.follow(master_->last_us_ == time_us ? master_->last_sensor_ : master_->sensor_);
    }
    last_sensor_ = sensor_;
    last_us_ = time_us;
    sensor_.expose(view_.camera(), *layers_, staging_.scene->world.light_at(jittered(time_us)), image);
}

FloatImage true_disparity(const SitePair &pair, const scene::Truth &truth)
{
    FloatImage image{pair.width, pair.height, {}};
    const double focal_baseline = pair.focal_px * pair.baseline_mm / 1000;
    for (const float depth_m : truth.depth_m) {
        image.pixels.push_back(depth_m > 0
                                   ? static_cast<float>(focal_baseline / static_cast<double>(depth_m) - pair.d0_px)
                                   : kFloatInvalid);
    }
    return image;
}

} // namespace tsr
