/*
 * Where a user would put zones to know of everybody who comes by:
 * scene_doorways SCENARIO.toml [TABLE.FIELD=VALUE]...
 *
 * Prints a [[zone]] for each pair: the rectangle, a fifth of the picture wide and
 * a third high, in which moving bodies are seen most, right of the columns that
 * not every disparity reaches, and below_m where the
 * disparity is one pixel more than that of 95 % of what stands there when nobody
 * does. A pair that sees nobody, or whose disparities do not reach, gets none.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "tsr/host/input_error.h"
#include "tsr/scenario/virtual_camera.h"

namespace
{

constexpr int kGridPx = 4;
constexpr double kBackgroundPart = 0.95;
constexpr double kNearerPx = 1;

struct Seen { /* per pixel, over the whole scenario */
    std::vector<int> occupied;
    std::vector<float> farthest_m;
};

Seen look(const tsr::Scenario &scenario, const tsr::Staging &staging, const tsr::StagedCamera &staged)
{
    std::set<tsr::scene::ObjectId> moving;
    for (const auto &mover : staging.geometry->movers()) {
        moving.insert(staging.scene->world.bodies[mover.body].object);
    }
    tsr::scene::RayCaster caster(*staging.geometry);
    tsr::scene::View view(*staging.geometry, staged.camera);
    const std::size_t pixels =
        static_cast<std::size_t>(staged.camera.width) * static_cast<std::size_t>(staged.camera.height);
    Seen seen{std::vector<int>(pixels), std::vector<float>(pixels, 0)};
    const std::uint64_t period_us = scenario.pairs.watch_period_ms * 1000u;
    for (std::uint64_t time_us = 0; static_cast<double>(time_us) <= scenario.scene.duration_s * 1e6;
         time_us += period_us) {
        const tsr::scene::Truth truth = view.truth(caster, time_us);
        for (std::size_t i = 0; i < pixels; i++) {
            seen.occupied[i] += moving.contains(truth.objects[i]) ? 1 : 0;
            seen.farthest_m[i] = std::max(seen.farthest_m[i], truth.depth_m[i]);
        }
    }
    return seen;
}

long occupancy(const Seen &seen, int width, const tsr::SiteRectangle &part)
{
    long sum = 0;
    for (int y = part.y; y < part.y + part.height; y++) {
        for (int x = part.x; x < part.x + part.width; x++) {
            sum += seen.occupied[static_cast<std::size_t>(y * width + x)];
        }
    }
    return sum;
}

tsr::SiteRectangle busiest(const Seen &seen, const tsr::SitePair &pair)
{
    tsr::SiteRectangle part{pair.disparities, 0, pair.width / 5, pair.height / 3}, best = part;
    long most = -1;
    for (part.y = 0; part.y + part.height <= pair.height; part.y += kGridPx) {
        for (part.x = pair.disparities; part.x + part.width <= pair.width; part.x += kGridPx) {
            const long here = occupancy(seen, pair.width, part);
            if (here > most) {
                most = here;
                best = part;
            }
        }
    }
    return best;
}

/* Disparity that 95 % of the background in the rectangle does not exceed. */
double background_px(const Seen &seen, const tsr::SitePair &pair, const tsr::SiteRectangle &part)
{
    std::vector<double> disparities;
    for (int y = part.y; y < part.y + part.height; y++) {
        for (int x = part.x; x < part.x + part.width; x++) {
            const double depth_m = static_cast<double>(seen.farthest_m[static_cast<std::size_t>(y * pair.width + x)]);
            disparities.push_back(std::isfinite(depth_m) && depth_m > 0 ? tsr::disparity_at(pair, depth_m)
                                                                        : -pair.d0_px);
        }
    }
    const auto at = disparities.begin() +
                    static_cast<std::ptrdiff_t>(kBackgroundPart * static_cast<double>(disparities.size() - 1));
    std::nth_element(disparities.begin(), at, disparities.end());
    return *at;
}

void print_zone(const tsr::SitePair &pair, const Seen &seen)
{
    const tsr::SiteRectangle part = busiest(seen, pair);
    const double limit_px = background_px(seen, pair, part) + kNearerPx;
    if (occupancy(seen, pair.width, part) == 0 || limit_px + pair.d0_px <= 0 || limit_px > pair.disparities - 2) {
        return;
    }
    const double below_m = pair.focal_px * pair.baseline_mm / 1000 / (limit_px + pair.d0_px);
    std::printf("\n[[zone]]\npair = \"%s\"\nname = \"doorway\"\nrectangle = [%d, %d, %d, %d]\nbelow_m = %.3f\n",
                pair.name.c_str(), part.x, part.y, part.width, part.height, below_m);
}

int run(int argc, char **argv)
{
    if (argc < 2) {
        throw tsr::InputError("command line", "SCENARIO", "is missing");
    }
    const tsr::Scenario scenario = tsr::load_scenario(argv[1], std::vector<std::string>(argv + 2, argv + argc));
    const tsr::Staging staging = tsr::stage_scenario(scenario);
    for (const tsr::StagedCamera &staged : staging.cameras) {
        if (!staged.right) {
            print_zone(*staging.site.pair_of(staged.node), look(scenario, staging, staged));
        }
    }
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return tsr::run_program("scene_doorways", [&] { return run(argc, argv); });
}
