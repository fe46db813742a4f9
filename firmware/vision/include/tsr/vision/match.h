/*
 * Stereo matching of a rectified pair. The matcher consumes its frames: copy them
 * if they are needed afterwards. Of the modes (enum tsr_match_mode) the default is
 * TSR_MATCH_SAD, the sum of absolute differences:
 *
 *   P(x,y)   = clip(round(x-Sobel / 4)) + cap, 0 .. 2 cap     docs/math.md, eq. (10)
 *   A(x,y,d) = |P_left(x,y) - P_right(clip(x - s - d), y)|    eq. (11)
 *   S(x,y,d) = sum of A over window x window                  eq. (12)
 *   d*       = the lowest d with the least S(x,y,d)           eq. (14)
 *
 * then tests of texture (13), uniqueness (15) and left-right consistency (17),
 * and a sub-pixel offset (16) rounded to the nearest 1/16 px. s is
 * search_start_px; d + s is the disparity between the views, the map holds d.
 *
 * The whole image is matched. Pixel (x,y) searches the d in 0 .. D-1 whose right
 * pixel x - s - d lies in the right image; a pixel without any is invalid. A row
 * or column outside an image is the nearest inside.
 *
 * The portable C is the definition: every kernel for an instruction set gives the
 * same bits.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_H
#define TSR_VISION_MATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/base/disparity.h"
#include "tsr/base/image.h"
#include "tsr/base/status.h"

#define TSR_MATCH_WINDOW_MIN 5
#define TSR_MATCH_WINDOW_MAX 15
#define TSR_MATCH_DISPARITIES_MIN 16
#define TSR_MATCH_DISPARITIES_MAX TSR_DISPARITY_COUNT_MAX
#define TSR_MATCH_SCRATCH_ALIGN 4
/* Switches the uniqueness, texture or left-right test off. */
#define TSR_MATCH_TEST_OFF UINT8_C(255)

/* How two pixels are compared and their costs combined. */
enum tsr_match_mode {
    TSR_MATCH_SAD,    /* as above, 16-bit window sums */
    TSR_MATCH_SAD8,   /* the same where window^2 * 2 cap <= 255, so windows up to 11: window sums fit 8 bits */
    TSR_MATCH_CENSUS, /* census descriptors over the window: light may differ; docs/math.md, eq. (47) */
    TSR_MATCH_SMOOTH, /* census descriptors along three causal paths; eqs. (42) to (46) */
    TSR_MATCH_RAW,    /* gray values without prefilter, as the thesis has it; portable only; eq. (23) */
    TSR_MATCH_SSD,    /* their squared differences, its rival; portable only; eqs. (24), (25) */
};

/* An implementation of the matcher for one instruction set, see below. */
struct tsr_match_kernel;
struct tsr_match_method;

/* Zero in a field means the default named beside it. */
struct tsr_match_config {
    uint16_t width;             /* px, disparities .. TSR_IMAGE_WIDTH_MAX; no default */
    uint16_t height;            /* px, window (in smooth 7) .. TSR_IMAGE_HEIGHT_MAX; no default */
    uint16_t disparities;       /* D, searched disparities, 16 .. 128, a multiple of 8; default 32 */
    uint8_t window;             /* px, odd, 5 .. 15, in SAD8 .. 11; default 9; smooth has its own and ignores it */
    uint8_t mode;               /* enum tsr_match_mode; default TSR_MATCH_SAD */
    uint8_t prefilter_cap;      /* of SAD and SAD8: 1 .. 7, <= 63 / window (2 cap window <= 127), in SAD8 <= 127 /
                                   window^2; default the largest; others ignore it */
    uint8_t uniqueness_percent; /* 1 .. 100, or off; default 15, in smooth 25, in ssd 30 */
    uint8_t texture_min;        /* of SAD and SAD8: least sum of |P_left - cap| over the window, in units of window px,
                                   1 .. 127, or off; default 1; others ignore it */
    uint8_t lr_tolerance_px;    /* 1 .. 127, or off; default 1 */
    int16_t search_start_px;    /* s, -(width - disparities) .. width - disparities; default 0 */
    bool right_is_prefiltered;  /* the right frame holds P_right, as tsr/vision/prefilter.h makes it with the cap of
                                   tsr_match_prefilter_cap(); SAD and SAD8 only. Values above 2 cap count as 2 cap */
    const struct tsr_match_kernel *kernel; /* kept; default tsr_match_kernel_at(0) */
};

/*
 * The kernels that run on this machine, the fastest first, the portable one
 * last; null from there on. All give the same bits; a kernel leaves to the
 * portable one what it does not cover (the DSP kernel search_start_px < 0).
 */
const struct tsr_match_kernel *tsr_match_kernel_at(unsigned index);
const char *tsr_match_kernel_name(const struct tsr_match_kernel *kernel);

/* Content belongs to the module. */
struct tsr_match {
    struct tsr_match_config config; /* defaults filled in */
    struct tsr_gray left;
    struct tsr_gray right;
    uint16_t *map;
    uint8_t *scratch;
    const struct tsr_match_kernel *kernel;
    const struct tsr_match_method *method;
    uint16_t rows_done;
};

/* TSR_OK, or TSR_ERR_ARG with *field (may be null) naming the first bad field
 * ("config" for a null config). *field is a static string. */
enum tsr_status tsr_match_check(const struct tsr_match_config *config, const char **field);

/* The cap of the prefilter, defaults filled in: P is 0 .. 2 cap. 0 if the config does not check or its mode has none.
 */
