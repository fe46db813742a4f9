/*
 * What the cameras of a run see: recorded frames, or a virtual scene.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_PICTURES_H
#define TSR_EMULATOR_PICTURES_H

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tsr/hal/frame_source.h"
#include "tsr/host/pfm.h"
#include "tsr/host/site.h"

namespace tsr
{

struct PairTruth {
    FloatImage disparity_px;    /* of the left view; kFloatInvalid: unknown */
    std::filesystem::path name; /* for errors */
};

struct SceneEvent {
    std::uint64_t time_us = 0;
    std::string what;
};

class Pictures
{
  public:
    virtual ~Pictures() = default;
    /* Of a node's left (or only) or right camera; null: it has none. The pictures are kept. Throws InputError. */
    virtual std::unique_ptr<FrameSource> source(const SiteNode &node, bool right) = 0;
    /* The run lasts at least until then. */
    virtual std::uint64_t end_us() const = 0;
    /* What a perfect map of a capture at time_us would be. */
    virtual std::optional<PairTruth> truth(const SitePair &pair, std::uint64_t time_us) = 0;
    /* What is known to happen, in order of time. */
    virtual std::vector<SceneEvent> events() const { return {}; }
};

} // namespace tsr

#endif
