/*
 * A camera that shows what its source has.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/hal/source_camera.h"

#include <algorithm>
#include <utility>

namespace tsr
{

const tsr_camera_ops SourceCamera::kOps = {&SourceCamera::capture};

SourceCamera::SourceCamera(std::unique_ptr<FrameSource> source, Owner owner)
    : source_(std::move(source)), owner_(std::move(owner))
{
}

tsr_status SourceCamera::capture(void *self, tsr_gray image, std::uint64_t at_us)
{
    auto &camera = *static_cast<SourceCamera *>(self);
    if (camera.busy_) {
        return TSR_ERR_BUSY;
    }
    if (camera.source_->size() != ImageSize{image.width, image.height}) {
        return TSR_ERR_SIZE;
    }
    camera.busy_ = true;
    camera.image_ = image;
    camera.exposure_us_ = std::max(at_us, camera.owner_.now_us());
    camera.source_->prepare(camera.exposure_us_);
    camera.owner_.finish_at(camera.exposure_us_ + kExposureUs + kReadoutUs);
    return TSR_OK;
}

void SourceCamera::finish()
{
    if (!failing_) {
        source_->show(exposure_us_, image_);
    }
    busy_ = false;
    ++captures_;
    owner_.done(failing_ ? TSR_ERR_IO : TSR_OK, exposure_us_);
}

} // namespace tsr
