/*
 * A camera that plays recorded frames.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/recorded_camera.h"

#include <algorithm>
#include <utility>

namespace tsr
{

const tsr_camera_ops RecordedCamera::kOps = {&RecordedCamera::capture};

RecordedCamera::RecordedCamera(std::shared_ptr<RecordedFrames> frames, Owner owner)
    : frames_(std::move(frames)), owner_(std::move(owner))
{
}

tsr_status RecordedCamera::capture(void *self, tsr_gray image, std::uint64_t at_us)
{
    auto &camera = *static_cast<RecordedCamera *>(self);
    if (camera.busy_) {
        return TSR_ERR_BUSY;
    }
    if (camera.frames_->size() != ImageSize{image.width, image.height}) {
        return TSR_ERR_SIZE;
    }
    camera.busy_ = true;
    camera.image_ = image;
    camera.exposure_us_ = std::max(at_us, camera.owner_.now_us());
    camera.owner_.finish_at(camera.exposure_us_ + kExposureUs + kReadoutUs);
    return TSR_OK;
}

void RecordedCamera::finish()
{
    last_index_ = frames_->index_at(exposure_us_ / 1000);
    const auto frame = frames_->frame(last_index_);
    const auto width = static_cast<std::size_t>(frame->width);
    for (std::size_t y = 0; y < image_.height; ++y) {
        std::copy_n(frame->pixels.data() + y * width, width, image_.pixels + y * image_.stride);
    }
    busy_ = false;
    ++captures_;
    owner_.done(TSR_OK, exposure_us_);
}

} // namespace tsr
