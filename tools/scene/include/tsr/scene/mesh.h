/*
 * Triangle meshes of virtual scenes and the solids they are built from.
 *
 * Site axes in metres, z up (a body's own axes before it is moved). Triangles
 * of solids turn counter-clockwise seen from outside, so that a ray which
 * meets the back of one has started inside.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENE_MESH_H
#define TSR_SCENE_MESH_H

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace tsr::scene
{

using SurfaceId = std::uint16_t; /* index into World::surfaces */
using ObjectId = std::uint16_t;  /* index into World::objects */

struct Mesh {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<SurfaceId> surfaces; /* of each triangle */

    void append(const Mesh &other);
    void add_triangle(const Eigen::Vector3f &a, const Eigen::Vector3f &b, const Eigen::Vector3f &c, SurfaceId surface);
    /* Corners in counter-clockwise order; the quad is split along a-c. */
    void add_quad(const Eigen::Vector3f &a, const Eigen::Vector3f &b, const Eigen::Vector3f &c,
                  const Eigen::Vector3f &d, SurfaceId surface);
};

/* Edges along the axes; low < high. */
Mesh make_box(const Eigen::Vector3f &low, const Eigen::Vector3f &high, SurfaceId surface);
/* The same from its centre and edge lengths. */
Mesh make_centred_box(const Eigen::Vector3f &centre, const Eigen::Vector3f &size, SurfaceId surface);
/* Upright, closed; from z = 0 to height. A radius of 0 at the top makes a cone. */
Mesh make_cylinder(float radius, float top_radius, float height, int sides, SurfaceId surface);
/* Centre at the origin; sides around, half as many from pole to pole. */
Mesh make_ellipsoid(const Eigen::Vector3f &radii, int sides, SurfaceId surface);
/* A cylinder with half spheres as ends: a limb from the origin to (0, 0, -length). */
Mesh make_limb(float radius, float end_radius, float length, int sides, SurfaceId surface);
/* A polygon in the x-z plane, counter-clockwise seen from -y, convex from its first corner, extruded from y = 0 to
 * depth. */
Mesh make_prism(const std::vector<Eigen::Vector2f> &outline, float depth, SurfaceId surface);
/* An upright wall in the x-z plane, y = 0 .. thickness, of length and height, with one hole each for the windows {x, z,
 * width, height}, which do not overlap in x. */
Mesh make_wall(float length, float height, float thickness, const std::vector<Eigen::Vector4f> &windows,
               SurfaceId surface);

Mesh moved(Mesh mesh, const Eigen::Affine3f &motion);
/* Shorthands of the motions that scenes use most. */
Mesh shifted(Mesh mesh, float x, float y, float z);
Mesh turned(Mesh mesh, float degrees, const Eigen::Vector3f &axis = Eigen::Vector3f::UnitZ());

} // namespace tsr::scene

#endif
