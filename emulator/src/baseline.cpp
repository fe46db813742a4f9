/* Baseline nodes. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/baseline.h"

#include "tsr/host/image_file.h"
#include "tsr/host/input_error.h"

namespace tsr
{

CodedViews code_views(const Baseline &baseline, tsr_gray_view left, tsr_gray_view right)
{
    const auto pixels = [](tsr_gray_view view) { return static_cast<double>(view.width) * view.height; };
    return {encode_jpeg(left, baseline.quality), encode_jpeg(right, baseline.quality),
            Baseline::kInstructionsPerPixel * (pixels(left) + pixels(right))};
}

Site baseline_site(Site site)
{
    for (SitePair &pair : site.pairs) {
        if (pair.wing != kNodeNone) {
            throw InputError(site.file.string(), "pair '" + pair.name + "'",
                             "is of two boards, and baseline nodes have both cameras on one");
        }
        pair.zones.clear();
    }
    return site;
}

} // namespace tsr
