/*
 * Comparison of two disparity maps block by block.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/vision/similarity.h"

#include <string.h>

#define SIDE_MIN 16
#define BLOCK_LOG2_MIN 2
#define BLOCK_LOG2_MAX 4
#define BLOCK_LOG2_DEFAULT 2
#define CLIP_DEFAULT_Q4 32
/* By default the blocks that make a difference cover this many pixels, or this part of the map if that is more. */
#define DIFFERENT_PIXELS 128u
#define DIFFERENT_PART 600u

static uint16_t default_min_blocks(const struct tsr_similarity_config *config)
{
    uint32_t part = (uint32_t)config->width * config->height / DIFFERENT_PART;
    uint32_t pixels = part > DIFFERENT_PIXELS ? part : DIFFERENT_PIXELS;
    uint32_t blocks = config->block_log2 <= BLOCK_LOG2_MAX ? pixels >> (2u * config->block_log2) : 0;
    return (uint16_t)(blocks > 0 ? blocks : 1u);
}

static struct tsr_similarity_config resolve(const struct tsr_similarity_config *config)
{
    struct tsr_similarity_config resolved = *config;
    resolved.block_log2 = config->block_log2 != 0 ? config->block_log2 : BLOCK_LOG2_DEFAULT;
    resolved.clip_q4 = config->clip_q4 != 0 ? config->clip_q4 : CLIP_DEFAULT_Q4;
    if (config->threshold_q8 == 0) {
        resolved.threshold_q8 = (uint16_t)((3 * resolved.clip_q4 * resolved.clip_q4 + 3) / 4);
    }
    if (config->min_blocks == 0) {
        resolved.min_blocks = default_min_blocks(&resolved);
    }
    return resolved;
}

/* Of resolved values. */
static const char *bad_field(const struct tsr_similarity_config *config)
{
    if (config->width < SIDE_MIN || config->width > TSR_IMAGE_WIDTH_MAX) {
        return "width";
    }
    if (config->height < SIDE_MIN || config->height > TSR_IMAGE_HEIGHT_MAX) {
        return "height";
    }
    if (config->block_log2 < BLOCK_LOG2_MIN || config->block_log2 > BLOCK_LOG2_MAX) {
        return "block_log2";
    }
    if (config->threshold_q8 > config->clip_q4 * config->clip_q4) {
        return "threshold_q8";
    }
    return NULL;
}

enum tsr_status tsr_similarity_check(const struct tsr_similarity_config *config, const char **field)
{
    const char *bad = "config";
    if (config != NULL) {
        struct tsr_similarity_config resolved = resolve(config);
        bad = bad_field(&resolved);
    }
    if (bad != NULL && field != NULL) {
        *field = bad;
    }
    return bad == NULL ? TSR_OK : TSR_ERR_ARG;
}

enum tsr_status tsr_similarity_start(struct tsr_similarity *similarity, const struct tsr_similarity_config *config,
                                     const uint16_t *a, const uint16_t *b, size_t map_cap)
{
    if (similarity == NULL || a == NULL || b == NULL || tsr_similarity_check(config, NULL) != TSR_OK) {
        return TSR_ERR_ARG;
    }
    if (map_cap < (size_t)config->width * config->height) {
        return TSR_ERR_NOBUF;
    }
    memset(similarity, 0, sizeof *similarity);
    similarity->config = resolve(config);
    similarity->a = a;
    similarity->b = b;
    return TSR_OK;
}

/* A rectangle of both maps. */
struct part {
    unsigned x;
    unsigned y;
    unsigned width;
    unsigned height;
};

/* Clipped squares in 1/256 px^2 over the pixels valid in both maps. */
struct part_sums {
    uint32_t clipped_q8;
    uint32_t both_count;
};

/* Adds the part to the sums of the whole map, and gives its own. */
static struct part_sums compare_part(struct tsr_similarity *similarity, struct part part)
{
    size_t stride = similarity->config.width;
    uint32_t clip_q4 = similarity->config.clip_q4;
    struct part_sums sums = {0, 0};
    for (unsigned y = part.y; y < part.y + part.height; y++) {
        for (unsigned x = part.x; x < part.x + part.width; x++) {
            uint32_t a = similarity->a[y * stride + x];
            uint32_t b = similarity->b[y * stride + x];
            if (a == TSR_DISPARITY_INVALID || b == TSR_DISPARITY_INVALID) {
                similarity->sums.one_count += a != b ? 1u : 0u;
                continue;
            }
            uint32_t apart_q4 = a > b ? a - b : b - a;
            uint32_t clipped_q4 = apart_q4 < clip_q4 ? apart_q4 : clip_q4;
            similarity->sums.squares_q8 += (uint64_t)apart_q4 * apart_q4;
            sums.clipped_q8 += clipped_q4 * clipped_q4;
            sums.both_count++;
        }
    }
    similarity->sums.both_count += sums.both_count;
    return sums;
}

/* One row of blocks, or the last rows that fill none. */
static void compare_block_row(struct tsr_similarity *similarity)
{
    const struct tsr_similarity_config *config = &similarity->config;
    unsigned side = 1u << config->block_log2;
    unsigned rows_left = (unsigned)config->height - similarity->rows_done;
    struct part part = {0, similarity->rows_done, side, rows_left < side ? rows_left : side};
    for (; part.x + side <= config->width; part.x += side) {
        struct part_sums sums = compare_part(similarity, part);
        if (part.height == side && 2u * sums.both_count >= side * side) {
            similarity->sums.blocks++;
            if (sums.clipped_q8 > config->threshold_q8 * sums.both_count) {
                similarity->sums.different_blocks++;
            }
        }
    }
    part.width = config->width - part.x;
    (void)compare_part(similarity, part);
    similarity->rows_done = (uint16_t)(similarity->rows_done + part.height);
}

enum tsr_status tsr_similarity_run(struct tsr_similarity *similarity, uint16_t rows)
{
    if (similarity == NULL || rows == 0) {
        return TSR_ERR_ARG;
    }
    unsigned height = similarity->config.height;
    unsigned end = (unsigned)similarity->rows_done + rows;
    while (similarity->rows_done < height && similarity->rows_done < end) {
        compare_block_row(similarity);
    }
    return similarity->rows_done < height ? TSR_AGAIN : TSR_OK;
}

uint16_t tsr_similarity_rows_done(const struct tsr_similarity *similarity)
{
    return similarity->rows_done;
}

enum tsr_status tsr_similarity_get_result(const struct tsr_similarity *similarity, struct tsr_similarity_result *result)
{
    if (similarity == NULL || result == NULL) {
        return TSR_ERR_ARG;
    }
    if (similarity->rows_done < similarity->config.height) {
        return TSR_AGAIN;
    }
    *result = similarity->sums;
    return TSR_OK;
}

bool tsr_similarity_is_similar(const struct tsr_similarity_config *config, const struct tsr_similarity_result *result)
{
    if (result == NULL || tsr_similarity_check(config, NULL) != TSR_OK) {
        return false;
    }
    return result->different_blocks < resolve(config).min_blocks;
}
