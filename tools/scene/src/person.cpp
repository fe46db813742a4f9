/*
 * Skeletons that walk, sit and lie.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/person.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace tsr::scene
{

namespace
{

constexpr float kPi = std::numbers::pi_v<float>;
constexpr int kSides = 12;
constexpr float kStrideM = 1.4F; /* two steps, for a body of 1.75 m */

enum Part {
    kTorso,
    kHead,
    kArmLeft,
    kArmRight,
    kForearmLeft,
    kForearmRight,
    kThighLeft,
    kThighRight,
    kShinLeft,
    kShinRight,
    kPartCount
};
using Skeleton = std::array<Eigen::Affine3f, kPartCount>;

/* Angles forward about the body's y axis, degrees; lengths in parts of the body's height. */
struct Pose {
    float hip_height, torso, thigh, shin, arm, forearm;
};

Pose pose_of(Posture posture)
{
    switch (posture) {
    case Posture::sitting: return {0.30F, -5, 85, 0, 30, 75};
    case Posture::lying: return {0.07F, -90, -88, -90, -80, -85};
    case Posture::standing: break;
    }
    return {0.52F, 2, 0, 0, 0, 10};
}

Pose blend(const Pose &a, const Pose &b, float share)
{
    const auto mix = [share](float x, float y) { return x + share * (y - x); };
    return {mix(a.hip_height, b.hip_height),
            mix(a.torso, b.torso),
            mix(a.thigh, b.thigh),
            mix(a.shin, b.shin),
            mix(a.arm, b.arm),
            mix(a.forearm, b.forearm)};
}

/* A limb hangs along -z; a positive angle swings its end forward, along +x. */
Eigen::Affine3f joint(const Eigen::Vector3f &at, float degrees)
{
    return Eigen::Translation3f(at) * Eigen::AngleAxisf(-degrees * kPi / 180, Eigen::Vector3f::UnitY());
}

Skeleton skeleton_of(const Path::Place &place, const Pose &pose, float height)
{
    /* Legs and arms swing while walking, in step with the way gone. */
    const float pace = std::fmin(place.speed_m_s / 1.2F, 1.3F);
    const float phase = 2 * kPi * place.travelled_m / (kStrideM * height / 1.75F);
    const Eigen::Affine3f base =
        scene::pose_of(place) * Eigen::Translation3f(0, 0, (pose.hip_height - 0.012F * pace) * height);
    Skeleton parts;
    parts[kTorso] = base * joint({0, 0, 0}, -pose.torso); /* its mesh stands on the hip */
    parts[kHead] = parts[kTorso] * Eigen::Translation3f(0.01F * height, 0, 0.40F * height);
    for (std::size_t side = 0; side < 2; ++side) {
        const float sign = side == 0 ? 1.0F : -1.0F;
        const float swing = sign * std::sin(phase) * pace;
        const float lift = std::fmax(sign * std::cos(phase), 0.0F) * pace;
        const Eigen::Affine3f thigh = base * joint({0, sign * 0.055F * height, 0}, pose.thigh + 25 * swing);
        parts[kThighLeft + side] = thigh;
        parts[kShinLeft + side] = thigh * joint({0, 0, -0.25F * height}, pose.shin - pose.thigh - 40 * lift);
        const Eigen::Affine3f shoulder =
            parts[kTorso] * joint({0, sign * 0.125F * height, 0.29F * height}, pose.torso + pose.arm - 20 * swing);
        parts[kArmLeft + side] = shoulder;
        parts[kForearmLeft + side] = shoulder * joint({0, 0, -0.17F * height}, pose.forearm - pose.arm);
    }
    return parts;
}

