/*
 * The matcher's kernel for x86-64, whose SSE2 every one has: 16 disparities at once.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_X86

#include "vector_sse2.h"
#define HELD_MAX 3u
#include "match_vector_kernel.h"
#include "match_vector_smooth.h"

const struct tsr_match_kernel tsr_match_kernel_sse2 = {
    .name = "sse2",
    .prefilter_row = prefilter_row,
    .add_row = warm_up_row,
    .match_row = match_row,
    .any_start = true,
};

const struct tsr_match_census_kernel tsr_match_census_sse2 = {describe_row, add_census, census_row, cost_row,
                                                              smooth_row};
#endif
