/*
 * Checks before a run.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/preflight.h"

#include <algorithm>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

#include "tsr/emulator/node_setup.h"
#include "tsr/host/input_error.h"
#include "tsr/host/pfm.h"
#include "tsr/host/recorded_frames.h"

namespace tsr
{

namespace
{

bool is_camera(Role role)
{
    return role == Role::lead || role == Role::wing || role == Role::binocular;
}

void require_frames(const Site &site, const SiteNode &node)
{
    const bool right_missing = node.role == Role::binocular && node.frames_right.empty();
    if (is_camera(node.role) && (node.frames.empty() || right_missing)) {
        const std::string place =
            node.line > 0 ? site.file.string() + ":" + std::to_string(node.line) : site.file.string();
        throw InputError(place,
                         "node " + std::to_string(node.id) + ": " + (node.frames.empty() ? "frames" : "frames_right"),
                         "is missing; the emulator plays recordings");
    }
}

void check_frames(const std::filesystem::path &folder, std::uint32_t period_ms)
{
    RecordedFrames frames(folder, period_ms);
    if (frames.time_ms(frames.count() - 1) > kRecordingMaxMs) {
        throw InputError(folder.string(), "times", "the recording is longer than 24 hours");
    }
    for (std::size_t i = 0; i < frames.count(); ++i) {
        frames.frame(i);
    }
}

void check_truth(const Site &site, const SitePair &pair)
{
    const std::filesystem::path folder = site.resolve(pair.truth);
    std::error_code error;
    std::filesystem::directory_iterator files(folder, error);
    if (error) {
        throw InputError(folder.string(), "truth", error.message());
    }
    for (const auto &entry : files) {
        if (entry.path().extension() != ".pfm") {
            continue;
        }
        const FloatImage image = read_pfm(entry.path());
        if (image.width != pair.width || image.height != pair.height) {
            throw InputError(entry.path().string(), "size", "is not that of pair '" + pair.name + "'");
        }
    }
}

std::string gigabytes(std::uint64_t octets)
{
    const std::uint64_t tenths = (octets + 50'000'000) / 100'000'000;
    return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

} // namespace

std::uint64_t check_nodes(const Site &site, const KeyRing &keys)
{
    std::uint64_t octets = 0;
    for (const SiteNode &node : site.nodes) {
        const auto setup = set_up_node(site, node, keys);
        tsr_memory_plan plan{};
        tsr_node_plan_memory(&setup->config, &plan);
        octets += plan.total;
    }
    return octets;
}

std::uint64_t memory_there()
{
    const auto machine =
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    rlimit limit{};
    return getrlimit(RLIMIT_AS, &limit) == 0 ? std::min<std::uint64_t>(machine, limit.rlim_cur) : machine;
}

void check_memory(const Site &site, const std::filesystem::path &file, std::uint64_t needed, std::uint64_t there)
{
    if (needed > there) {
        throw InputError(file.string(), "pairs",
                         std::to_string(site.pairs.size()) + " pairs need " + gigabytes(needed) +
                             " GB of memory for their nodes and what their cameras see, and there are " +
                             gigabytes(there) + " GB");
    }
}

void check_recorded(const Site &site)
{
    for (const SiteNode &node : site.nodes) {
        require_frames(site, node);
    }
    check_recordings(site);
    for (const SiteNode &node : site.nodes) {
        for (const auto &folder : {node.frames, node.frames_right}) {
            if (!folder.empty()) {
                check_frames(site.resolve(folder), node.watch_period_ms);
            }
        }
    }
    for (const SitePair &pair : site.pairs) {
        if (!pair.truth.empty()) {
            check_truth(site, pair);
        }
    }
}

} // namespace tsr
