/*
 * Any configuration, buffers and pixels for the matcher: the status is one that
 * match.h documents, an error touches nothing, and what starts runs inside its
 * buffers to the portable kernel's map, however its rows are divided, with
 * every kernel, and with the map apart from the frames or over them.
 *
 *   tools/fuzz vision_match
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "match_allowed.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

#ifndef FUZZ_LANES_MAX
#define FUZZ_LANES_MAX 90000u /* pixels times disparities that are matched: enough, and quick */
#endif
#define FUZZ_FILL 0xa5

/* What is drawn, 0 behind its end. */
struct fuzz_input {
    const uint8_t *bytes;
    size_t len;
};

/* Where everything lies: offsets into one block of exactly len bytes, and scratch in another. */
struct fuzz_layout {
    size_t len;
    size_t view_at[2];
    size_t map_at;
    uint16_t stride[2];
    uint8_t drawing;  /* what the views show */
    uint8_t division; /* of the rows among calls */
};

/* The buffers as tsr_match_start() takes them. */
struct fuzz_call {
    struct tsr_gray views[2];
    uint16_t *map;
    size_t map_cap;
    uint8_t *scratch;
    size_t scratch_cap;
};

static void require_match(int condition)
{
    if (!condition) {
        abort();
    }
}

static uint8_t take8(struct fuzz_input *input)
{
    if (input->len == 0) {
        return 0;
    }
    input->len--;
    return *input->bytes++;
}

static uint16_t take16(struct fuzz_input *input)
{
    uint8_t low = take8(input);
    return (uint16_t)(low | take8(input) << 8);
}

/* Exactly len bytes, so that a sanitizer sees every overrun. */
static uint8_t *filled_block(size_t len)
{
    uint8_t *block = malloc(len > 0 ? len : 1u);
    require_match(block != NULL);
    memset(block, FUZZ_FILL, len);
    return block;
}

static int is_filled(const void *block, size_t len)
{
    for (size_t i = 0; i < len; i++) {
        if (((const uint8_t *)block)[i] != FUZZ_FILL) {
            return 0;
        }
    }
    return 1;
}

/* Any bytes in every field, or fields of which most configurations check. */
static struct tsr_match_config take_config(struct fuzz_input *input, int anything)
{
    struct tsr_match_config config = {.width = take16(input),
                                      .height = take16(input),
                                      .disparities = take16(input),
                                      .window = take8(input),
                                      .mode = take8(input),
                                      .prefilter_cap = take8(input),
                                      .uniqueness_percent = take8(input),
                                      .texture_min = take8(input),
                                      .lr_tolerance_px = take8(input),
                                      .search_start_px = (int16_t)take16(input)};
    if (anything) {
        return config;
    }
    config.mode = (uint8_t)(config.mode % 6u);
    config.window = (uint8_t)(5u + 2u * (config.window % 6u));
    config.disparities = (uint16_t)(16u + 8u * (config.disparities % 15u));
    config.width =
        (uint16_t)(config.disparities + (config.width % 8u == 0 ? config.width / 8u % 600u : config.width % 70u));
    config.height = (uint16_t)(config.window + config.height % 24u);
    config.prefilter_cap = (uint8_t)(config.prefilter_cap % 8u);
    const int room = config.width - config.disparities;
    const int drawn = config.search_start_px % 4 == 0     ? config.search_start_px / 4
                      : (config.search_start_px & 4) != 0 ? room
                                                          : -room;
    config.search_start_px = (int16_t)(drawn < -room ? -room : drawn > room ? room : drawn);
    return config;
}

static size_t view_len(const struct tsr_match_config *config, uint16_t stride)
{
    return (size_t)stride * (config->height - 1u) + config->width;
}

/* Views one behind the other or row beside row, and the map anywhere: behind them, or at a distance before the first
 * pixel that is about what the pair layout has. */
