/*
 * Census descriptors with MVE, sixteen pixels at once.
 *
 * A neighbour is greater if and only if the halved difference of centre and
 * neighbour is negative: VHSUB leaves that in the top bit, where VSRI takes it
 * from. Which bit of a plane is whose does not matter.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <arm_mve.h>
#include <string.h>

#include "match_mve.h"

#define PIXELS ((int)TSR_MVE_GROUP)
#define REACH 2 /* rows and columns around the pixel */
#define ROWS (2 * REACH + 1)
#define AROUND (2 * PIXELS)

struct planes {
    uint8x16_t cross;
    uint8x16_t knight;
};

/* Bit `place` of a plane, counted from the top; the bits below it are free. */
#define COMPARE(bits, centre, neighbour, place) vsriq_n_u8(bits, vhsubq_u8(centre, vldrbq_u8(neighbour)), place)

/* Both planes of the pixels from x on: docs/math.md, eq. (40). */
static inline struct planes describe(const uint8_t *const rows[ROWS], int x)
{
    const uint8_t *row = rows[REACH] + x;
    uint8x16_t centre = vldrbq_u8(row);
    struct planes planes;
    planes.cross = vhsubq_u8(centre, vldrbq_u8(rows[0] + x));
    planes.cross = COMPARE(planes.cross, centre, rows[1] + x, 1);
    planes.cross = COMPARE(planes.cross, centre, row - 2, 2);
    planes.cross = COMPARE(planes.cross, centre, row - 1, 3);
    planes.cross = COMPARE(planes.cross, centre, row + 1, 4);
    planes.cross = COMPARE(planes.cross, centre, row + 2, 5);
    planes.cross = COMPARE(planes.cross, centre, rows[3] + x, 6);
    planes.cross = COMPARE(planes.cross, centre, rows[4] + x, 7);
    planes.knight = vhsubq_u8(centre, vldrbq_u8(rows[0] + x - 1));
    planes.knight = COMPARE(planes.knight, centre, rows[0] + x + 1, 1);
    planes.knight = COMPARE(planes.knight, centre, rows[1] + x - 2, 2);
    planes.knight = COMPARE(planes.knight, centre, rows[1] + x + 2, 3);
    planes.knight = COMPARE(planes.knight, centre, rows[3] + x - 2, 4);
    planes.knight = COMPARE(planes.knight, centre, rows[3] + x + 2, 5);
    planes.knight = COMPARE(planes.knight, centre, rows[4] + x - 1, 6);
    planes.knight = COMPARE(planes.knight, centre, rows[4] + x + 1, 7);
    return planes;
}

/* The same at an end of the rows, with a frame of nearest pixels around the image. Offsets count from the sixteen
 * pixels, so that they fit a byte and a sign. */
static __attribute__((noinline)) struct planes describe_at_edge(const uint8_t *const rows[ROWS], int x, int last)
{
    uint8_t around[ROWS][AROUND];
    const uint8_t *inside[ROWS];
    int8x16_t first = vdupq_n_s8((int8_t)(x < REACH ? -x : -REACH));
    int8x16_t end = vdupq_n_s8((int8_t)(last - x < AROUND ? last - x : AROUND));
    int8x16_t near = vaddq_n_s8(vreinterpretq_s8_u8(vidupq_n_u8(0, 1)), -REACH);
    int8x16_t far = vaddq_n_s8(near, PIXELS);
    uint8x16_t near_columns = vreinterpretq_u8_s8(vsubq_s8(vmaxq_s8(vminq_s8(near, end), first), first));
    uint8x16_t far_columns = vreinterpretq_u8_s8(vsubq_s8(vmaxq_s8(vminq_s8(far, end), first), first));
    for (unsigned j = 0; j < ROWS; j++) {
        const uint8_t *from = rows[j] + (x < REACH ? 0 : x - REACH);
        vstrbq_u8(around[j], vldrbq_gather_offset_u8(from, near_columns));
        vstrbq_u8(around[j] + PIXELS, vldrbq_gather_offset_u8(from, far_columns));
        inside[j] = around[j] + REACH;
    }
    return describe(inside, 0);
}

static inline struct planes describe_anywhere(const uint8_t *const rows[ROWS], int x, int last)
{
    bool inside = x >= REACH && x + PIXELS - 1 + REACH <= last;
    return inside ? describe(rows, x) : describe_at_edge(rows, x, last);
}

static void find_rows(const struct tsr_gray *frame, unsigned y, const uint8_t *rows[ROWS])
{
    for (int i = 0; i < ROWS; i++) {
        int row = (int)y + i - REACH;
        row = row < 0 ? 0 : row < frame->height ? row : frame->height - 1;
        rows[i] = frame->pixels + (size_t)frame->stride * (unsigned)row;
    }
}

/* The last pixels may be described twice: widths are at least 16. */
static void describe_left(const struct tsr_match *match, unsigned y, const struct tsr_match_planes *planes)
{
    int last = match->config.width - 1;
    const uint8_t *rows[ROWS];
    find_rows(&match->left, y, rows);
    for (int x = 0; x <= last; x += PIXELS) {
        int at = x + PIXELS - 1 <= last ? x : last + 1 - PIXELS;
        struct planes found = describe_anywhere(rows, at, last);
        vstrbq_u8(planes->left[0] + at, found.cross);
        vstrbq_u8(planes->left[1] + at, found.knight);
    }
}

/* Entry k = W - 1 - s - column, so columns from the right; behind column 0 its copies follow. */
static void describe_right(const struct tsr_match *match, unsigned y, const struct tsr_match_planes *planes)
{
    int last = match->config.width - 1;
    int first_k = last - match->config.search_start_px; /* of column 0, at least 15 */
    const uint8_t *rows[ROWS];
    find_rows(&match->right, y, rows);
    for (int k = 0; k <= first_k; k += PIXELS) {
        int at = k + PIXELS - 1 <= first_k ? k : first_k + 1 - PIXELS;
        struct planes found = describe_anywhere(rows, first_k - at - (PIXELS - 1), last);
        uint8x16_t mirrored = vsubq_u8(vdupq_n_u8(PIXELS - 1), vidupq_n_u8(0, 1));
        vstrbq_scatter_offset_u8(planes->right[0] + at, mirrored, found.cross);
        vstrbq_scatter_offset_u8(planes->right[1] + at, mirrored, found.knight);
    }
    size_t copies = (size_t)(last + match->config.disparities - first_k);
    for (unsigned plane = 0; plane < TSR_MATCH_CENSUS_PLANES; plane++) {
        memset(planes->right[plane] + first_k + 1, planes->right[plane][first_k], copies);
    }
}

void tsr_mve_describe_row(const struct tsr_match *match, unsigned y)
{
    struct tsr_match_planes planes = tsr_match_planes_at(match, y);
    describe_left(match, y, &planes);
    describe_right(match, y, &planes);
}
#endif
