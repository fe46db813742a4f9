/*
 * Which kernels this build holds and this machine runs.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

static void move_and_finish(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    tsr_match_move_columns(match, y_new, y_old);
    tsr_match_finish_row(match, y);
}

const struct tsr_match_kernel tsr_match_kernel_portable = {
    .name = "portable",
    .prefilter_row = tsr_match_prefilter_row,
    .add_row = tsr_match_add_row,
    .match_row = move_and_finish,
    .any_start = true,
};

#if defined(TSR_MATCH_HAS_X86)
static bool has_avx2(void)
{
    return __builtin_cpu_supports("avx2");
}
#endif

/* The fastest first. */
static const struct {
    const struct tsr_match_kernel *kernel;
    bool (*is_supported)(void);
} kernels[] = {
#if defined(TSR_MATCH_HAS_MVE)
    {&tsr_match_kernel_mve, NULL},
#endif
#if defined(TSR_MATCH_HAS_DSP)
    {&tsr_match_kernel_dsp, NULL},
#endif
#if defined(TSR_MATCH_HAS_X86)
    {&tsr_match_kernel_avx2, has_avx2}, {&tsr_match_kernel_sse2, NULL},
#endif
#if defined(TSR_MATCH_HAS_NEON)
    {&tsr_match_kernel_neon, NULL},
#endif
    {&tsr_match_kernel_portable, NULL},
};

const struct tsr_match_kernel *tsr_match_kernel_at(unsigned index)
{
    for (unsigned i = 0; i < sizeof kernels / sizeof kernels[0]; i++) {
        bool runs = kernels[i].is_supported == NULL || kernels[i].is_supported();
        if (runs && index-- == 0) {
            return kernels[i].kernel;
        }
    }
    return NULL;
}

const char *tsr_match_kernel_name(const struct tsr_match_kernel *kernel)
{
    return kernel->name;
}
