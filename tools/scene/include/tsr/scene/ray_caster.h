/*
 * Rays through a world, by Embree.
 *
 * What stands is one structure, each moving body an instance of its own; a
 * moment moves instances only. One ray caster serves one thread; several may
 * share a world, whose structures are built once (Geometry).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_RAY_CASTER_H
#define TSR_SCENE_RAY_CASTER_H

#include <cstdint>
#include <memory>
#include <optional>

#include "tsr/scene/world.h"

namespace tsr::scene
{

struct Hit {
    float distance = 0;              /* along the unit direction, m */
    Eigen::Vector3f normal{0, 0, 1}; /* unit, of the side the ray met */
    bool back = false;               /* met from inside */
    ObjectId object = 0;
    SurfaceId surface = 0;
    Eigen::Vector3f body_point{0, 0, 0}; /* where, in the body's axes */
};

/* Structures of a world, built once, shared by ray casters. The world is kept. */
class Geometry
{
  public:
    explicit Geometry(const World &world);
    ~Geometry();
    Geometry(const Geometry &) = delete;
    Geometry &operator=(const Geometry &) = delete;

    const World &world() const;
    /* Corners of everything that stands, to bound shadows by. */
    const Eigen::AlignedBox3f &bounds() const;
    /* Bodies that move, as indices into World::bodies, and their boxes in their own axes. */
    struct Mover {
        std::size_t body = 0;
        Eigen::AlignedBox3f box;
    };
    const std::vector<Mover> &movers() const;

  private:
    friend class RayCaster;
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

class RayCaster
{
  public:
    /* geometry is kept. */
    explicit RayCaster(const Geometry &geometry);
    ~RayCaster();
    RayCaster(const RayCaster &) = delete;
    RayCaster &operator=(const RayCaster &) = delete;

    /* Show the world from time_us to time_us + span_us; rays tell where within it they are, 0 .. 1. */
    void set_time(std::uint64_t time_us, std::uint32_t span_us);

    /* direction is of length 1. */
    std::optional<Hit> trace(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float moment) const;
    bool is_blocked(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float distance,
                    float moment) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace tsr::scene

#endif
