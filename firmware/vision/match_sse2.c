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

const struct tsr_match_kernel tsr_match_kernel_sse2 = {
    .name = "sse2",
    .prefilter_row = prefilter_row,
    .add_row = warm_up_row,
    .match_row = match_row,
    TSR_MATCH_PORTABLE_CENSUS,
    .any_start = true,
};
#endif
