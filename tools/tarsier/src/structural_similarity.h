/*
 * SSIM of maps with holes, as map_quality.h defines it.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_STEREO_STRUCTURAL_SIMILARITY_H
#define TSR_STEREO_STRUCTURAL_SIMILARITY_H

#include <vector>

#include "tsr/host/pfm.h"

namespace tsr
{

/* Not a number if no window fits. a and b are finite where valid. */
double structural_similarity(const FloatImage &a, const FloatImage &b, const std::vector<bool> &valid, double range);

} // namespace tsr

#endif
