/*
 * Solid textures.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/surface.h"

#include <algorithm>
#include <cmath>

namespace tsr::scene
{

namespace
{

constexpr int kOctaves = 5;

/* lowbias32 (C. Wellons, "Prospecting for hash functions", 2018). */
std::uint32_t mix(std::uint32_t value)
{
    value ^= value >> 16;
    value *= 0x7feb352dU;
    value ^= value >> 15;
    value *= 0x846ca68bU;
    return value ^ value >> 16;
}

/* -1 .. 1 of a lattice point. */
float lattice(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed)
{
    const std::uint32_t hashed =
        mix(static_cast<std::uint32_t>(x) * 0x9e3779b1U ^ static_cast<std::uint32_t>(y) * 0x85ebca77U ^
            static_cast<std::uint32_t>(z) * 0xc2b2ae3dU ^ seed);
    return static_cast<float>(hashed >> 8) * (2.0F / 16777216.0F) - 1.0F;
}

float blend(float a, float b, float t)
{
    return a + (b - a) * t;
}

/* One octave, wave length 1. */
float value_noise(const Eigen::Vector3f &point, std::uint32_t seed)
{
    const float fx = std::floor(point.x()), fy = std::floor(point.y()), fz = std::floor(point.z());
    const auto x = static_cast<std::int32_t>(fx), y = static_cast<std::int32_t>(fy), z = static_cast<std::int32_t>(fz);
    const auto smooth = [](float t) { return t * t * (3 - 2 * t); };
    const float tx = smooth(point.x() - fx), ty = smooth(point.y() - fy), tz = smooth(point.z() - fz);
    const auto row = [&](std::int32_t yy, std::int32_t zz) {
        return blend(lattice(x, yy, zz, seed), lattice(x + 1, yy, zz, seed), tx);
    };
    return blend(blend(row(y, z), row(y + 1, z), ty), blend(row(y, z + 1), row(y + 1, z + 1), ty), tz);
}

/* 1 where a pixel resolves waves of this length, 0 where it covers half of one. */
float resolved(float wave, float footprint)
{
    return std::clamp(2.0F - 4.0F * footprint / wave, 0.0F, 1.0F);
}

/* Part of the pixel that lies in the joint 0 .. joint of a period of 1, soft over its footprint. */
float joint_cover(float position, float joint, float footprint)
{
    const float within = position - std::floor(position);
    const float soft = std::max(footprint, 0.02F);
    const float from_start = std::min(within, 1 - within); /* distance to the joint's middle line */
    return std::clamp((joint / 2 - from_start) / soft + 0.5F, 0.0F, 1.0F);
}

/* The pattern's own reflectance, and how much finer than it the noise is along each axis. */
struct Look {
    float reflectance;
    Eigen::Vector3f noise_scale;
};

/* Each cell of its own shade: 0.75 .. 1.25. */
float shade(float x, float y, float z, std::uint32_t seed)
{
    return 1.0F + 0.25F * lattice(static_cast<std::int32_t>(std::floor(x)), static_cast<std::int32_t>(std::floor(y)),
                                  static_cast<std::int32_t>(std::floor(z)), seed);
}

Look look_of(const Surface &surface, const Eigen::Vector3f &cell, float footprint)
{
    switch (surface.pattern) {
    case Pattern::brick: { /* courses of a third of a brick's length */
        const float course = cell.z() * 3;
        const float shift = 0.5F * (std::floor(course) - 2 * std::floor(std::floor(course) / 2));
        const float along = cell.x() + cell.y() + shift;
        const float joint = std::max(joint_cover(course, 0.16F, 3 * footprint), joint_cover(along, 0.05F, footprint));
        const float brick =
            surface.reflectance * blend(1, shade(along, 0, course, surface.seed + 1), resolved(0.33F, footprint));
        return {blend(brick, surface.second, joint), {4, 4, 4}};
    }
    case Pattern::planks: {
        const float across = cell.y() + cell.z();
        const float gap = joint_cover(across, 0.05F, footprint);
        const float board =
            surface.reflectance * blend(1, shade(across, 0, 0, surface.seed + 1), resolved(1, footprint));
        return {blend(board, surface.second, gap), {0.4F, 6, 6}};
    }
    case Pattern::tiles: {
        const float gap = std::max({joint_cover(cell.x(), 0.05F, footprint), joint_cover(cell.y(), 0.05F, footprint),
                                    joint_cover(cell.z(), 0.05F, footprint)});
        const float tile = surface.reflectance *
                           blend(1, shade(cell.x(), cell.y(), cell.z(), surface.seed + 1), resolved(1, footprint));
        return {blend(tile, surface.second, gap), {3, 3, 3}};
    }
    case Pattern::stripes: {
        const float along = cell.y() + 0.7F * cell.z();
        const float band = joint_cover(along, 0.45F, footprint);
        return {blend(surface.reflectance, surface.second, band), {5, 5, 5}};
    }
    case Pattern::patches: {
        const float chosen = value_noise(cell, surface.seed + 2) * 4 * resolved(1, footprint);
        return {blend(surface.second, surface.reflectance, std::clamp(chosen + 0.5F, 0.0F, 1.0F)), {2, 2, 2}};
    }
    case Pattern::shingles: { /* courses of 0.8 of a tile's width, dark where the next one lies on them */
        const float course = cell.z() * 1.25F;
        const float shift = 0.5F * (std::floor(course) - 2 * std::floor(std::floor(course) / 2));
        const float along = cell.x() + shift;
        const float joint =
            std::max(joint_cover(course, 0.24F, 1.25F * footprint), joint_cover(along, 0.06F, footprint));
        const float tile =
            surface.reflectance * blend(1, shade(along, 0, course, surface.seed + 1), resolved(0.8F, footprint));
        return {blend(tile, surface.second, joint), {2, 2, 2}};
    }
    case Pattern::plain: break;
    }
    return {surface.reflectance, {1, 1, 1}};
}

Eigen::Vector3f along_grain(const Eigen::Vector3f &point, Grain grain)
{
    switch (grain) {
    case Grain::y: return {point.y(), point.x(), point.z()};
    case Grain::z: return {point.z(), point.x(), point.y()};
    case Grain::x: break;
    }
    return point;
}

} // namespace

float noise_at(const Eigen::Vector3f &point, float footprint, int octaves, std::uint32_t seed)
{
    float sum = 0, weight = 0.5F, wave = 1;
    Eigen::Vector3f scaled = point;
    for (int i = 0; i < octaves; ++i) {
        const float visible = resolved(wave, footprint);
        if (visible <= 0) {
            break;
        }
        sum += weight * visible * value_noise(scaled, seed + static_cast<std::uint32_t>(i) * 0x68bc21ebU);
        scaled = scaled * 2.03F; /* not 2: lattices must not fall together */
        wave *= 0.4926F;
        weight *= 0.7F;
    }
    return sum;
}

float reflectance_at(const Surface &surface, const Eigen::Vector3f &point, float footprint_m)
{
    /* Solids like to end at round numbers; joints should not lie in their faces. */
    const Eigen::Vector3f cell =
        along_grain(point, surface.grain) / surface.size_m + Eigen::Vector3f(0.37F, 0.29F, 0.43F);
    const float footprint = footprint_m / surface.size_m;
    const Look look = look_of(surface, cell, footprint);
    const float noise =
        noise_at(cell.cwiseProduct(look.noise_scale), footprint * look.noise_scale.maxCoeff(), kOctaves, surface.seed);
    return std::clamp(look.reflectance * (1 + surface.contrast * 1.6F * noise), 0.01F, 0.98F);
}

} // namespace tsr::scene
