/*
 * Path costs and the choice among their sums with MVE: sixteen disparities at
 * once, all of it in 8 bits.
 *
 * The costs that tsr_mve_cost_row() leaves are sums of three columns already, so
 * that a quarter of three rows of them is B, eq. (42). In the scratch are
 *
 *   above     path costs as match_census.h says
 *   before    zeros, read as above [1][W]: the source right of the row
 *   texture   uint8_t [W], the least of above [0] over d
 *   least     uint8_t [W + 1], that of above [1], the last one zero
 *   planes    struct tsr_mve_penalties [W], while a row is made: its descriptors have become costs
 *
 * and the path costs from the left and the sums S are on the stack, between
 * pads of 255.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_MVE

#include <stddef.h>
#include <string.h>

#include "match_mve.h"
#include "match_mve_search.h"

#define PAD TSR_MVE_GROUP
#define CLAIM_SHIFT 0u

/*
 * Before a step the pointers are those of the pixel before; a step moves them by
 * one. The first nine members are the registers that a step loads.
 *
 * Lane D of a pixel's path costs is lane 0 of the next one's. A step puts 255
 * there, and gives it back when it is that pixel's turn.
 */
struct walk {
    const struct tsr_mve_penalties *penalties;
    uint8_t *least_up;
    uint8_t *least_right; /* of the pixel to the right, which becomes the pixel's own */
    uint8_t *up;
    uint8_t *right;          /* likewise */
    const uint8_t *costs[3]; /* rows */
    uint32_t lanes;          /* D */
    uint8_t *left;
    uint8_t *sums;
    uint32_t least_left;
    uint32_t kept_up; /* lanes D */
    uint32_t kept_right;
};
_Static_assert(offsetof(struct walk, left) == 36 && offsetof(struct walk, least_left) == 44 &&
                   offsetof(struct walk, kept_up) == 48 && sizeof(struct tsr_mve_penalties) == 4,
               "words, as the step loads them");

/* clang-format off */
/* q4, q5, q6: least of the pixel before with the penalty of a jump, from the left, above and up-right; r3, r4: path
 * costs above and up-right. */
#define BEGIN_PIXEL                    \
    "ldm %[walk], {r0-r6, r8, r9}\n\t" \
    "ldr r10, [%[walk], #44]\n\t"      \
    "ldrb lr, [r0, #4]!\n\t"           \
    "add lr, r10\n\t"                  \
    "vdup.8 q4, lr\n\t"                \
    "ldrb lr, [r0, #1]\n\t"            \
    "ldrb r10, [r1, #1]!\n\t"          \
    "add lr, r10\n\t"                  \
    "vdup.8 q5, lr\n\t"                \
    "ldrb lr, [r0, #2]\n\t"            \
    "ldrb r10, [r2, #1]!\n\t"          \
    "add lr, r10\n\t"                  \
    "vdup.8 q6, lr\n\t"                \
    "add r3, r9\n\t"                   \
    "add r4, r9\n\t"                   \
    "add r5, r9\n\t"                   \
    "add r6, r9\n\t"                   \
    "add r8, r9\n\t"                   \
    "stm %[walk], {r0-r6, r8}\n\t"
/* Also in front of the path costs from up-right, where the last of the pixel's own go. */
#define SET_PADS                       \
    "ldrd r0, r1, [%[walk], #48]\n\t"  \
    "mvn r2, #0\n\t"                   \
    "strb r0, [r3]\n\t"                \
    "strb r1, [r4]\n\t"                \
    "ldrb r0, [r3, r9]\n\t"            \
    "ldrb r1, [r4, r9]\n\t"            \
    "strb r2, [r3, r9]\n\t"            \
    "strb r2, [r4, r9]\n\t"            \
    "strb r2, [r4, #-1]\n\t"           \
    "strd r0, r1, [%[walk], #48]\n\t"
/* B to the sums, and the path from the left: eqs. (42), (44). Lanes d - 1 of the next group (q3) are read before this
 * one takes their place. */
