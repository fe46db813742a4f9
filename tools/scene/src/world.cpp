/*
 * Building a world, asking it where things are.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/world.h"

#include <cmath>

namespace tsr::scene
{

ObjectId World::add_object(std::string name)
{
    objects.push_back(std::move(name));
    return static_cast<ObjectId>(objects.size() - 1);
}

SurfaceId World::add_surface(const Surface &surface)
{
    surfaces.push_back(surface);
    return static_cast<SurfaceId>(surfaces.size() - 1);
}

void World::add(ObjectId object, Mesh mesh)
{
    bodies.push_back({std::move(mesh), object, {}});
}

void World::add(ObjectId object, Mesh mesh, Motion motion)
{
    bodies.push_back({std::move(mesh), object, std::move(motion)});
}

std::optional<Eigen::Affine3f> World::pose_of(const Body &body, std::uint64_t time_us) const
{
    if (!body.motion) {
        return Eigen::Affine3f::Identity();
    }
    std::optional<Eigen::Affine3f> pose = body.motion(time_us);
    if (pose) {
        constexpr float kScale = 1 << 20;
        pose->matrix() = pose->matrix().unaryExpr([](float v) { return std::nearbyint(v * kScale) / kScale; });
    }
    return pose;
}

} // namespace tsr::scene
