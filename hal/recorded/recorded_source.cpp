/*
 * Frames of a folder, copied into a camera's buffer.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/recorded_source.h"

#include <algorithm>

namespace tsr
{

std::uint64_t Playback::recorded_ms(std::uint64_t time_us) const
{
    const std::uint64_t ms = time_us / 1000 + offset_ms;
    if (length_ms == 0) {
        return ms;
    }
    const std::uint64_t round_ms = ms % (length_ms + pause_ms);
    return round_ms < length_ms ? round_ms : (round_ms - length_ms) % still_ms;
}

void RecordedSource::show(std::uint64_t time_us, const tsr_gray &image)
{
    const auto frame = frames_->frame(frames_->index_at(playback_.recorded_ms(time_us)));
    const auto width = static_cast<std::size_t>(frame->width);
    for (std::size_t y = 0; y < image.height; ++y) {
        std::copy_n(frame->pixels.data() + y * width, width, image.pixels + y * image.stride);
    }
}

} // namespace tsr
