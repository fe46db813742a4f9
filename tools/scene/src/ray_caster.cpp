/*
 * Embree behind the scene's own terms.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scene/ray_caster.h"

#include <stdexcept>

#include "embree.h"

namespace tsr::scene
{

namespace
{

/* One thread builds, and one instruction set on every machine: results must not depend on either. */
constexpr const char *kDeviceConfig = "threads=1,isa=sse4.2";
/* Surfaces nearer than this to where a shadow's ray starts are the one it starts on. */
constexpr float kShadowStartM = 1e-3F;

void attach_mesh(RTCDevice device, RTCScene scene, const Mesh &mesh, unsigned id)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto *vertices = static_cast<float *>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
    for (const Eigen::Vector3f &vertex : mesh.vertices) {
        *vertices++ = vertex.x();
        *vertices++ = vertex.y();
        *vertices++ = vertex.z();
    }
    auto *indices = static_cast<std::uint32_t *>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    for (const auto &triangle : mesh.triangles) {
        indices = std::copy(triangle.begin(), triangle.end(), indices);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

RTCRay make_ray(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float from, float to, float moment)
{
    RTCRay ray{};
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tnear = from;
    ray.tfar = to;
    ray.time = moment;
    ray.mask = ~0U;
    return ray;
}

/* By more than a right angle. Embree goes from one pose to the other along their matrices, which half a turn apart
 * leads through nothing: no ray has a way there. */
bool turns_far(const Eigen::Affine3f &begin, const Eigen::Affine3f &end)
{
    return (begin.linear().transpose() * end.linear()).trace() < 1; /* 1 + 2 cos of the angle */
}

} // namespace

/* Geometry ids within a structure are indices into World::bodies. */
struct Geometry::Parts {
    const World *world = nullptr;
    RTCDevice device = nullptr;
    RTCScene standing = nullptr;
    std::vector<Mover> movers;
    std::vector<RTCScene> moving; /* of each mover */
    Eigen::AlignedBox3f bounds;
};