uint8_t tsr_match_prefilter_cap(const struct tsr_match_config *config);

/* Scratch bytes of the SAD modes, of census and of smooth, from resolved values: column sums, or costs and paths, and
 * rows. The function gives those of any configuration, 0 if it does not check. */
#define TSR_MATCH_SCRATCH_LEN(width, disparities)                                                                      \
    ((size_t)(width) * ((size_t)(disparities) + 5u) + 4u * (size_t)(disparities) + 8u)
#define TSR_MATCH_CENSUS_SCRATCH_LEN(width, disparities, window)                                                       \
    (TSR_MATCH_SCRATCH_LEN(width, disparities) +                                                                       \
     ((size_t)(window) + 1u) * 2u * (2u * (size_t)(width) + (size_t)(disparities)))
#define TSR_MATCH_SMOOTH_SCRATCH_LEN(width, disparities)                                                               \
    ((size_t)(width) * (5u * (size_t)(disparities) + 11u) + 8u * (size_t)(disparities) + 8u)
size_t tsr_match_scratch_len(const struct tsr_match_config *config);

/*
 * The pair layout: both frames and the map in one buffer.
 *
 *     byte 0                        width bytes     width bytes
 *     pad row 0                    [ map row 0 ................. ]
 *       ...                        [ ...                         ]
 *     pad row window/2             [ map row window/2            ]
 *     frame row 0                  [ left row 0   | right row 0   ]  <- map row window/2 + 1
 *     frame row 1                  [ left row 1   | right row 1   ]
 *       ...
 *     frame row height - 1         [ left         | right         ]
 *
 * A row of the map takes the bytes of a row of both frames, and is written when
 * the frame row under it has been used for the last time.
 */
#define TSR_MATCH_PAIR_LEN(width, height, window)                                                                      \
    (2u * (size_t)(width) * ((size_t)(height) + (size_t)(window) / 2u + 1u))
size_t tsr_match_pair_len(const struct tsr_match_config *config);

/* The frames and the map [height][width] in a pair buffer of
 * tsr_match_pair_len(config) bytes, aligned to 2. The config must check. */
struct tsr_gray tsr_match_pair_left(uint8_t *pair, const struct tsr_match_config *config);
struct tsr_gray tsr_match_pair_right(uint8_t *pair, const struct tsr_match_config *config);
uint16_t *tsr_match_pair_map(uint8_t *pair);

/*
 * Begin matching a pair.
 *
 *   match        filled; kept until run returns TSR_OK or the work is given up
 *   config       borrowed (copied)
 *   left, right  [height][width] gray, consumed: the content is destroyed by run.
 *                Kept until run returns TSR_OK. They do not share bytes (their
 *                rows may interleave).
 *   map          [height][width] out, px, UQ12.4, 0 .. 16 (D - 1), counted from
 *                search_start_px on, or TSR_DISPARITY_INVALID; aligned to 2. Apart from the frames, or
 *                overlaying them so that row y of the map ends where row
 *                y - window/2 of either frame begins, or before (the pair layout).
 *   map_cap      elements available in map, >= width * height
 *   scratch      [scratch_cap] kept as the frames; aligned to
 *                TSR_MATCH_SCRATCH_ALIGN, apart from everything else
 *   scratch_cap  bytes, >= tsr_match_scratch_len(config)
 *
 * Returns TSR_OK; TSR_ERR_ARG for a null pointer, a bad field, a misaligned
 * pointer or a map that overlays a frame in another way; TSR_ERR_SIZE if a
 * frame is not width x height or its stride < width; TSR_ERR_NOBUF if a buffer
 * is too small. On error nothing is written, on TSR_OK only *match.
 */
enum tsr_status tsr_match_start(struct tsr_match *match, const struct tsr_match_config *config, struct tsr_gray left,
                                struct tsr_gray right, uint16_t *map, size_t map_cap, uint8_t *scratch,
                                size_t scratch_cap);

/*
 * The same for TSR_MATCH_SAD and TSR_MATCH_SAD8 alone, other modes being TSR_ERR_ARG. An image that never calls
 * tsr_match_start() is linked without the code of the other modes (about 12 KB on a Cortex-M4).
 */
enum tsr_status tsr_match_start_sad(struct tsr_match *match, const struct tsr_match_config *config,
                                    struct tsr_gray left, struct tsr_gray right, uint16_t *map, size_t map_cap,
                                    uint8_t *scratch, size_t scratch_cap);

/*
 * Continue for at most rows rows of work, of tsr_match_rows_total() in all:
 *
 *   SAD, SAD8          height prefilter rows, window/2 warm-up rows, height matched rows
 *   smooth             1 warm-up row, height matched rows
 *   others             window/2 warm-up rows, height matched rows
 *
 * A row of work is bounded by that of matched rows: with D = 32, in instructions
 * per pixel and disparity of a Cortex-M4, 9 (SAD, SAD8), 45 (census) or 38 (smooth)
 * with the DSP kernel, 50, 110 or 195 in portable C; docs/performance.md has more.
 *
 * The result does not depend on how the rows are divided among calls. Matched
 * row y of the map is final as soon as it is done.
 *
 * Returns TSR_AGAIN while rows are left, TSR_OK when the map is complete (and
 * from then on, doing nothing); TSR_ERR_ARG for a null match or rows = 0.
 */
enum tsr_status tsr_match_run(struct tsr_match *match, uint16_t rows);

/* Rows of work done since start, and in all. */
uint16_t tsr_match_rows_done(const struct tsr_match *match);
uint16_t tsr_match_rows_total(const struct tsr_match *match);

#endif
