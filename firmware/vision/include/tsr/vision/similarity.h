/*
 * Are two disparity maps of one view the same scene? The discard rule.
 *
 *   MSE     = mean of (a - b)^2 over pixels valid in both   docs/math.md, eq. (20)
 *   MSE_k   = mean of min((a - b)^2, clip^2) in block k      eq. (21)
 *   similar <=> fewer than min_blocks blocks have MSE_k > threshold   eq. (22)
 *
 * The MSE between maps as the reason to send or drop one is A. Tannouri's
 * (thesis, 2018); the blocks, the clip and every threshold are ours: the MSE of
 * the whole map is blind to an object of 2 % of the picture, and a few wild
 * mismatches of 30 px would outweigh it.
 *
 * A block counts when at least half of its pixels are valid in both maps; last
 * columns and rows that fill no block join the MSE but no block.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_SIMILARITY_H
#define TSR_VISION_SIMILARITY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

/* Zero in a field means the default named beside it. */
struct tsr_similarity_config {
    uint16_t width;        /* px, 16 .. TSR_IMAGE_WIDTH_MAX; no default */
    uint16_t height;       /* px, 16 .. TSR_IMAGE_HEIGHT_MAX; no default */
    uint8_t block_log2;    /* block side 2^k px, 2 .. 4; default 2 */
    uint8_t clip_q4;       /* |a - b| counts as at most this, px, UQ4.4, 1 .. 255; default 2 px */
    uint16_t threshold_q8; /* of MSE_k, px^2, UQ8.8, 1 .. clip_q4^2; default 3/4 clip^2 */
    uint16_t min_blocks;   /* blocks above it that make a difference, >= 1; default those that cover 128 px, or
                              width * height / 600 if that is more, at least 1 */
};

struct tsr_similarity_result {
    uint64_t squares_q8;       /* sum of (a - b)^2 over the pixels valid in both maps, px^2, UQ56.8 */
    uint32_t both_count;       /* these pixels */
    uint32_t one_count;        /* pixels valid in exactly one */
    uint16_t blocks;           /* blocks that count */
    uint16_t different_blocks; /* blocks with MSE_k > threshold */
};

/* Content belongs to the module. */
struct tsr_similarity {
    struct tsr_similarity_config config; /* defaults filled in */
    const uint16_t *a;
    const uint16_t *b;
    struct tsr_similarity_result sums;
    uint16_t rows_done;
};

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field
 * ("config" for a null config). *field is a static string. */
enum tsr_status tsr_similarity_check(const struct tsr_similarity_config *config, const char **field);

/*
 * Begin comparing two maps.
 *
 *   similarity  filled
 *   config      borrowed (copied)
 *   a, b        [height][width] in, px, UQ12.4 or TSR_DISPARITY_INVALID; kept
 *               until run returns TSR_OK; may be the same map
 *   map_cap     elements available in each, >= width * height
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer or a bad field; TSR_ERR_NOBUF
 * if map_cap is too small. On error nothing is written.
 */
enum tsr_status tsr_similarity_start(struct tsr_similarity *similarity, const struct tsr_similarity_config *config,
                                     const uint16_t *a, const uint16_t *b, size_t map_cap);

/*
 * Continue for at least one row of blocks and at most rows rows more than that,
 * about 27 instructions per pixel (Cortex-M4). The result does not depend on
 * how the rows are divided among calls.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when both maps have been read
 * (and from then on, doing nothing); TSR_ERR_ARG for a null pointer or rows = 0.
 */
enum tsr_status tsr_similarity_run(struct tsr_similarity *similarity, uint16_t rows);

uint16_t tsr_similarity_rows_done(const struct tsr_similarity *similarity);

/* Fill *result. TSR_OK; TSR_AGAIN (result untouched) if rows are left;
 * TSR_ERR_ARG for a null pointer. */
enum tsr_status tsr_similarity_get_result(const struct tsr_similarity *similarity,
                                          struct tsr_similarity_result *result);

/* Eq. (20): MSE, px^2, UQ24.8, rounded to nearest, ties up; 0 if both_count = 0. For reports: eq. (22) does without a
 * division of 64 bits, which is 700 bytes of library on a Cortex-M. */
static inline uint32_t tsr_similarity_mse_q8(const struct tsr_similarity_result *result)
{
    uint32_t count = result->both_count;
    return count == 0 ? 0 : (uint32_t)((result->squares_q8 + count / 2u) / count);
}

/* Eq. (22): true if the maps show the same scene, so the newer adds nothing. */
bool tsr_similarity_is_similar(const struct tsr_similarity_config *config, const struct tsr_similarity_result *result);

#endif