#define WALK_LEFT                      \
    "ldrd r0, r1, [%[walk], #36]\n\t"  \
    "ldr r2, [%[walk], #44]\n\t"       \
    "mvn r3, #0\n\t"                   \
    "vldrb.u8 q3, [r0, #-1]\n\t"       \
    "mov r10, %[near]\n\t"             \
    "dlstp.8 lr, r9\n"                 \
    "1:\n\t"                           \
    "vldrb.u8 q0, [r5], #16\n\t"       \
    "vldrb.u8 q1, [r6], #16\n\t"       \
    "vadd.i8 q0, q0, q1\n\t"           \
    "vldrb.u8 q2, [r8], #16\n\t"       \
    "vadd.i8 q0, q0, q2\n\t"           \
    "vldrb.u8 q1, [r0, #1]\n\t"        \
    "vshr.u8 q0, q0, #2\n\t"           \
    "vldrb.u8 q2, [r0]\n\t"            \
    "vmin.u8 q1, q1, q3\n\t"           \
    "vstrb.8 q0, [r1], #16\n\t"        \
    "vqadd.u8 q1, q1, r10\n\t"         \
    "vldrb.u8 q3, [r0, #15]\n\t"       \
    "vmin.u8 q1, q1, q2\n\t"           \
    "vsub.i8 q0, q0, r2\n\t"           \
    "vmin.u8 q1, q1, q4\n\t"           \
    "vadd.i8 q0, q0, q1\n\t"           \
    "vstrb.8 q0, [r0], #16\n\t"        \
    "vminv.u8 r3, q0\n\t"              \
    "letp lr, 1b\n\t"                  \
    "str r3, [%[walk], #44]\n\t"
/* The other two paths, eq. (44), and the sums of all, eq. (46). r6, r8: least of the pixels before, r2, r10: of this
 * one; q7: as q3 of WALK_LEFT. */
#define WALK_DOWN                      \
    "ldrd r6, r8, [%[walk], #4]\n\t"   \
    "ldrd r3, r4, [%[walk], #12]\n\t"  \
    "ldrd r0, r1, [%[walk], #36]\n\t"  \
    "ldrb r6, [r6]\n\t"                \
    "ldrb r8, [r8]\n\t"                \
    "mvn r2, #0\n\t"                   \
    "mvn r10, #0\n\t"                  \
    "mvn %[least], #0\n\t"             \
    "vldrb.u8 q7, [r3, #-1]\n\t"       \
    "sub r5, r4, r9\n\t"               \
    "vmov.8 q7[0], r2\n\t"             \
    "dlstp.8 lr, r9\n\t"               \
    "mov r9, %[near]\n"                \
    "2:\n\t"                           \
    "vldrb.u8 q1, [r3, #1]\n\t"        \
    "vmin.u8 q1, q1, q7\n\t"           \
    "vldrb.u8 q2, [r3]\n\t"            \
    "vqadd.u8 q1, q1, r9\n\t"          \
    "vldrb.u8 q7, [r3, #15]\n\t"       \
    "vmin.u8 q1, q1, q2\n\t"           \
    "vldrb.u8 q0, [r1]\n\t"            \
    "vsub.i8 q2, q0, r6\n\t"           \
    "vmin.u8 q1, q1, q5\n\t"           \
    "vldrb.u8 q3, [r4, #-1]\n\t"       \
    "vadd.i8 q1, q1, q2\n\t"           \
    "vldrb.u8 q2, [r4, #1]\n\t"        \
    "vminv.u8 r2, q1\n\t"              \
    "vstrb.8 q1, [r3], #16\n\t"        \
    "vmin.u8 q2, q2, q3\n\t"           \
    "vldrb.u8 q3, [r4], #16\n\t"       \
    "vqadd.u8 q2, q2, r9\n\t"          \
    "vsub.i8 q0, q0, r8\n\t"           \
    "vmin.u8 q2, q2, q3\n\t"           \
    "vldrb.u8 q3, [r0], #16\n\t"       \
    "vmin.u8 q2, q2, q6\n\t"           \
    "vadd.i8 q1, q1, q3\n\t"           \
    "vadd.i8 q2, q2, q0\n\t"           \
    "vstrb.8 q2, [r5], #16\n\t"        \
    "vadd.i8 q1, q1, q2\n\t"           \
    "vminv.u8 r10, q2\n\t"             \
    "vstrb.8 q1, [r1], #16\n\t"        \
    "vminv.u8 %[least], q1\n\t"        \
    "letp lr, 2b\n\t"                  \
    "ldrd r6, r8, [%[walk], #4]\n\t"   \
    "strb r2, [r6]\n\t"                \
    "strb r10, [r8, #-1]"
/* clang-format on */

/* The next pixel's paths and sums; the least sum. */
static inline unsigned walk_pixel(struct walk *walk)
{
    unsigned least;
    __asm volatile(BEGIN_PIXEL SET_PADS WALK_LEFT WALK_DOWN
                   : [least] "=&h"(least)
                   : [walk] "h"(walk), [near] "i"(TSR_MATCH_PENALTY_NEAR)
                   : "r0", "r1", "r2", "r3", "r4", "r5", "r6", "r8", "r9", "r10", "lr", "q0", "q1", "q2", "q3", "q4",
                     "q5", "q6", "q7", "cc", "memory");
    return least;
}

