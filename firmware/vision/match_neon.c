/*
 * The matcher's kernel for AArch64, whose Advanced SIMD every one has: 16 disparities at once.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_NEON

#include "vector_neon.h"
#define HELD_MAX 6u /* of 32 registers */
#include "match_vector_kernel.h"
#include "match_vector_smooth.h"

const struct tsr_match_kernel tsr_match_kernel_neon = {
    .name = "neon",
    .prefilter_row = prefilter_row,
    .add_row = warm_up_row,
    .match_row = match_row,
    .any_start = true,
};

const struct tsr_match_census_kernel tsr_match_census_neon = {describe_row, add_census, census_row, cost_row,
                                                              smooth_row};
#endif
