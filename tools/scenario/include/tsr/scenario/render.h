/*
 * A scenario written as recorded folders with ground truth.
 *
 *   site.toml                 plays them: tarsier-emulator site.toml --out ...
 *   events.csv                time_s,what
 *   objects.csv               number,name: what the numbers in labels/ mean
 *   pair-N/left/, right/      frames, 8-bit PNG, and times.csv
 *   pair-N/truth/             disparity of the left view in px, PFM
 *   pair-N/depth/             depth along the left camera's axis in m, PFM; infinite: the sky
 *   pair-N/labels/            object of each pixel, 16-bit PNG
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_RENDER_H
#define TSR_SCENARIO_RENDER_H

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "tsr/scenario/scenario.h"

namespace tsr
{

struct RenderOptions {
    std::filesystem::path out;   /* must not exist, or be an empty folder that is neither in use nor a mount point */
    std::uint32_t period_ms = 0; /* between frames; 0: the scenario's watch period */
    unsigned threads = 0;        /* 0: as many as the machine has; the result is the same */
    /* Frames of pairs done, of all; called from one thread at a time, first with none done, before anything is
     * written. false ends it and leaves nothing. May be empty. */
    std::function<bool(std::size_t done, std::size_t all)> progress;
};

/* Complete or not at all. Throws InputError. Returns false if progress ended it. */
bool render_scenario(const Scenario &scenario, const RenderOptions &options);

} // namespace tsr

#endif