/* Path costs from the left and S of one pixel, from PAD on. */
struct lanes {
    uint8_t left[PAD + TSR_DISPARITY_COUNT_MAX + PAD];
    uint8_t sums[PAD + TSR_DISPARITY_COUNT_MAX + PAD];
};

/* A path that starts in this row comes from costs of 0, which add nothing, whatever the penalty: eq. (45). */
static struct walk begin_walk(const struct tsr_match *match, unsigned y, struct lanes *lanes)
{
    unsigned disparities = match->config.disparities;
    struct tsr_match_paths paths = tsr_match_share_paths(match);
    struct tsr_mve_penalties *penalties = (struct tsr_mve_penalties *)(void *)tsr_match_planes_at(match, y).left[0];
    uint8_t *least_up = tsr_match_share_scratch(match).texture;
    unsigned below = y + 1u < match->config.height ? y + 1u : y;
    memset(lanes, UINT8_MAX, sizeof *lanes);
    memset(lanes->left + PAD, 0, disparities);
    memset(paths.before, 0, disparities);
    if (y == 0) {
        memset(least_up, 0, match->config.width);
    }
    tsr_mve_find_penalties(match, y, penalties);
    return (struct walk){
        .penalties = penalties - 1,
        .least_up = least_up - 1,
        .least_right = paths.least[0],
        .up = paths.above[0] - disparities,
        .right = paths.above[1],
        .costs = {tsr_match_costs_at(match, y > 0 ? y - 1u : 0u) - disparities,
                  tsr_match_costs_at(match, y) - disparities, tsr_match_costs_at(match, below) - disparities},
        .lanes = disparities,
        .left = lanes->left + PAD,
        .sums = lanes->sums + PAD,
        .least_left = 0,
        .kept_up = paths.above[0][0],
        .kept_right = paths.above[1][disparities],
    };
}

/* What the pixels of a row are found out with. */
struct row {
    struct walk walk;
    struct mve_uniqueness uniqueness;
    struct tsr_mve_found found[TSR_MVE_FOUND_COUNT];
    uint16_t *claims;  /* of the next pixel's lane 0 */
    uint16_t *choices; /* of the next pixel */
    unsigned offered;  /* lanes that the next pixel can search, while they are not all */
};

/* The next pixels, up to eight. */
static inline __attribute__((always_inline)) void find_pixels(struct row *row, unsigned count, bool border)
{
    uint8_t *sums = row->walk.sums;
    uint16_t *claims = row->claims;
    struct tsr_mve_found *end = row->found + count;
    for (struct tsr_mve_found *next = row->found; next != end; next++) {
        unsigned least = walk_pixel(&row->walk);
        unsigned offered = row->walk.lanes;
        if (border && row->offered < offered) {
            offered = row->offered++;
            least = mve_find_least_sum(sums, offered);
        }
        *next = mve_search_sums(&row->uniqueness, sums, offered, claims++, CLAIM_SHIFT, least);
    }
    tsr_mve_choose(row->found, count, 0, 0, row->choices);
    row->claims = claims;
    row->choices += count;
}

static __attribute__((noinline)) void find_border_pixels(struct row *row, unsigned count)
{
    find_pixels(row, count, true);
}

static __attribute__((noinline)) void pass_pixels(struct walk *walk, unsigned count)
{
    for (unsigned x = 0; x < count; x++) {
        (void)walk_pixel(walk);
    }
}

void tsr_mve_smooth_row(const struct tsr_match *match, unsigned y)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_match_scratch scratch = tsr_match_share_scratch(match);
    unsigned start = (unsigned)config->search_start_px;
    unsigned border = start + config->disparities; /* all lanes can be searched from here */
    struct lanes lanes;
    struct row row = {.walk = begin_walk(match, y, &lanes),
                      .uniqueness = mve_uniqueness_of(config),
                      .claims = scratch.claims,
                      .choices = scratch.choices + start,
                      .offered = 1};
    memset(scratch.claims, 0xff, sizeof *scratch.claims * config->width);
    memset(scratch.choices, 0xff, sizeof *scratch.choices * start);
    pass_pixels(&row.walk, start);
    for (unsigned x = start; x < config->width; x += TSR_MVE_FOUND_COUNT) {
        unsigned left = config->width - x;
        unsigned count = left < TSR_MVE_FOUND_COUNT ? left : TSR_MVE_FOUND_COUNT;
        if (x < border) {
            find_border_pixels(&row, count);
        } else {
            find_pixels(&row, count, false);
        }
    }
    row.walk.up[row.walk.lanes] = (uint8_t)row.walk.kept_up;
    tsr_mve_write_row(match, y);
}
#endif