static struct fuzz_layout take_layout(struct fuzz_input *input, const struct tsr_match_config *config)
{
    const uint8_t kind = take8(input);
    const size_t width = config->width;
    const size_t map_len = 2u * width * config->height;
    const size_t above = 2u * width * (match_window_of(config) / 2u + 1u);
    struct fuzz_layout layout = {.drawing = take8(input), .division = take8(input)};
    const uint8_t gap = take8(input);
    const uint8_t shift = take8(input);
    if (kind % 2u == 0) { /* interleaved, at least two widths per row */
        layout.stride[0] = layout.stride[1] = (uint16_t)(2u * width + gap % 9u);
        layout.view_at[1] = width + gap % 3u * (gap % 9u) / 2u;
        layout.len = layout.view_at[1] + view_len(config, layout.stride[1]);
    } else {
        layout.stride[0] = (uint16_t)(width + gap % 9u);
        layout.stride[1] = (uint16_t)(kind % 4u == 1 ? 2u * width + gap % 5u : width + gap % 7u);
        layout.view_at[1] = view_len(config, layout.stride[0]) + gap % 4u;
        layout.len = layout.view_at[1] + view_len(config, layout.stride[1]);
    }
    const size_t before = (kind & 8u) != 0 ? above + shift % 8u - 4u : map_len + shift % 4u;
    if ((kind & 4u) != 0) { /* the map starts the block */
        layout.view_at[0] += before;
        layout.view_at[1] += before;
        layout.len += before;
    } else {
        layout.map_at = layout.len + shift % 5u;
        layout.map_at += shift < 192 ? layout.map_at % 2u : 0u;
    }
    if (layout.len < layout.map_at + map_len) {
        layout.len = layout.map_at + map_len;
    }
    return layout;
}

/* Row y of the map ends where row y - window/2 of the view begins, or before; or it shares no byte. */
static int is_overlay_allowed(const struct tsr_match_config *config, const struct fuzz_layout *layout, unsigned which)
{
    const size_t row_len = 2u * (size_t)config->width;
    const size_t view_at = layout->view_at[which];
    const unsigned radius = match_window_of(config) / 2u;
    int is_behind = 1;
    for (size_t y = radius; y < config->height; y++) {
        const size_t row_at = view_at + layout->stride[which] * (y - radius);
        is_behind = is_behind && layout->map_at + row_len * (y + 1u) <= row_at;
    }
    return is_behind || layout->map_at + row_len * config->height <= view_at ||
           layout->map_at >= view_at + view_len(config, layout->stride[which]);
}

static uint8_t draw_pixel(struct fuzz_input content, unsigned drawing, unsigned which, unsigned x, unsigned y)
{
    const uint32_t seen = x + (which != 0 ? drawing >> 3 : 0u);
    const uint32_t hash = (seen / 2u * 2654435761u ^ y * 2246822519u) * 3266489917u;
    switch (drawing % 8u) {
    case 0: return content.len > 0 ? content.bytes[(y * 31u + seen) % content.len] : 0;
    case 1: return (uint8_t)(hash >> 24);
    case 2: return (uint8_t)((x * 2654435761u ^ y * 2246822519u ^ which * 3266489917u) * 668265263u >> 24);
    case 3: return (x + y + which) % 2u != 0 ? 255 : 0;
    case 4: return (x / 2u % 2u != 0) == (which != 0) ? 255 : 0; /* the largest differences */
    case 5: return (uint8_t)(which != 0 ? 255 : 0);
    case 6: return (uint8_t)(seen / 3u % 2u * 255u);
    default: return (uint8_t)drawing;
    }
}

static void draw_views(struct fuzz_input content, const struct fuzz_layout *layout, const struct fuzz_call *call)
{
    for (unsigned which = 0; which < 2; which++) {
        const struct tsr_gray *view = &call->views[which];
        for (unsigned y = 0; y < view->height; y++) {
            for (unsigned x = 0; x < view->width; x++) {
                view->pixels[(size_t)y * view->stride + x] = draw_pixel(content, layout->drawing, which, x, y);
            }
        }
    }
}

static struct fuzz_call place_call(const struct tsr_match_config *config, const struct fuzz_layout *layout,
                                   uint8_t *block, uint8_t *scratch)
{
    struct fuzz_call call = {.map = (uint16_t *)(void *)(block + layout->map_at),
                             .map_cap = (size_t)config->width * config->height,
                             .scratch = scratch,
                             .scratch_cap = tsr_match_scratch_len(config)};
    for (unsigned which = 0; which < 2; which++) {
        call.views[which] =
            (struct tsr_gray){block + layout->view_at[which], config->width, config->height, layout->stride[which]};
    }
    return call;
}

