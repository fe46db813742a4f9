/*
 * A folder of recorded frames as a source: the newest frame not later than the
 * capture, from the beginning to the end or round and round.
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

/* When of a recording is shown when. By default it is played once, and the last frame stays. */
struct Playback {
    std::uint64_t offset_ms = 0; /* into the first round, at time 0 */
    std::uint64_t length_ms = 0; /* of the recording: rounds follow each other; 0: there is one without an end */
    std::uint64_t pause_ms = 0;  /* that a round goes on after the recording, */
    std::uint64_t still_ms = 1;  /* with the recording's beginning as long as this again and again */

    std::uint64_t recorded_ms(std::uint64_t time_us) const;
};

class RecordedSource : public FrameSource
{
  public:
    /* frames may be shared by several sources. */
    explicit RecordedSource(std::shared_ptr<RecordedFrames> frames, Playback playback = {})
        : frames_(std::move(frames)), playback_(playback)
    {
    }

    ImageSize size() const override { return frames_->size(); }
    void prepare(std::uint64_t) override {}
    void show(std::uint64_t time_us, const tsr_gray &image) override;

  private:
    std::shared_ptr<RecordedFrames> frames_;
    Playback playback_;
};

} // namespace tsr

#endif
