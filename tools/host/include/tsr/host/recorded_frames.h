/*
 * A folder of recorded frames: what a camera saw, with times.
 *
 * The frames are the folder's .pgm, .png, .jpg and .jpeg files in the byte order of
 * their names, one every period_ms from 0; or, if the folder holds times.csv,
 * the files it lists, in its order:
 *
 *   file,time_ms
 *   000.pgm,0
 *   001.pgm,500          times strictly increasing, 0 .. 2^53
 *
 * All frames have one size, at most 640x480 (tsr/base/image.h): this is
 * checked from the headers when the folder is opened. Pixels are read when a
 * frame is first asked for and kept while the cache has room, once for each
 * file however often times.csv names it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_RECORDED_FRAMES_H
#define TSR_HOST_RECORDED_FRAMES_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <vector>

#include "tsr/host/image_file.h"

namespace tsr
{

struct Site;

class RecordedFrames
{
  public:
    static constexpr std::size_t kCacheMaxDefault = std::size_t{32} << 20;

    /* Throws InputError naming the folder or the file at fault. period_ms >= 1;
     * cache_max is in bytes of pixels, and one frame is always kept. */
    RecordedFrames(std::filesystem::path folder, std::uint32_t period_ms, std::size_t cache_max = kCacheMaxDefault);

    std::size_t count() const { return entries_.size(); }
    ImageSize size() const { return size_; }
    const std::filesystem::path &folder() const { return folder_; }
    const std::filesystem::path &file(std::size_t index) const { return files_[entries_.at(index).file].path; }
    std::uint64_t time_ms(std::size_t index) const { return entries_.at(index).time_ms; }
    /* Until the last frame has been shown as long as the one before it; one period_ms if it is alone. */
    std::uint64_t length_ms() const;
    /* The newest frame not later than time_ms; the first one before that. */
    std::size_t index_at(std::uint64_t time_ms) const;
    /* Throws InputError if the file does not hold what its header promised. */
    std::shared_ptr<const GrayImage> frame(std::size_t index);

  private:
    struct File {
        std::filesystem::path path;
        std::shared_ptr<const GrayImage> pixels; /* null: not in the cache */
    };
    struct Entry {
        std::size_t file = 0; /* index */
        std::uint64_t time_ms = 0;
    };

    void list_folder();
    void read_times(const std::filesystem::path &times_file);
    void check_sizes();

    std::filesystem::path folder_;
    std::vector<File> files_;
    std::vector<Entry> entries_;
    std::deque<std::size_t> cached_; /* files, oldest first */
    ImageSize size_;
    std::uint32_t period_ms_;
    std::size_t cache_max_;
};

/* Opens every folder a site names and checks that the frames of a pair have
 * the pair's width and height, left as right. Throws InputError. */
void check_recordings(const Site &site);

} // namespace tsr

#endif
