/*
 * Scenes on disk.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/scenario/render.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <iomanip>
#include <mutex>
#include <sstream>
#include <thread>

#include "partial_folder.h"
#include "tsr/host/atomic_file.h"
#include "tsr/host/csv.h"
#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"
#include "tsr/scenario/virtual_camera.h"

namespace tsr
{

namespace
{

namespace fs = std::filesystem;

constexpr std::size_t kFramesMax = 1'000'000; /* names of six digits sort as frames follow */

std::string frame_name(std::size_t index)
{
    std::ostringstream name;
    name << std::setw(6) << std::setfill('0') << index;
    return name.str();
}

/* Shared by the threads: which pair is next, and how far all are. */
struct Work {
    std::atomic<std::size_t> next_pair = 0;
    std::atomic<bool> stopped = false;
    std::mutex mutex;
    std::size_t done = 0;
    std::exception_ptr failure;
};

class PairWriter
{
  public:
    PairWriter(const Scenario &scenario, const Staging &staging, std::size_t pair, fs::path folder)
        : pair_(staging.site.pairs[pair]), folder_(std::move(folder)),
          left_(scenario, staging, staging.cameras[2 * pair]),
          right_(scenario, staging, staging.cameras[2 * pair + 1]), image_{pair_.width, pair_.height,
                                                                           std::vector<std::uint8_t>(
                                                                               static_cast<std::size_t>(pair_.width) *
                                                                               static_cast<std::size_t>(pair_.height))}
    {
        if (!scenario.pairs.two_boards) {
            right_.follow(left_);
        }
    }

    void write(scene::RayCaster &caster, std::size_t frame, std::uint64_t time_us)
    {
        const std::string name = frame_name(frame);
        capture(left_, caster, time_us, folder_ / "left" / (name + ".png"));
        capture(right_, caster, time_us, folder_ / "right" / (name + ".png"));
        const scene::Truth truth = left_.truth(caster, time_us);
        write_pfm(folder_ / "truth" / (name + ".pfm"), true_disparity(pair_, truth));
        FloatImage depth{pair_.width, pair_.height, truth.depth_m};
        std::replace(depth.pixels.begin(), depth.pixels.end(), 0.0F, kFloatInvalid);
        write_pfm(folder_ / "depth" / (name + ".pfm"), depth);
        write_png(folder_ / "labels" / (name + ".png"), GrayImage16{pair_.width, pair_.height, 65535, truth.objects});
    }

  private:
    void capture(VirtualCamera &camera, scene::RayCaster &caster, std::uint64_t time_us, const fs::path &file)
    {
        const auto width = static_cast<std::uint16_t>(image_.width), height = static_cast<std::uint16_t>(image_.height);
        camera.capture(caster, time_us, {image_.pixels.data(), width, height, width});
        write_png(file, image_.view());
    }

    const SitePair &pair_;
    fs::path folder_;
    VirtualCamera left_, right_;
    GrayImage image_;
};

void write_times(const fs::path &folder, std::size_t frames, std::uint32_t period_ms)
{
    std::ostringstream text;
    text << "file,time_ms\n";
    for (std::size_t i = 0; i < frames; ++i) {
        text << frame_name(i) << ".png," << i * period_ms << '\n';
    }
    write_file_atomically(folder / "times.csv", text.str());
}

void write_lists(const fs::path &folder, const scene::World &world)
{
    std::ostringstream events, objects;
    events << "time_s,what\n" << std::fixed << std::setprecision(3);
    for (const scene::Event &event : world.events) {
        events << static_cast<double>(event.time_us) / 1e6 << ',' << csv_field(event.what) << '\n';
    }
    objects << "number,name\n";
    for (std::size_t i = 0; i < world.objects.size(); ++i) {
        objects << i << ',' << csv_field(world.objects[i]) << '\n';
    }
    write_file_atomically(folder / "events.csv", events.str());
    write_file_atomically(folder / "objects.csv", objects.str());
}

std::string pair_folder(std::size_t pair)
{
    return "pair-" + std::to_string(pair + 1);
}

void write_playable_site(const fs::path &folder, Site site)
{
    for (std::size_t i = 0; i < site.pairs.size(); ++i) {
        SitePair &pair = site.pairs[i];
        pair.truth = fs::path(pair_folder(i)) / "truth";
        for (SiteNode &node : site.nodes) {
            if (node.id == pair.lead) {
                node.frames = fs::path(pair_folder(i)) / "left";
            }
            if (node.id == pair.lead && node.role == Role::binocular) {
                node.frames_right = fs::path(pair_folder(i)) / "right";
            } else if (node.id == pair.wing) {
                node.frames = fs::path(pair_folder(i)) / "right";
            }
        }
    }
    write_site(folder / "site.toml", site);
}

void render_pairs(const Scenario &scenario, const Staging &staging, const RenderOptions &options,
                  const fs::path &folder, std::size_t frames, std::uint32_t period_ms, Work &work)
{
    scene::RayCaster caster(*staging.geometry);
    for (std::size_t pair = work.next_pair++; pair < staging.site.pairs.size() && !work.stopped;
         pair = work.next_pair++) {
        PairWriter writer(scenario, staging, pair, folder / pair_folder(pair));
        for (std::size_t i = 0; i < frames && !work.stopped; ++i) {
            writer.write(caster, i, static_cast<std::uint64_t>(i) * period_ms * 1000);
            const std::lock_guard lock(work.mutex);
            ++work.done;
            if (options.progress && !options.progress(work.done, frames * staging.site.pairs.size())) {
                work.stopped = true;
            }
        }
    }
}

} // namespace

bool render_scenario(const Scenario &scenario, const RenderOptions &options)
{
    const Staging staging = stage_scenario(scenario);
    const std::uint32_t period_ms = options.period_ms > 0 ? options.period_ms : scenario.pairs.watch_period_ms;
    const auto frames = static_cast<std::size_t>(scenario.scene.duration_s * 1000 / period_ms) + 1;
    if (frames > kFramesMax) {
        throw InputError(scenario.file.string(), options.period_ms > 0 ? "--period-ms" : "pairs.watch_period_ms",
                         std::to_string(frames) + " frames a view in duration_s, at most " +
                             std::to_string(kFramesMax) + " are written");
    }
    const auto goes_on = [&] { return !options.progress || options.progress(0, frames * staging.site.pairs.size()); };
    if (!goes_on()) {
        return false;
    }
    PartialFolder folder(options.out);
    for (std::size_t i = 0; i < staging.site.pairs.size(); ++i) {
        if (!goes_on()) {
            return false;
        }
        for (const char *part : {"left", "right", "truth", "depth", "labels"}) {
            folder.make(folder.path() / pair_folder(i) / part);
        }
        for (const char *side : {"left", "right"}) {
            write_times(folder.path() / pair_folder(i) / side, frames, period_ms);
        }
    }
    Work work;
    const unsigned threads = options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> pool;
    for (unsigned i = 0; i < threads; ++i) {
        pool.emplace_back([&] {
            try {
                render_pairs(scenario, staging, options, folder.path(), frames, period_ms, work);
            } catch (...) {
                const std::lock_guard lock(work.mutex);
                work.failure = std::current_exception();
                work.stopped = true;
            }
        });
    }
    for (std::thread &thread : pool) {
        thread.join();
    }
    if (work.failure) {
        std::rethrow_exception(work.failure);
    }
    if (work.stopped) {
        return false;
    }
    write_lists(folder.path(), staging.scene->world);
    write_playable_site(folder.path(), staging.site);
    folder.keep();
    return true;
}

} // namespace tsr