Geometry::Geometry(const World &world) : parts_(std::make_unique<Parts>())
{
    parts_->world = &world;
    parts_->device = rtcNewDevice(kDeviceConfig);
    if (parts_->device == nullptr) {
        throw std::runtime_error("Embree does not start on this machine");
    }
    parts_->standing = rtcNewScene(parts_->device);
    rtcSetSceneFlags(parts_->standing, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body &body = world.bodies[i];
        if (!body.motion) {
            attach_mesh(parts_->device, parts_->standing, body.mesh, static_cast<unsigned>(i));
            for (const Eigen::Vector3f &vertex : body.mesh.vertices) {
                parts_->bounds.extend(vertex);
            }
            continue;
        }
        RTCScene scene = rtcNewScene(parts_->device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        attach_mesh(parts_->device, scene, body.mesh, static_cast<unsigned>(i));
        rtcCommitScene(scene);
        parts_->moving.push_back(scene);
        Mover mover{i, {}};
        for (const Eigen::Vector3f &vertex : body.mesh.vertices) {
            mover.box.extend(vertex);
        }
        parts_->movers.push_back(mover);
    }
    rtcCommitScene(parts_->standing);
}

Geometry::~Geometry()
{
    for (RTCScene scene : parts_->moving) {
        rtcReleaseScene(scene);
    }
    rtcReleaseScene(parts_->standing);
    rtcReleaseDevice(parts_->device);
}

const World &Geometry::world() const
{
    return *parts_->world;
}

const Eigen::AlignedBox3f &Geometry::bounds() const
{
    return parts_->bounds;
}

const std::vector<Geometry::Mover> &Geometry::movers() const
{
    return parts_->movers;
}

struct RayCaster::Parts {
    const Geometry::Parts *geometry = nullptr;
    RTCScene scene = nullptr;
    std::vector<RTCGeometry> instances; /* of each mover */
    std::vector<bool> shown;
    std::uint64_t time_us = UINT64_MAX;
    std::uint32_t span_us = 0;
};

/* Instance i is mover i. What stands is asked by itself: most rays meet nothing else, and spare an instance's way
 * round.
 */
RayCaster::RayCaster(const Geometry &geometry) : parts_(std::make_unique<Parts>())
{
    parts_->geometry = geometry.parts_.get();
    RTCDevice device = parts_->geometry->device;
    parts_->scene = rtcNewScene(device);
    rtcSetSceneFlags(parts_->scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    const auto attach = [&](RTCScene part, unsigned id) {
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, part);
        rtcSetGeometryTimeStepCount(instance, 2);
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(parts_->scene, instance, id);
        return instance;
    };
    for (std::size_t i = 0; i < parts_->geometry->moving.size(); ++i) {
        parts_->instances.push_back(attach(parts_->geometry->moving[i], static_cast<unsigned>(i)));
    }
    set_time(0, 0);
}

RayCaster::~RayCaster()
{
    for (RTCGeometry instance : parts_->instances) {
        rtcReleaseGeometry(instance);
    }
    rtcReleaseScene(parts_->scene);
}

void RayCaster::set_time(std::uint64_t time_us, std::uint32_t span_us)
{
    if (time_us == parts_->time_us && span_us == parts_->span_us) {
        return;
    }
    parts_->time_us = time_us;
    parts_->span_us = span_us;
    const World &world = *parts_->geometry->world;
    for (std::size_t i = 0; i < parts_->instances.size(); ++i) {
        const Body &body = world.bodies[parts_->geometry->movers[i].body];
        const auto end = world.pose_of(body, time_us + span_us);
        auto begin = world.pose_of(body, time_us);
        if (begin && end && turns_far(*begin, *end)) {
            begin = end;
        }
        RTCGeometry instance = parts_->instances[i];
        if (begin || end) {
            rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, (begin ? begin : end)->data());
            rtcSetGeometryTransform(instance, 1, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, (end ? end : begin)->data());
            rtcEnableGeometry(instance);
        } else {
            rtcDisableGeometry(instance);
        }
        rtcCommitGeometry(instance);
    }
    rtcCommitScene(parts_->scene);
}

std::optional<Hit> RayCaster::trace(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float moment) const
{
    RTCRayHit rayhit{};
    rayhit.ray = make_ray(origin, direction, 0, INFINITY, moment);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(parts_->geometry->standing, rayhit);
    intersect(parts_->scene, rayhit); /* what is nearer */
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return std::nullopt;
    }
    Eigen::Affine3f pose = Eigen::Affine3f::Identity();
    const bool moves = rayhit.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    if (moves) {
        rtcGetGeometryTransform(parts_->instances[rayhit.hit.instID[0]], moment, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                                pose.data());
        pose.matrix().row(3) << 0, 0, 0, 1;
    }
    const Body &body = parts_->geometry->world->bodies[rayhit.hit.geomID];
    Hit hit;
    hit.distance = rayhit.ray.tfar;
    hit.object = body.object;
    hit.surface = body.mesh.surfaces[rayhit.hit.primID];
    const Eigen::Vector3f normal =
        pose.linear() * Eigen::Vector3f(rayhit.hit.Ng_x, rayhit.hit.Ng_y, rayhit.hit.Ng_z).normalized();
    hit.back = normal.dot(direction) > 0;
    hit.normal = hit.back ? -normal : normal;
    const Eigen::Vector3f point = origin + hit.distance * direction;
    hit.body_point = moves ? Eigen::Vector3f(pose.inverse() * point) : point;
    return hit;
}

bool RayCaster::is_blocked(const Eigen::Vector3f &origin, const Eigen::Vector3f &direction, float distance,
                           float moment) const
{
    RTCRay ray = make_ray(origin, direction, kShadowStartM, distance, moment);
    occlude(parts_->geometry->standing, ray);
    if (ray.tfar >= 0) {
        occlude(parts_->scene, ray);
    }
    return ray.tfar < 0; /* Embree's mark of a blocked ray */
}

} // namespace tsr::scene
