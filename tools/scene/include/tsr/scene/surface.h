/*
 * What surfaces look like: a solid texture, evaluated where a ray meets the
 * body, in the body's own coordinates, so that it moves with the body and both
 * cameras of a pair see the same.
 *
 * Textures are sums of octaves of value noise (Perlin, "An image synthesizer",
 * SIGGRAPH 1985, on an integer lattice with a hash in the place of the table) and
 * of regular patterns. An octave fades out where a pixel covers more than half of its
 * wave, so nothing finer than the pixel is left to alias.
 *
 * Only + - * / and floor: the same on every machine.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_SURFACE_H
#define TSR_SCENE_SURFACE_H

#include <cstdint>

#include <Eigen/Core>

namespace tsr::scene
{

enum class Pattern {
    plain,   /* noise alone */
    brick,   /* courses of bricks, with mortar of the second reflectance */
    planks,  /* boards along x, grain along them */
    tiles,   /* squares, each of its own shade, with grout */
    stripes, /* cloth: bands along x */
    patches, /* leaves, gravel, print: cells of two reflectances */
    shingles /* a roof's courses, from z, each tile of its own shade; the ridge is along x */
};

/* The body's axis that a pattern takes for its x. */
enum class Grain {
    x,
    y, /* x and y change places */
    z  /* boards stand upright */
};

struct Surface {
    Pattern pattern = Pattern::plain;
    float reflectance = 0.5F; /* 0 .. 1, Lambertian */
    float second = 0.3F;      /* of mortar, grout, the other band */
    float size_m = 0.2F;      /* of the pattern's cell, or the noise's longest wave */
    float contrast = 0.2F;    /* of the noise, relative: 0 .. 1 */
    std::uint32_t seed = 0;
    Grain grain = Grain::x;
};

/* Reflectance, 0 .. 1, at a point (m) whose pixel is footprint_m wide. */
float reflectance_at(const Surface &surface, const Eigen::Vector3f &point, float footprint_m);

/* Noise of mean 0 within -1 .. 1 whose longest wave is 1. */
float noise_at(const Eigen::Vector3f &point, float footprint, int octaves, std::uint32_t seed);

} // namespace tsr::scene

#endif
