/*
 * Which kernels have code of their own for the census modes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

static const struct tsr_match_census_kernel portable = {tsr_match_describe_row, tsr_match_add_census,
                                                        tsr_match_census_row, tsr_match_cost_row, tsr_match_smooth_row};

static const struct {
    const struct tsr_match_kernel *kernel;
    const struct tsr_match_census_kernel *census;
} kernels[] = {
#if defined(TSR_MATCH_HAS_MVE)
    {&tsr_match_kernel_mve, &tsr_match_census_mve},
#endif
#if defined(TSR_MATCH_HAS_DSP)
    {&tsr_match_kernel_dsp, &tsr_match_census_dsp},
#endif
#if defined(TSR_MATCH_HAS_X86)
    {&tsr_match_kernel_avx2, &tsr_match_census_avx2}, {&tsr_match_kernel_sse2, &tsr_match_census_sse2},
#endif
#if defined(TSR_MATCH_HAS_NEON)
    {&tsr_match_kernel_neon, &tsr_match_census_neon},
#endif
    {&tsr_match_kernel_portable, &portable},
};

const struct tsr_match_census_kernel *tsr_match_census_kernel_of(const struct tsr_match *match)
{
    for (unsigned i = 0; i < sizeof kernels / sizeof kernels[0]; i++) {
        if (kernels[i].kernel == match->kernel) {
            return kernels[i].census;
        }
    }
    return &portable;
}
