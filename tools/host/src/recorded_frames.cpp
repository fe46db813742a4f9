/* Folders of frames. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/host/recorded_frames.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <string>

#include "tsr/host/csv.h"
#include "tsr/host/input_error.h"
#include "tsr/host/site.h"

namespace tsr
{
namespace
{

namespace fs = std::filesystem;

constexpr std::size_t kTimesLenMax = std::size_t{64} << 20;
constexpr std::uint64_t kTimeMaxMs = std::uint64_t{1} << 53;

std::string shown(ImageSize size)
{
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

bool is_frame_name(const fs::path &file)
{
    const std::string extension = file.extension().string();
    return extension == ".pgm" || extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

std::uint64_t parse_time(std::string_view text, const std::string &place)
{
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value > kTimeMaxMs) {
        throw InputError(place, "time_ms", "'" + std::string(text) + "' is not a number of 0..2^53");
    }
    return value;
}

void check_same(const RecordedFrames &frames, const SitePair &pair)
{
    const ImageSize expected{pair.width, pair.height};
    if (frames.size() != expected) {
        throw InputError(frames.folder().string(), "size",
                         "frames are " + shown(frames.size()) + ", pair '" + pair.name + "' says " + shown(expected));
    }
}

} // namespace

RecordedFrames::RecordedFrames(fs::path folder, std::uint32_t period_ms, std::size_t cache_max)
    : folder_(std::move(folder)), period_ms_(period_ms), cache_max_(cache_max)
{
    if (period_ms < 1) {
        throw InputError(folder_.string(), "period_ms", "is 0");
    }
    std::error_code error;
    if (!fs::is_directory(folder_, error)) {
        throw InputError(folder_.string(), "", error ? error.message() : "not a folder");
    }
    const fs::path times_file = folder_ / "times.csv";
    if (fs::exists(times_file, error)) {
        read_times(times_file);
    } else {
        list_folder();
    }
    if (entries_.empty()) {
        throw InputError(folder_.string(), "", "holds no frames (.pgm, .png, .jpg, .jpeg)");
    }
    check_sizes();
}

void RecordedFrames::list_folder()
{
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator at(folder_, error), end; !error && at != end; at.increment(error)) {
        if (is_frame_name(at->path())) {
            files.push_back(at->path());
        }
    }
    if (error) {
        throw InputError(folder_.string(), "", error.message());
    }
    std::sort(files.begin(), files.end());
    for (std::size_t i = 0; i < files.size(); i++) {
        files_.push_back({files[i], nullptr});
        entries_.push_back({i, std::uint64_t{period_ms_} * i});
    }
}

void RecordedFrames::read_times(const fs::path &times_file)
{
    CsvLines lines(times_file, kTimesLenMax);
    std::map<std::string, std::size_t> known; /* a file may come many times */
    if (const auto header = lines.next(); header && header != "file,time_ms") {
        throw InputError(lines.place(), "header", "is not 'file,time_ms'");
    }
    while (const auto line = lines.next()) {
        const std::size_t comma = line->rfind(',');
        const auto name = csv_text(line->substr(0, comma));
        if (comma == std::string_view::npos || !name || name->empty() || fs::path(*name).has_parent_path()) {
            throw InputError(lines.place(), "file", "a line is: name of a file in this folder, comma, time");
        }
        const std::uint64_t time_ms = parse_time(line->substr(comma + 1), lines.place());
        if (!entries_.empty() && time_ms <= entries_.back().time_ms) {
            throw InputError(lines.place(), "time_ms", "is not later than the line before");
        }
        const auto [file, is_new] = known.emplace(*name, files_.size());
        if (is_new) {
            files_.push_back({folder_ / *name, nullptr});
        }
        entries_.push_back({file->second, time_ms});
    }
}

void RecordedFrames::check_sizes()
{
    for (const File &file : files_) {
        const ImageSize size = read_image_size(file.path);
        if (size_ == ImageSize{}) {
            size_ = size;
        }
        if (size != size_) {
            throw InputError(file.path.string(), "size", shown(size) + ", the frames before it are " + shown(size_));
        }
    }
    if (size_.width > TSR_IMAGE_WIDTH_MAX || size_.height > TSR_IMAGE_HEIGHT_MAX) {
        throw InputError(files_.front().path.string(), "size", shown(size_) + ", a node's frame is at most 640x480");
    }
}

std::uint64_t RecordedFrames::length_ms() const
{
    const std::size_t last = entries_.size() - 1;
    return last == 0 ? period_ms_ : 2 * entries_[last].time_ms - entries_[last - 1].time_ms;
}

std::size_t RecordedFrames::index_at(std::uint64_t time_ms) const
{
    const auto later = std::upper_bound(entries_.begin(), entries_.end(), time_ms,
                                        [](std::uint64_t time, const Entry &entry) { return time < entry.time_ms; });
    return later == entries_.begin() ? 0 : static_cast<std::size_t>(later - entries_.begin()) - 1;
}

std::shared_ptr<const GrayImage> RecordedFrames::frame(std::size_t index)
{
    const std::size_t number = entries_.at(index).file;
    File &file = files_[number];
    if (file.pixels) {
        return file.pixels;
    }
    auto image = std::make_shared<const GrayImage>(read_gray_image(file.path));
    if (image->size() != size_) {
        throw InputError(file.path.string(), "size", shown(image->size()) + ", was " + shown(size_));
    }
    const std::size_t room = std::max<std::size_t>(1, cache_max_ / image->pixels.size());
    while (cached_.size() >= room) {
        files_[cached_.front()].pixels.reset();
        cached_.pop_front();
    }
    file.pixels = image;
    cached_.push_back(number);
    return image;
}

void check_recordings(const Site &site)
{
    for (const SitePair &pair : site.pairs) {
        for (const std::uint16_t id : {pair.lead, pair.wing}) {
            const SiteNode *node = site.node(id);
            if (node == nullptr) {
                continue;
            }
            for (const fs::path &folder : {node->frames, node->frames_right}) {
                if (!folder.empty()) {
                    check_same(RecordedFrames(site.resolve(folder), node->watch_period_ms), pair);
                }
            }
        }
    }
}

} // namespace tsr
