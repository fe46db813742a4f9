/*
 * A camera in virtual time, whose pictures come from a source
 * (tsr/hal/frame_source.h).
 *
 * A capture for time t begins then, or at once if t has passed, and is done kExposureUs +
 * kReadoutUs later. Time comes from whoever owns the camera: it schedules the
 * end of a capture and then calls finish().
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_SOURCE_CAMERA_H
#define TSR_HAL_SOURCE_CAMERA_H

#include <cstdint>
#include <functional>
#include <memory>

extern "C" {
#include "tsr/hal/camera.h"
}
#include "tsr/hal/frame_source.h"

namespace tsr
{

class SourceCamera
{
  public:
    static constexpr std::uint64_t kExposureUs = 10'000;
    static constexpr std::uint64_t kReadoutUs = 20'000;

    struct Owner {
        std::function<std::uint64_t()> now_us;
        /* Call finish() at this time. */
        std::function<void(std::uint64_t)> finish_at;
        /* The capture is done: status and start of exposure. */
        std::function<void(tsr_status, std::uint64_t)> done;
    };

    SourceCamera(std::unique_ptr<FrameSource> source, Owner owner);
    SourceCamera(const SourceCamera &) = delete;
    SourceCamera &operator=(const SourceCamera &) = delete;

    tsr_camera camera() { return {&kOps, this}; }
    void finish();
    /* Its power is gone: a capture under way ends without a word, and finish() must not be called for it. */
    void abort() { busy_ = false; }
    /* Captures that end while it fails end with TSR_ERR_IO and show nothing. */
    void set_failing(bool failing) { failing_ = failing; }

    std::uint64_t captures() const { return captures_; }

  private:
    static tsr_status capture(void *self, tsr_gray image, std::uint64_t at_us);
    static const tsr_camera_ops kOps;

    std::unique_ptr<FrameSource> source_;
    Owner owner_;
    tsr_gray image_{};
    std::uint64_t exposure_us_ = 0;
    std::uint64_t captures_ = 0;
    bool busy_ = false;
    bool failing_ = false;
};

} // namespace tsr

#endif
