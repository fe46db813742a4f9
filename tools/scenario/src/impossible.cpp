/*
 * Cameras inside of things, pairs that share no view, lenses that fold.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "impossible.h"

#include <cmath>

#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr double kOverlapMin = 0.2; /* of the width, that both cameras see of what is far away */
constexpr float kClearanceM = 0.05F;

/* The thing a camera is in, or touches; empty if none. Rays from inside a solid meet its back; leaves, which have no
 * inside, have a back too, so most of the six rays must. */
std::string thing_around(const scene::World &world, const scene::RayCaster &caster, const Eigen::Vector3f &eye)
{
    int backs = 0;
    std::string inside;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0F, 1.0F}) {
            const auto hit = caster.trace(eye, sign * Eigen::Vector3f::Unit(axis), 0);
            if (hit && hit->distance < kClearanceM) {
                return world.objects[hit->object];
            }
            if (hit && hit->back) {
                ++backs;
                inside = world.objects[hit->object];
            }
        }
    }
    return backs >= 4 ? inside : std::string();
}

std::string number(double value)
{
    std::string text = std::to_string(value);
    return text.substr(0, text.find('.') + 3);
}

} // namespace

void refuse_impossible(const Scenario &scenario, const Staging &staging)
{
    const std::string file = scenario.file.string();
    const StagedCamera &left = staging.cameras[0], &right = staging.cameras[1];
    if (!scene::is_invertible(left.camera)) {
        throw InputError(file, "camera.distortion",
                         "the image folds: no point of the scene belongs to some of its pixels");
    }
    const double shift = std::abs(right.camera.principal_px.x() - left.camera.principal_px.x());
    if (shift > (1 - kOverlapMin) * scenario.pairs.width) {
        throw InputError(file, "pairs.angle_deg",
                         number(scenario.pairs.angle_deg) +
                             " degrees: the two views of a pair share less than a fifth of their width");
    }
    scene::RayCaster caster(*staging.geometry);
    for (const StagedCamera &camera : staging.cameras) {
        const Eigen::Vector3f eye = camera.camera.pose.translation().cast<float>();
        const std::string thing = thing_around(staging.scene->world, caster, eye);
        if (!thing.empty()) {
            throw InputError(file, "pairs",
                             "camera " + std::to_string(camera.node) + (camera.right ? " right" : " left") + " at (" +
                                 number(eye.x()) + ", " + number(eye.y()) + ", " + number(eye.z()) +
                                 ") m is inside the " + thing);
        }
    }
}

} // namespace tsr
