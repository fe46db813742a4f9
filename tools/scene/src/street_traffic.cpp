/*
 * Cars that pass, people who walk.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "car_body.h"
#include "street_plan.h"
#include "walk.h"

namespace tsr::scene
{

namespace
{

constexpr double kHeadwayS = 2.5; /* between cars of a lane */
constexpr float kComeFromM = 22;  /* along the street across, out of sight */

/* From the street across, along the lane, and off into the one at the other end. */
Walk way_of(const StreetPlan &plan, const Drive &drive, int index)
{
    const float sign = drive.side < 0 ? 1.0F : -1.0F; /* of the way along x */
    const float lane = drive.side * kLaneY, end = plan.half_length() + 5;
    const float from = index % 2 == 0 ? kComeFromM : -kComeFromM;
    Walk walk;
    walk.speed_m_s = drive.speed_m_s;
    walk.corner_m = 3.5F;
    walk.way = {{-sign * end, from}, {-sign * end, lane}, {sign * end, lane}, {sign * end, -from}};
    walk.start_s = drive.start_s - (std::fabs(from - lane)) / drive.speed_m_s;
    return walk;
}

/* Wheels turn as the way goes by. */
Motion axle_motion(const Walk &walk, float ahead_m)
{
    const auto path = std::make_shared<const Path>(path_keys(walk, 0), false);
    return [path, ahead_m](std::uint64_t time_us) -> std::optional<Eigen::Affine3f> {
        const auto place = path->at(time_us);
        if (!place) {
            return std::nullopt;
        }
        const Eigen::AngleAxisf turn(std::fmod(place->travelled_m / kCarWheelM, 6.2831853F), Eigen::Vector3f::UnitY());
        return pose_of(*place) * Eigen::Translation3f(ahead_m, 0, kCarWheelM) * turn;
    };
}

void add_moving_car(World &world, const std::string &name, const Walk &walk, const CarSurfaces &surfaces)
{
    CarMeshes car = make_car_meshes(surfaces, true);
    const ObjectId object = world.add_object(name);
    Mesh body = std::move(car.body);
    body.append(car.panes);
    body.append(moved(std::move(car.boot_lid), Eigen::Affine3f(Eigen::Translation3f(kCarBootHinge))));
    world.add(object, std::move(body), follow(Path(path_keys(walk, 0), false)));
    world.add(object, car.axle, axle_motion(walk, kCarAxleM));
    world.add(object, std::move(car.axle), axle_motion(walk, -kCarAxleM));
}

/* Somebody's way from a door: along the pavement, across where there is a crossing, to another door. */
struct Errand {
    Walk walk;
    float crossing = 0;
    bool crosses = false;
};

const Door &door_near(const std::vector<Door> &doors, float x, float side)
{
    return *std::min_element(doors.begin(), doors.end(), [&](const Door &a, const Door &b) {
        const auto away = [&](const Door &door) {
            return std::fabs(door.x - x) + (door.side * side > 0 ? 0.0F : 1e6F);
        };
        return away(a) < away(b);
    });
}

Errand errand_of(const StreetPlan &plan, const std::vector<Door> &doors, int index, Chance &chance)
{
    Errand errand;
    Walk &walk = errand.walk;
    walk.speed_m_s = chance.between(1.0F, 1.6F);
    const float side = index % 2 == 0 ? 1.0F : -1.0F, way = index / 2 % 2 == 0 ? 1.0F : -1.0F;
    const float reach = std::min(plan.half_length() * 1.6F, chance.between(30, 60));
    const float middle = chance.between(-1, 1) * (plan.half_length() - reach / 2);
    const Door from = door_near(doors, middle - way * reach / 2, side);
    errand.crosses = index % 3 != 1;
    const Door to = door_near(doors, middle + way * reach / 2, errand.crosses ? -side : side);
    const float keeps = kWalkY + 0.35F * way * side; /* to the right of who comes towards */
    const float behind_door = kFrontY + 0.9F;
    walk.way = {{from.x, from.side * behind_door}, {from.x, from.side * keeps}};
    if (errand.crosses) {
        const std::vector<float> crossings = plan.crossings();
        errand.crossing = *std::min_element(crossings.begin(), crossings.end(), [&](float a, float b) {
            return std::fabs(a - middle) < std::fabs(b - middle);
        });
        errand.crossing += chance.between(-0.8F, 0.8F);
        walk.way.push_back({errand.crossing, from.side * keeps});
        walk.way.push_back({errand.crossing, from.side * (kKerbY + 0.4F), chance.between(1.5F, 3)});
        walk.way.push_back({errand.crossing, from.side * (kKerbY + 0.15F)});
        walk.way.push_back({errand.crossing, from.side * (kKerbY - 0.15F), 0, -kPavementZ});
        walk.way.push_back({errand.crossing, to.side * (kKerbY - 0.15F), 0, -kPavementZ});
        walk.way.push_back({errand.crossing, to.side * (kKerbY + 0.15F)});
        walk.way.push_back({errand.crossing, to.side * keeps});
    }
    walk.way.push_back({to.x, to.side * keeps});
    walk.way.push_back({to.x, to.side * behind_door});
    /* Two points in one place have no direction between them. */
    const auto same = [](const Waypoint &a, const Waypoint &b) { return std::hypot(a.x - b.x, a.y - b.y) < 0.05F; };
    walk.way.erase(std::unique(walk.way.begin(), walk.way.end(), same), walk.way.end());
    return errand;
}

