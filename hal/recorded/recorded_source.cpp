/*
 * Frames of a folder, copied into a camera's buffer.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/recorded_source.h"

#include <algorithm>

namespace tsr
{

void RecordedSource::show(std::uint64_t time_us, const tsr_gray &image)
{
    const auto frame = frames_->frame(frames_->index_at(time_us / 1000));
    const auto width = static_cast<std::size_t>(frame->width);
    for (std::size_t y = 0; y < image.height; ++y) {
        std::copy_n(frame->pixels.data() + y * width, width, image.pixels + y * image.stride);
    }
}

} // namespace tsr
