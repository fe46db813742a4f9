/*
 * Baseline nodes: the same boards, cameras, tree and radio, but each pair's two
 * views go to the sink as JPEG files instead of a disparity map. What the maps
 * of a run cost is compared with what these cost.
 *
 *   changes  the firmware's own rule says when: the views of each change
 *   stream   the views of every period, whatever they show
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_BASELINE_H
#define TSR_EMULATOR_BASELINE_H

#include <cstdint>
#include <vector>

extern "C" {
#include "tsr/base/image.h"
}
#include "tsr/host/site.h"

namespace tsr
{

struct Baseline {
    /* Of the portable C of libjpeg-turbo 2.1.5 on a Cortex-M4, by `tools/bench work`; see docs/energy.md. */
    static constexpr double kInstructionsPerPixel = 70.4;

    bool stream = false;
    int quality = 50;
    std::uint32_t period_ms = 60'000; /* of a stream */
};

/* The two files of one capture. */
struct CodedViews {
    std::vector<std::uint8_t> left;
    std::vector<std::uint8_t> right;
    double instructions = 0; /* that coding them takes on a node */
};

CodedViews code_views(const Baseline &baseline, tsr_gray_view left, tsr_gray_view right);

/* The site as baseline nodes need it, without zones. Throws InputError for a pair of two boards: the baseline is of
 * boards that have both views. */
Site baseline_site(Site site);

} // namespace tsr

#endif
