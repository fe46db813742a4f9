/*
 * The model of pictures: bands of blocks over one range coder, and the filter
 * of the decoder, docs/codec.md, 5.2 and 5.6 to 5.8.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_CODEC_PICTURE_BLOCK_H
#define TSR_CODEC_PICTURE_BLOCK_H

#include <stddef.h>

#include "range_port.h"
#include "tsr/codec/picture.h"

/* A picture that has cost this much more than a byte a pixel is only predicted until it is cheap again. */
#define TSR_PICTURE_SLACK_LEN 256u

/* What contexts start from, docs/codec.md, 5.7. */
extern const uint16_t tsr_picture_prior[TSR_PICTURE_CONTEXT_COUNT];

/*
 * The scratch: rows of 8 * blocks pixels, then a byte a block of each kind.
 *
 *   rows 0, 1   the two rows above the band, decoded, before smoothing
 *   rows 2..9   the band: the encoder's source, which blocks replace by decoded ones
 *   modes, lasts, activities   of the block above, replaced from the left by this band's
 *   limits[2]   of the band in the rows and of the one above it: strength of smoothing
 */
struct tsr_picture_rows {
    size_t blocks;
    size_t stride;
    uint8_t *pixels;
    uint8_t *modes, *lasts, *activities;
    uint8_t *limits, *limits_above;
};

struct tsr_picture_rows tsr_picture_rows_of(const struct tsr_picture_model *model);

/* Forget everything; scratch and info are set by the caller. */
void tsr_picture_model_reset(struct tsr_picture_model *model);

/* Which neighbours of a block there are to learn from. */
struct tsr_picture_known {
    bool left, above;
};

/* Code block x of the band in rows 2..9. */
void tsr_picture_code_block(struct tsr_picture_model *model, const struct tsr_range_port *port,
                            const struct tsr_picture_rows *rows, size_t x, struct tsr_picture_known known);

/* The last two rows of the band become those above the next. */
void tsr_picture_keep_last_rows(const struct tsr_picture_rows *rows);

/* Code the band in rows 2..9, whose step differs by change from the band's above, and step to the next. */
void tsr_picture_code_band(struct tsr_picture_model *model, const struct tsr_range_port *port, int change);

/* How far a neighbour may pull at a pixel, in 1/8 gray level: a quarter of the step, 0 .. 234. */
static inline uint8_t tsr_picture_limit_of(uint32_t step_q6)
{
    return (uint8_t)((step_q6 + 128u) >> 8);
}

/* A row of one block, and what pulls at it. */
struct tsr_picture_line {
    const uint8_t *here;
    const uint8_t *above, *below; /* the row itself where there is none */
    bool has_left, has_right;     /* pixels beside it */
    uint8_t limit;                /* of the block */
    uint8_t y;                    /* within it, 0 .. 7 */
    uint8_t count;                /* pixels, 1 .. 8 */
};

/* Decoder: smooth them into out[count]. */
void tsr_picture_smooth_line(const struct tsr_picture_line *line, uint8_t *out);

/* Decoder: smooth row y, which and whose neighbours are in the scratch, into out[width]. */
void tsr_picture_smooth_row(const struct tsr_picture_model *model, unsigned y, uint8_t *out);

#endif
