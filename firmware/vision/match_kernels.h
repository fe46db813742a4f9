/*
 * The kernels for instruction sets, and where a build has them.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_KERNELS_H
#define TSR_VISION_MATCH_KERNELS_H

#include <stdbool.h>

#include "match_census.h"

/* Cortex-M55, M85: MVE with integers, and the low-overhead loops that come with it in Armv8.1-M. */
#if defined(__ARM_FEATURE_MVE)
#define TSR_MATCH_HAS_MVE
extern const struct tsr_match_kernel tsr_match_kernel_mve;
extern const struct tsr_match_census_kernel tsr_match_census_mve;
#endif

/* Cortex-M4, M7, M33: the DSP extension's parallel arithmetic (ARMv7-M ARM, A4.4.3), in Thumb state. */
#if defined(__ARM_FEATURE_SIMD32) && defined(__thumb2__) && !defined(__ARM_ARCH_7A__)
#define TSR_MATCH_HAS_DSP
extern const struct tsr_match_kernel tsr_match_kernel_dsp;
extern const struct tsr_match_census_kernel tsr_match_census_dsp;
#endif

/* SSE2 belongs to x86-64 (AMD64 ABI); AVX2 is asked for when the program runs. */
#if defined(__x86_64__)
#define TSR_MATCH_HAS_X86
extern const struct tsr_match_kernel tsr_match_kernel_sse2;
extern const struct tsr_match_kernel tsr_match_kernel_avx2;
extern const struct tsr_match_census_kernel tsr_match_census_sse2;
extern const struct tsr_match_census_kernel tsr_match_census_avx2;
#endif

/* Advanced SIMD belongs to AArch64 (Arm ARM, A1.5). */
#if defined(__aarch64__)
#define TSR_MATCH_HAS_NEON
extern const struct tsr_match_kernel tsr_match_kernel_neon;
extern const struct tsr_match_census_kernel tsr_match_census_neon;
#endif

#endif