std::array<Mesh, kPartCount> part_meshes(float height, const Clothes &clothes)
{
    std::array<Mesh, kPartCount> meshes;
    Eigen::Affine3f flat(Eigen::Scaling(0.7F, 1.0F, 1.0F)); /* a chest is wider than deep */
    meshes[kTorso] = moved(
        shifted(make_limb(0.115F * height, 0.095F * height, 0.26F * height, kSides, clothes.top), 0, 0, 0.27F * height),
        flat);
    meshes[kHead] = make_ellipsoid({0.055F * height, 0.045F * height, 0.065F * height}, kSides, clothes.skin);
    meshes[kHead].append(
        shifted(make_ellipsoid({0.055F * height, 0.05F * height, 0.05F * height}, kSides, clothes.hair),
                -0.012F * height, 0, 0.027F * height));
    meshes[kHead].append(shifted(make_cylinder(0.03F * height, 0.03F * height, 0.06F * height, kSides, clothes.skin), 0,
                                 0, -0.1F * height));
    for (std::size_t side = 0; side < 2; ++side) {
        meshes[kArmLeft + side] = make_limb(0.034F * height, 0.028F * height, 0.17F * height, kSides, clothes.top);
        meshes[kForearmLeft + side] = make_limb(0.027F * height, 0.022F * height, 0.18F * height, kSides, clothes.skin);
        meshes[kThighLeft + side] =
            make_limb(0.055F * height, 0.04F * height, 0.25F * height, kSides, clothes.trousers);
        meshes[kShinLeft + side] =
            make_limb(0.038F * height, 0.026F * height, 0.25F * height, kSides, clothes.trousers);
        meshes[kShinLeft + side].append(make_centred_box(
            {0.04F * height, 0, -0.262F * height}, {0.15F * height, 0.055F * height, 0.04F * height}, clothes.hair));
    }
    return meshes;
}

} // namespace

ObjectId add_person(World &world, const std::string &name, const std::vector<PersonKey> &keys, const Clothes &clothes,
                    const PersonOptions &options)
{
    std::vector<PathKey> path_keys;
    auto postures = std::make_shared<std::vector<Posture>>();
    for (const PersonKey &key : keys) {
        path_keys.push_back({key.time_s, {key.x, key.y, options.ground_m + key.rise_m}, key.heading_deg});
        postures->push_back(key.posture);
    }
    const auto path = std::make_shared<const Path>(std::move(path_keys), options.stays);
    const ObjectId object = world.add_object(name);
    auto meshes = part_meshes(options.height_m, clothes);
    for (std::size_t part = 0; part < kPartCount; ++part) {
        world.add(object, std::move(meshes[part]),
                  [=, height = options.height_m](std::uint64_t time_us) -> std::optional<Eigen::Affine3f> {
                      const auto place = path->at(time_us);
                      if (!place) {
                          return std::nullopt;
                      }
                      const std::size_t next = std::min(place->key + 1, postures->size() - 1);
                      const Pose pose =
                          blend(pose_of((*postures)[place->key]), pose_of((*postures)[next]), place->share);
                      return skeleton_of(*place, pose, height)[part];
                  });
    }
    return object;
}

Clothes make_clothes(World &world, std::uint32_t seed)
{
    const auto shade = [&](std::uint32_t part) { /* 0 .. 1, a golden-ratio sequence: no two near each other */
                                                 return static_cast<float>((seed * 4 + part) * 0x9e3779b1U >> 8) /
                                                        16777216.0F;
    };
    Clothes clothes;
    clothes.skin = world.add_surface({Pattern::plain, 0.35F + 0.3F * shade(0), 0, 0.1F, 0.15F, seed});
    clothes.hair = world.add_surface({Pattern::plain, 0.06F + 0.2F * shade(1), 0, 0.05F, 0.4F, seed + 1});
    const float top = 0.12F + 0.6F * shade(2), trousers = 0.08F + 0.3F * shade(3);
    clothes.top =
        world.add_surface({seed % 3 == 0 ? Pattern::stripes : Pattern::plain, top, top * 0.5F, 0.12F, 0.35F, seed + 2});
    clothes.trousers = world.add_surface({Pattern::plain, trousers, 0, 0.15F, 0.35F, seed + 3});
    return clothes;
}

} // namespace tsr::scene
