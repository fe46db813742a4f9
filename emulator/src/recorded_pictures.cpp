/*
 * Recorded frames and their ground truth.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/emulator/recorded_pictures.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "tsr/hal/recorded_source.h"
#include "tsr/host/csv.h"
#include "tsr/host/input_error.h"

namespace tsr
{

namespace
{

constexpr std::string_view kEventsHead = "time_s,what";
constexpr std::size_t kEventsLenMax = std::size_t{16} << 20; /* several events a second for a day */
constexpr double kEventTimeMaxS = 1e9;

SceneEvent read_event(std::string_view line, const std::string &place)
{
    double time_s = 0;
    const char *const line_end = line.data() + line.size();
    const auto [end, error] = std::from_chars(line.data(), line_end, time_s);
    if (error != std::errc() || end == line_end || *end != ',' || !(time_s >= 0 && time_s <= kEventTimeMaxS)) {
        throw InputError(place, "time_s", "is not a time in seconds before a comma");
    }
    auto what = csv_text({end + 1, line_end});
    if (!what) {
        throw InputError(place, "what", "its quotation marks are not in pairs");
    }
    try {
        (void)nlohmann::json(*what).dump(); /* as the page will */
    } catch (const nlohmann::json::exception &) {
        throw InputError(place, "what", "is not UTF-8 text");
    }
    return {static_cast<std::uint64_t>(std::llround(time_s * 1e6)), std::move(*what)};
}

/* Another file of this name is somebody else's, or a sink's: not even its size matters. */
bool has_events(const std::filesystem::path &file)
{
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) {
        return false;
    }
    std::string line;
    std::ifstream stream(file);
    stream >> std::setw(static_cast<int>(kByteOrderMark.size() + kEventsHead.size() + 1)) >> line;
    return line == kEventsHead || line == std::string(kByteOrderMark).append(kEventsHead);
}

std::vector<SceneEvent> read_events(const std::filesystem::path &site_file)
{
    const auto file = site_file.parent_path() / "events.csv";
    std::vector<SceneEvent> events;
    if (site_file.empty() || !has_events(file)) {
        return events;
    }
    CsvLines lines(file, kEventsLenMax);
    if (lines.next() != kEventsHead) {
        return events;
    }
    while (const auto line = lines.next()) {
        events.push_back(read_event(*line, lines.place()));
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const SceneEvent &a, const SceneEvent &b) { return a.time_us < b.time_us; });
    return events;
}

} // namespace

RecordedPictures::RecordedPictures(const Site &site) : site_(site), events_(read_events(site.file)) {}

std::shared_ptr<RecordedFrames> RecordedPictures::frames(const std::filesystem::path &folder, std::uint32_t period_ms)
{
    auto &opened = opened_[{site_.resolve(folder), period_ms}];
    if (!opened) {
        opened = std::make_shared<RecordedFrames>(site_.resolve(folder), period_ms);
        end_us_ = std::max(end_us_, opened->time_ms(opened->count() - 1) * 1000);
    }
    return opened;
}

std::unique_ptr<FrameSource> RecordedPictures::source(const SiteNode &node, bool right)
{
    const std::filesystem::path &folder = right ? node.frames_right : node.frames;
    return folder.empty() ? nullptr : std::make_unique<RecordedSource>(frames(folder, node.watch_period_ms));
}

std::optional<PairTruth> RecordedPictures::truth(const SitePair &pair, std::uint64_t time_us)
{
    const SiteNode *node = site_.node(pair.lead);
    if (pair.truth.empty() || node == nullptr || node->frames.empty()) {
        return std::nullopt;
    }
    const auto shown = frames(node->frames, node->watch_period_ms);
    const std::string frame_name = shown->file(shown->index_at(time_us / 1000)).filename().string();
    const auto file = truth_file_for(site_.resolve(pair.truth), frame_name);
    if (!file) {
        return std::nullopt;
    }
    return PairTruth{read_pfm(*file), *file};
}

std::optional<std::filesystem::path> truth_file_for(const std::filesystem::path &folder, const std::string &frame_name)
{
    const std::string frame_stem = std::filesystem::path(frame_name).stem().string();
    std::optional<std::filesystem::path> newest;
    std::error_code error;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const auto &file = at->path();
        if (file.extension() == ".pfm" && file.stem().string() <= frame_stem &&
            (!newest || newest->stem().string() < file.stem().string())) {
            newest = file;
        }
    }
    if (error) {
        throw InputError(folder.string(), "truth", error.message());
    }
    return newest;
}

} // namespace tsr
