/*
 * Where a camera in virtual time gets its pictures from.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HAL_FRAME_SOURCE_H
#define TSR_HAL_FRAME_SOURCE_H

#include <cstdint>

extern "C" {
#include "tsr/base/image.h"
}
#include "tsr/host/image_file.h"

namespace tsr
{

class FrameSource
{
  public:
    virtual ~FrameSource() = default;
    virtual ImageSize size() const = 0;
    /* A capture for time_us was asked for: show() follows, unless the capture is lost. Whatever takes long can begin.
     */
    virtual void prepare(std::uint64_t time_us) = 0;
    /* A capture whose exposure begins at time_us; times never decrease. image has the source's size. */
    virtual void show(std::uint64_t time_us, const tsr_gray &image) = 0;
};

} // namespace tsr

#endif