/* Between kerbs when a car is near. */
bool meets_car(const StreetPlan &plan, const Errand &errand, const std::vector<Drive> &drives)
{
    const double on_s = time_within(errand.walk, {-1e4F, -kKerbY}, {1e4F, kKerbY});
    const double off_s = on_s + 2 * kKerbY / errand.walk.speed_m_s;
    return on_s >= 0 && std::any_of(drives.begin(), drives.end(), [&](const Drive &drive) {
               const double passes_s = drive.time_at(plan, errand.crossing);
               return passes_s > on_s - 1.5 && passes_s < off_s + 2.5;
           });
}

} // namespace

double Drive::time_at(const StreetPlan &plan, float x) const
{
    const float sign = side < 0 ? 1.0F : -1.0F;
    return start_s + (sign * x + plan.half_length() + 5) / speed_m_s;
}

std::vector<Drive> add_traffic(World &world, const SceneOptions &options, const StreetPlan &plan)
{
    Chance chance(options.seed * 61 + 41);
    std::vector<Drive> drives;
    std::array<std::optional<Drive>, 2> last; /* of each lane */
    const float length = 2 * plan.half_length() + 10;
    for (int i = 0; i < options.cars; ++i) {
        Drive drive;
        drive.side = i % 2 == 0 ? -1.0F : 1.0F;
        drive.speed_m_s = chance.between(5, 10);
        drive.start_s = options.duration_s * 0.9 * (i + chance.between(0.1F, 0.8F)) / options.cars;
        auto &ahead = last[static_cast<std::size_t>(i % 2)];
        if (ahead) { /* nobody overtakes */
            const double enters_s = ahead->start_s + kHeadwayS;
            const double leaves_s = ahead->start_s + length / ahead->speed_m_s + kHeadwayS;
            drive.start_s = std::max({drive.start_s, enters_s, leaves_s - length / drive.speed_m_s});
        }
        ahead = drive;
        drives.push_back(drive);
        const CarSurfaces look = add_car_surfaces(
            world, static_cast<std::uint32_t>(700 + options.seed % 100 * 8 + static_cast<std::uint64_t>(i) * 3));
        const Walk walk = way_of(plan, drive, i);
        add_moving_car(world, "car " + std::to_string(i + 1), walk, look);
        const float corner = plan.half_length() + 6;
        tell(world, time_within(walk, {-corner, -kKerbY - 3}, {corner, kKerbY + 3}), "a car passes");
    }
    return drives;
}

void add_pedestrians(World &world, const SceneOptions &options, const StreetPlan &plan, const std::vector<Door> &doors,
                     const std::vector<Drive> &drives)
{
    Chance chance(options.seed * 67 + 43);
    for (int i = 0; i < options.people; ++i) {
        Errand errand = errand_of(plan, doors, i, chance);
        errand.walk.start_s = options.duration_s * 0.85 * (i + chance.between(0.05F, 0.6F)) / options.people;
        for (int tries = 0; errand.crosses && tries < 100 && meets_car(plan, errand, drives); ++tries) {
            errand.walk.start_s += 0.5;
        }
        const Clothes clothes = make_clothes(world, static_cast<std::uint32_t>(options.seed % 1000 * 16 + 900) +
                                                        static_cast<std::uint32_t>(i) * 5);
        add_person(world, "person " + std::to_string(i + 1), person_keys(errand.walk), clothes,
                   {chance.between(1.58F, 1.9F), kPavementZ, false});
        tell(world, time_within(errand.walk, {-1e4F, -kFrontY}, {1e4F, kFrontY}), "a person enters");
    }
}

} // namespace tsr::scene
