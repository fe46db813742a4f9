/*
 * A folder of recorded frames as a source: the newest frame not later than the
 * capture.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_RECORDED_SOURCE_H
#define TSR_HAL_RECORDED_SOURCE_H

#include <memory>

#include "tsr/hal/frame_source.h"
#include "tsr/host/recorded_frames.h"

namespace tsr
{

class RecordedSource : public FrameSource
{
  public:
    /* frames may be shared by several sources. */
    explicit RecordedSource(std::shared_ptr<RecordedFrames> frames) : frames_(std::move(frames)) {}

    ImageSize size() const override { return frames_->size(); }
    void prepare(std::uint64_t) override {}
    void show(std::uint64_t time_us, const tsr_gray &image) override;

  private:
    std::shared_ptr<RecordedFrames> frames_;
};

} // namespace tsr

#endif