static enum tsr_status start_call(struct tsr_match *match, const struct tsr_match_config *config,
                                  const struct fuzz_call *call, int sad_alone)
{
    return (sad_alone ? tsr_match_start_sad : tsr_match_start)(match, config, call->views[0], call->views[1], call->map,
                                                               call->map_cap, call->scratch, call->scratch_cap);
}

/* The map in new buffers, to be freed. */
static uint16_t *match_with(const struct tsr_match_config *config, const struct fuzz_layout *layout,
                            struct fuzz_input content, uint16_t rows, int sad_alone)
{
    const size_t map_len = 2u * (size_t)config->width * config->height;
    const size_t scratch_len = tsr_match_scratch_len(config);
    uint8_t *block = filled_block(layout->len);
    uint8_t *scratch = filled_block(scratch_len);
    const struct fuzz_call call = place_call(config, layout, block, scratch);
    struct tsr_match match;
    uint16_t total = 0;
    require_match(start_call(&match, config, &call, sad_alone) == TSR_OK);
    require_match(is_filled(block, layout->len) && is_filled(scratch, scratch_len));
    draw_views(content, layout, &call);
    require_match(tsr_match_run(&match, 0) == TSR_ERR_ARG && tsr_match_rows_done(&match) == 0);
    for (enum tsr_status status = TSR_AGAIN; status == TSR_AGAIN;) {
        status = tsr_match_run(&match, rows);
        total = tsr_match_rows_total(&match);
        require_match(status == (tsr_match_rows_done(&match) < total ? TSR_AGAIN : TSR_OK));
    }
    require_match(tsr_match_rows_done(&match) == total);
    uint16_t *map = malloc(map_len);
    require_match(map != NULL);
    memcpy(map, call.map, map_len);
    require_match(tsr_match_run(&match, rows) == TSR_OK && memcmp(map, call.map, map_len) == 0);
    free(block);
    free(scratch);
    return map;
}

static void expect_values(const struct tsr_match_config *config, const uint16_t *map)
{
    const unsigned disparities = config->disparities != 0 ? config->disparities : 32u;
    for (size_t i = 0; i < (size_t)config->width * config->height; i++) {
        const int start = config->search_start_px;
        const int column = (int)(i % config->width);
        const int nearest = map[i] / 16 + start; /* the columns on both sides of the offset; one of them is met */
        require_match(map[i] == TSR_DISPARITY_INVALID || (map[i] <= 16u * (disparities - 1u) && column - nearest >= 0 &&
                                                          column - nearest - 1 < (int)config->width));
    }
}

/* Every kernel, in this layout and in the pair layout, against the portable kernel's map. */
static void compare_kernels(struct tsr_match_config config, const struct fuzz_layout *layout, struct fuzz_input content)
{
    const size_t map_len = 2u * (size_t)config.width * config.height;
    const size_t above = 2u * (size_t)config.width * (match_window_of(&config) / 2u + 1u);
    const uint16_t pair_stride = (uint16_t)(2u * config.width);
    const struct fuzz_layout pair = {.len = tsr_match_pair_len(&config),
                                     .view_at = {above, above + config.width},
                                     .stride = {pair_stride, pair_stride},
                                     .drawing = layout->drawing};
    const struct fuzz_layout apart = {.len = 2u * view_len(&config, config.width) + map_len,
                                      .view_at = {map_len, map_len + view_len(&config, config.width)},
                                      .stride = {config.width, config.width},
                                      .drawing = layout->drawing};
    unsigned count = 0;
    while (tsr_match_kernel_at(count) != NULL) {
        count++;
    }
    config.kernel = tsr_match_kernel_at(count - 1u);
    uint16_t *wanted = match_with(&config, &apart, content, UINT16_MAX, 0);
    expect_values(&config, wanted);
    for (unsigned i = 0; i < count; i++) {
        config.kernel = tsr_match_kernel_at(i);
        uint16_t *got = match_with(&config, layout, content, (uint16_t)(1u + layout->division % 40u), 0);
        require_match(memcmp(got, wanted, map_len) == 0);
        free(got);
        const int sad_alone = config.mode <= TSR_MATCH_SAD8 && layout->division > 127;
        got = match_with(&config, &pair, content, (uint16_t)(1u + layout->division % 7u), sad_alone);
        require_match(memcmp(got, wanted, map_len) == 0);
        free(got);
    }
    free(wanted);
}

