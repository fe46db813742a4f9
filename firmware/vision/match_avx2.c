/*
 * The matcher's kernel for x86-64 with AVX2: 32 disparities at once.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_X86

#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif

#include "vector_avx2.h"
#define HELD_MAX 3u
#include "match_vector_kernel.h"
#include "match_vector_smooth.h"

const struct tsr_match_kernel tsr_match_kernel_avx2 = {
    .name = "avx2",
    .prefilter_row = prefilter_row,
    .add_row = warm_up_row,
    .match_row = match_row,
    .any_start = true,
};

const struct tsr_match_census_kernel tsr_match_census_avx2 = {describe_row, add_census, census_row, cost_row,
                                                              smooth_row};

#ifdef __clang__
#pragma clang attribute pop
#endif
#endif
