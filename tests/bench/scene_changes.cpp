/*
 * The node's change detector on a scenario's cameras, against what really
 * moved: scene_changes SCENARIO.toml [TABLE.FIELD=VALUE]...
 *
 * Prints one JSON object. Per left camera, frame by frame at the watch period:
 *
 *   event  a stretch of time in which what the camera sees of bodies or their shadows changed, with
 *          pauses of less than kRestS, and in which a moved body covers at least kEventPart of the picture
 *          in some frame; caught if a frame of it wakes, or the one after its last
 *   quiet  a frame before which nothing of that has changed for kRestS, whatever light and sensor did; false
 *          if it wakes
 *
 * A frame that wakes becomes the background, as on a node.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <cmath>
#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

extern "C" {
#include "tsr/vision/change.h"
}
#include "tsr/host/input_error.h"
#include "tsr/scenario/virtual_camera.h"

namespace
{

constexpr double kRestS = 5;
constexpr double kEventPart = 0.005;

struct Tally {
    std::size_t frames = 0, quiet = 0, quiet_wakes = 0, wakes = 0, events = 0, caught = 0;
};

/* What one camera's frames are in truth. */
class Judge
{
  public:
    Judge(const tsr::Staging &staging, double look_s) : world_(staging.scene->world), look_s_(look_s)
    {
        for (const auto &mover : staging.geometry->movers()) {
            moving_.insert(world_.bodies[mover.body].object);
        }
    }

    void frame(double time_s, bool moved, const tsr::scene::Truth &truth, bool woke, Tally &tally)
    {
        ++tally.frames;
        tally.wakes += woke ? 1 : 0;
        if (moved) {
            if (time_s - last_moved_s_ >= kRestS) {
                close(tally);
                background_ = previous_;
            }
            last_moved_s_ = time_s;
        }
        if (time_s - last_moved_s_ < kRestS) {
            woke_ = woke_ || (woke && time_s - last_moved_s_ < 1.5 * look_s_);
            large_ = large_ || part_of_movers(truth) >= kEventPart;
        } else {
            ++tally.quiet;
            tally.quiet_wakes += woke ? 1 : 0;
        }
        previous_ = truth.objects;
    }

    void close(Tally &tally)
    {
        tally.events += large_ ? 1 : 0;
        tally.caught += large_ && woke_ ? 1 : 0;
        large_ = woke_ = false;
    }

  private:
    /* Pixels of a moving thing that are not what they were before the event. */
    double part_of_movers(const tsr::scene::Truth &truth) const
    {
        if (background_.empty()) {
            return 0;
        }
        std::size_t count = 0;
        for (std::size_t i = 0; i < truth.objects.size(); ++i) {
            const bool other = truth.objects[i] != background_[i];
            count += other && (moving_.contains(truth.objects[i]) || moving_.contains(background_[i])) ? 1 : 0;
        }
        return static_cast<double>(count) / static_cast<double>(truth.objects.size());
    }

    const tsr::scene::World &world_;
    double look_s_; /* between two frames */
    std::set<tsr::scene::ObjectId> moving_;
    std::vector<tsr::scene::ObjectId> background_, previous_;
    double last_moved_s_ = -1e9;
    bool woke_ = false, large_ = false;
};

/* A frame settles the detector and is not judged until this many have passed. */
constexpr std::size_t kSettleFrames = 5;

void watch(const tsr::Scenario &scenario, const tsr::Staging &staging, const tsr::StagedCamera &staged, Tally &tally)
{
    tsr::scene::RayCaster caster(*staging.geometry);
    tsr::VirtualCamera camera(scenario, staging, staged);
    tsr::scene::View still(*staging.geometry, staged.camera); /* without jitter, to see what moved */
    const auto width = static_cast<std::uint16_t>(staged.camera.width),
               height = static_cast<std::uint16_t>(staged.camera.height);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * height);
    tsr_change_config config{};
    config.width = width;
    config.height = height;
    config.deviation_min = static_cast<std::uint8_t>(scenario.thresholds.change_deviation_min);
    config.min_cells = static_cast<std::uint16_t>(scenario.thresholds.change_cells_min);
    std::vector<std::uint8_t> state(tsr_change_state_len(&config));
    tsr_change change;
    tsr_change_init(&change, &config, state.data(), state.size());
    tsr::scene::Layers before;
    std::uint64_t sun_moment = 0;
    const std::uint64_t period_us = scenario.pairs.watch_period_ms * 1000u;
    Judge judge(staging, static_cast<double>(period_us) / 1e6);
    for (std::size_t i = 0; static_cast<double>(i * period_us) <= scenario.scene.duration_s * 1e6; ++i) {
        const std::uint64_t time_us = i * period_us;
        camera.capture(caster, time_us, {pixels.data(), width, height, width});
        const tsr_gray_view frame{pixels.data(), width, height, width};
        tsr_change_result result{};
        tsr_change_update(&change, &frame, &result);
        if (result.changed) {
            tsr_change_rebase(&change, &frame);
        }
        const tsr::scene::Layers &layers = still.render(caster, time_us);
        const bool sun_moved = time_us / staging.scene->world.sun_step_us != sun_moment;
        sun_moment = time_us / staging.scene->world.sun_step_us;
        const bool moved =
            i > 0 && !sun_moved && (layers.sky != before.sky || layers.sun != before.sun || layers.lamp != before.lamp);
        before = layers;
        if (i >= kSettleFrames) {
            judge.frame(static_cast<double>(time_us) / 1e6, moved, still.truth(caster, time_us), result.changed, tally);
        }
    }
    judge.close(tally);
}

int run(int argc, char **argv)
{
    if (argc < 2) {
        throw tsr::InputError("command line", "SCENARIO", "is missing");
    }
    const tsr::Scenario scenario = tsr::load_scenario(argv[1], std::vector<std::string>(argv + 2, argv + argc));
    const tsr::Staging staging = tsr::stage_scenario(scenario);
    Tally tally;
    for (const tsr::StagedCamera &staged : staging.cameras) {
        if (!staged.right) {
            watch(scenario, staging, staged, tally);
        }
    }
    const nlohmann::ordered_json json{{"scenario", scenario.name}, {"cameras", staging.site.pairs.size()},
                                      {"frames", tally.frames},    {"wakes", tally.wakes},
                                      {"events", tally.events},    {"caught", tally.caught},
                                      {"quiet", tally.quiet},      {"quiet_wakes", tally.quiet_wakes}};
    std::printf("%s\n", json.dump().c_str());
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    return tsr::run_program("scene_changes", [&] { return run(argc, argv); });
}
