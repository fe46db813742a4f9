/*
 * A site around two folders of frames: one binocular node and a gateway, for
 * whoever has recordings and no site file yet.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_EMULATOR_PAIR_SITE_H
#define TSR_EMULATOR_PAIR_SITE_H

#include <cstdint>
#include <filesystem>

#include "tsr/host/site.h"

namespace tsr
{

struct PairOptions {
    std::filesystem::path left;
    std::filesystem::path right;
    double focal_px = 0;
    double baseline_mm = 0;
    double d0_px = 0;
    int disparities = 0; /* 0: a fifth of the width, in range */
    std::uint64_t seed = 1;
};

/* Size comes from the first left frame. Throws InputError. */
Site make_pair_site(const PairOptions &options);

} // namespace tsr

#endif
