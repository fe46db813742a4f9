/*
 * A virtual scene: what stands, what moves, and the light on it.
 *
 * A world is a function of virtual time alone. Times are us from power-on; poses are
 * rounded to multiples of 2^-20, so that a last bit of a library's sine cannot reach a picture.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_WORLD_H
#define TSR_SCENE_WORLD_H

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tsr/scene/mesh.h"
#include "tsr/scene/surface.h"

namespace tsr::scene
{

/* Body axes to site axes; nothing while the body is not there. */
using Motion = std::function<std::optional<Eigen::Affine3f>(std::uint64_t time_us)>;

struct Body { /* a rigid thing, or a rigid part of one */
    Mesh mesh;
    ObjectId object = 0;
    Motion motion; /* empty: it stands where its mesh is */
};

/* Irradiance of a white surface, 1 = a camera's middle exposure. */
struct Light {
    float sky = 0.5F;                      /* from above, half of it from the horizon, none from below */
    float sun = 0;                         /* on a surface that faces it */
    Eigen::Vector3f to_sun{0.3F, 0.2F, 1}; /* need not be of length 1 */
    float lamp = 0;                        /* on a surface that faces it from 1 m */
};

/* What a scene says of itself, to judge detectors by. */
struct Event {
    std::uint64_t time_us = 0;
    std::string what; /* "a person enters", "the level rises" */
};

struct World {
    std::vector<std::string> objects = {"sky"}; /* names; object 0 is what no ray meets */
    std::vector<Surface> surfaces;
    std::vector<Body> bodies;
    std::function<Light(std::uint64_t time_us)> light = [](std::uint64_t) { return Light{}; };
    bool has_sun = true;                          /* if not, light.sun counts for nothing */
    std::uint64_t sun_step_us = 60'000'000;       /* shadows of the sun move this often */
    std::optional<Eigen::Vector3f> lamp_position; /* without one light.lamp counts for nothing */
    std::vector<Event> events;                    /* in order of time */

    ObjectId add_object(std::string name);
    SurfaceId add_surface(const Surface &surface);
    /* A body that stands. */
    void add(ObjectId object, Mesh mesh);
    /* A body that moves. */
    void add(ObjectId object, Mesh mesh, Motion motion);

    Light light_at(std::uint64_t time_us) const { return light(time_us); }
    /* Its pose, rounded. */
    std::optional<Eigen::Affine3f> pose_of(const Body &body, std::uint64_t time_us) const;
};

} // namespace tsr::scene

#endif
