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

const struct tsr_match_kernel tsr_match_kernel_portable = {"portable", tsr_match_prefilter_row, tsr_match_add_row,
                                                           move_and_finish};

#if defined(TSR_MATCH_HAS_X86)
static bool has_avx2(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("popcnt");
}
#endif

/* The fastest first. */
static const struct {
    const struct tsr_match_kernel *kernel;
    bool (*is_supported)(void);
    bool is_complete; /* covers search_start_px < 0 */
} kernels[] = {
#if defined(TSR_MATCH_HAS_DSP)
    {&tsr_match_kernel_dsp, NULL, false},
#endif
#if defined(TSR_MATCH_HAS_X86)
    {&tsr_match_kernel_avx2, has_avx2, true}, {&tsr_match_kernel_sse2, NULL, true},
#endif
#if defined(TSR_MATCH_HAS_NEON)
    {&tsr_match_kernel_neon, NULL, true},
#endif
    {&tsr_match_kernel_portable, NULL, true},
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

const struct tsr_match_kernel *tsr_match_kernel_for(const struct tsr_match_config *config)
{
    for (unsigned i = 0; i < sizeof kernels / sizeof kernels[0]; i++) {
        if (kernels[i].kernel == config->kernel && (kernels[i].is_complete || config->search_start_px >= 0)) {
            return config->kernel;
        }
    }
    return &tsr_match_kernel_portable;
}

const char *tsr_match_kernel_name(const struct tsr_match_kernel *kernel)
{
    return kernel->name;
}
