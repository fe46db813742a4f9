/*
 * The node's matcher and filters on the host: two gray pictures in, a disparity
 * map out, with the buffers that a node would need and the time it took here.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STEREO_STEREO_PIPELINE_H
#define TSR_STEREO_STEREO_PIPELINE_H

#include <cstdint>
#include <string>
#include <vector>

#include "tsr/host/image_file.h"

extern "C" {
#include "tsr/vision/match.h"
#include "tsr/vision/refine.h"
}

namespace tsr
{

struct StereoOptions {
    tsr_match_config match = {};   /* with width and height */
    tsr_refine_config refine = {}; /* width and height are the matcher's */
};

struct StereoResult {
    std::vector<std::uint16_t> disparity_q4; /* [height][width], UQ12.4 or TSR_DISPARITY_INVALID */
    double match_ms = 0;
    double refine_ms = 0;
};

class StereoPipeline
{
  public:
    /* The first field that the matcher or the filters refuse; empty if none. */
    static std::string bad_field(const StereoOptions &options);

    /* Throws std::invalid_argument for options with a bad field. */
    explicit StereoPipeline(const StereoOptions &options);

    /* Both of the configured size, or std::invalid_argument; they stay as they are. */
    StereoResult run(const GrayImage &left, const GrayImage &right);

    /* Bytes beside the frames and the map; the two uses do not overlap in time. */
    std::size_t match_scratch_len() const { return match_scratch_len_; }
    std::size_t refine_scratch_len() const { return refine_scratch_len_; }
    /* As the last run used it, defaults filled in. */
    const tsr_match_config &match_config() const { return match_.config; }

  private:
    StereoOptions options_;
    tsr_match match_ = {};
    tsr_refine refine_ = {};
    std::vector<std::uint32_t> match_scratch_;
    std::vector<std::uint16_t> refine_scratch_;
    std::size_t match_scratch_len_;
    std::size_t refine_scratch_len_;
};

} // namespace tsr

#endif