/* The call with one thing wrong, or none: how 0 is nothing. Returns the status that is documented for it. */
static enum tsr_status spoil_call(struct fuzz_call *call, uint8_t how)
{
    struct tsr_gray *view = &call->views[how / 16u % 2u];
    switch (how % 16u) {
    case 1: view->pixels = NULL; return TSR_ERR_ARG;
    case 2: call->map = NULL; return TSR_ERR_ARG;
    case 3: call->scratch = NULL; return TSR_ERR_ARG;
    case 4: call->scratch += 1u + how / 16u % 3u; return TSR_ERR_ARG;
    case 5: view->width--; return TSR_ERR_SIZE;
    case 6: view->height++; return TSR_ERR_SIZE;
    case 7: view->stride = (uint16_t)(view->width - 1u); return TSR_ERR_SIZE;
    case 8: call->map_cap--; return TSR_ERR_NOBUF;
    case 9: call->scratch_cap--; return TSR_ERR_NOBUF;
    case 10: call->map_cap = 0; return TSR_ERR_NOBUF;
    default: return TSR_OK;
    }
}

/* Whether the buffers, as they are or spoilt, are refused as documented. An error leaves everything as it was. */
static int is_started(const struct tsr_match_config *config, const struct fuzz_layout *layout, uint8_t how)
{
    const size_t scratch_len = tsr_match_scratch_len(config);
    uint8_t *block = filled_block(layout->len);
    uint8_t *scratch = filled_block(scratch_len);
    struct fuzz_call call = place_call(config, layout, block, scratch);
    const int is_placed =
        layout->map_at % 2u == 0 && is_overlay_allowed(config, layout, 0) && is_overlay_allowed(config, layout, 1);
    const enum tsr_status spoilt = spoil_call(&call, how);
    struct tsr_match match;
    memset(&match, FUZZ_FILL, sizeof match);
    const enum tsr_status status = start_call(&match, config, &call, 0);
    require_match(status == spoilt || (!is_placed && status == TSR_ERR_ARG));
    require_match(is_placed || status != TSR_OK);
    require_match(status == TSR_OK || is_filled(&match, sizeof match));
    require_match(is_filled(block, layout->len) && is_filled(scratch, scratch_len));
    require_match(start_call(NULL, config, &call, 0) == TSR_ERR_ARG);
    require_match(config->mode <= TSR_MATCH_SAD8 || start_call(&match, config, &call, 1) == TSR_ERR_ARG);
    free(block);
    free(scratch);
    return status == TSR_OK;
}

static void refuse_config(const struct tsr_match_config *config)
{
    uint8_t block[64] = {0};
    const struct tsr_gray view = {block, config->width, config->height, config->width};
    struct tsr_match match;
    memset(&match, FUZZ_FILL, sizeof match);
    require_match(tsr_match_scratch_len(config) == 0 && tsr_match_pair_len(config) == 0);
    require_match(tsr_match_start(&match, config, view, view, (uint16_t *)(void *)block, SIZE_MAX, block, SIZE_MAX) ==
                  TSR_ERR_ARG);
    require_match(tsr_match_start_sad(&match, config, view, view, (uint16_t *)(void *)block, SIZE_MAX, block,
                                      SIZE_MAX) == TSR_ERR_ARG);
    require_match(is_filled(&match, sizeof match));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    struct fuzz_input input = {bytes, len};
    const uint8_t how = take8(&input);
    const struct tsr_match_config config = take_config(&input, how >= 224);
    const char *field = NULL;
    const enum tsr_status checked = tsr_match_check(&config, &field);
    require_match(checked == (match_is_allowed(&config) ? TSR_OK : TSR_ERR_ARG) &&
                  (checked == TSR_OK) == (field == NULL));
    if (checked != TSR_OK) {
        refuse_config(&config);
        return 0;
    }
    const size_t disparities = config.disparities != 0 ? config.disparities : 32u;
    if ((size_t)config.width * config.height * disparities > FUZZ_LANES_MAX) {
        return 0;
    }
    const struct fuzz_layout layout = take_layout(&input, &config);
    if (is_started(&config, &layout, how)) {
        compare_kernels(config, &layout, input);
    }
    return 0;
}
