/*
 * The matcher's rows with the DSP extension of Cortex-M4, M7 and M33: four
 * disparities in a word of column sums, two or four in a word of window sums.
 *
 * At the left border a lane d can be chosen from pixel x = d on. Its group takes
 * part from the first column that such a pixel's window has; columns left of it
 * stay 0, so the window loses nothing when it leaves them. A lane's sum is
 * OUT_OF_REACH too large until the lane can be chosen. What lies beyond the end
 * of a right row is in a copy of that end.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "match_kernels.h"

#ifdef TSR_MATCH_HAS_DSP

#include <stdbool.h>
#include <string.h>

#include "match_dsp.h"

/* Above every limit, 2 * 1890. */
#define OUT_OF_REACH 0x4000u
#define BYTES_EVEN UINT32_C(0x00ff00ff)
#define UNIQUE_ONE (UINT32_C(1) << 20)

void tsr_dsp_fill_edge(const struct tsr_match_config *config, const uint8_t *right, uint8_t *edge)
{
    unsigned inside = config->disparities - 1u;
    memcpy(edge, right + (config->width - inside), inside);
    memset(edge + inside, right[config->width - 1u], TSR_DSP_EDGE_LEN(config->disparities) - inside);
}

/* eq. (15); a scale of 0 lets every sum be above the limit. */
static void begin_tests(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row)
{
    const struct tsr_match_config *config = row->config;
    const uint8_t *texture = row->scratch.texture;
    int radius = config->window / 2;
    int last = config->width - 1;
    if (config->uniqueness_percent == TSR_MATCH_TEST_OFF) {
        frame->unique_scale = 0;
        frame->unique_one = 0;
    } else {
        frame->unique_scale = UNIQUE_ONE + ((unsigned)config->uniqueness_percent << 20) / 100u + 1u;
        frame->unique_one = UNIQUE_ONE;
    }
    int sum = config->texture_min == TSR_MATCH_TEST_OFF ? INT16_MAX : -(int)config->texture_min * config->window;
    int before = (int)frame->x - 1;
    for (int i = before - radius; i <= before + radius; i++) {
        sum += texture[i < 0 ? 0 : i < last ? i : last];
    }
    frame->texture = sum;
    frame->tex_enter = texture + radius;
    frame->tex_leave = texture - radius - 1;
}

/* Moves the column sums of the window of the pixel before the first, and adds them up: column 0 also stands for those
 * left of it. */
static void begin_sums(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row)
{
    const struct tsr_match_config *config = row->config;
    int start = config->search_start_px;
    int radius = config->window / 2;
    unsigned words = config->disparities / 2u;
    for (unsigned i = 0; i <= words; i++) { /* and a neighbour of the last */
        frame->sums[i] = OUT_OF_REACH * 0x10001u;
    }
    for (int x = start > radius ? start - radius : 0; x < start + radius; x++) {
        uint8_t *column = row->scratch.columns + (size_t)x * config->disparities;
        const uint8_t *right_new = tsr_dsp_at_edge(config, row->edge_new, x - start);
        const uint8_t *right_old = tsr_dsp_at_edge(config, row->edge_old, x - start);
        uint32_t left_new = row->left_new[x] * frame->ones;
        uint32_t left_old = row->left_old[x] * frame->ones;
        unsigned times = x == 0 ? (unsigned)(radius + 2 - start) : 1u;
        unsigned lanes = TSR_DSP_GROUP_LANES * tsr_dsp_count_groups(config, x - start);
        for (unsigned d = 0; d < lanes; d += 4u) {
            uint32_t word = tsr_dsp_load(column + d) + tsr_dsp_difference(left_new, tsr_dsp_load(right_new + d)) -
                            tsr_dsp_difference(left_old, tsr_dsp_load(right_old + d));
            tsr_dsp_store(column + d, word);
            frame->sums[d / 2u] += times * (word & BYTES_EVEN);
            frame->sums[d / 2u + 1u] += times * (word >> 8 & BYTES_EVEN);
        }
    }
}

void tsr_dsp_begin(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row)
{
    const struct tsr_match_config *config = row->config;
    unsigned radius = row->radius;
    unsigned start = row->start;
    unsigned least_count = (config->disparities / TSR_DSP_GROUP_LANES + TSR_DSP_LEAST_WORDS - 1u) / TSR_DSP_LEAST_WORDS;
    frame->row = row;
    frame->x = start;
    frame->change = start;
    frame->ones = 0x01010101u;
    frame->ones_again = frame->ones;
    frame->lane_key = 0x08040201u;
    frame->stride = config->disparities;
    frame->minus_two = -2;
    frame->none = UINT32_MAX;
    frame->claims = row->scratch.claims - start;
    frame->choices = row->scratch.choices;
    frame->least_entry = tsr_dsp_least[least_count - 1u];
    for (unsigned i = 0; i < least_count * TSR_DSP_LEAST_WORDS; i++) {
        frame->least[i] = UINT32_MAX;
    }
    begin_tests(frame, row);
    begin_sums(frame, row);
    frame->left_new = row->left_new + radius;
    frame->left_old = row->left_old + radius;
    frame->right_new = tsr_dsp_at_edge(config, row->edge_new, (int)radius);
    frame->right_old = tsr_dsp_at_edge(config, row->edge_old, (int)radius);
    frame->enter = row->scratch.columns + (size_t)(start + radius - 1u) * config->disparities;
    frame->leave = row->scratch.columns;
    if (start > radius + 1u) {
        frame->leave += (size_t)(start - radius - 2u) * config->disparities;
    }
}

/* The sums of 16 bits become sums of 8. */
static void narrow_sums(struct tsr_dsp_frame *frame)
{
    unsigned groups = frame->stride / TSR_DSP_GROUP_LANES;
    unsigned words = frame->stride / 4u;
    for (unsigned i = 0; i < words; i++) {
        frame->sums[i] = frame->sums[2u * i] | frame->sums[2u * i + 1u] << 8;
    }
    frame->sums[words] = UINT32_MAX;
    frame->groups = tsr_dsp_groups8[groups - 1u];
    frame->least_entry = tsr_dsp_least8[(groups - 1u) / TSR_DSP_LEAST_WORDS];
}

/* At the left border: which column leaves, how many groups take part, where the right rows are. */
static void change_left(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row, unsigned lane)
{
    const struct tsr_match_config *config = row->config;
    unsigned radius = row->radius;
    unsigned x = frame->x;
    unsigned at_end = config->disparities - 1u - radius; /* the last lane that needs a copy of the right rows' end */
    unsigned next = lane + TSR_DSP_GROUP_LANES - (lane + 2u * radius) % TSR_DSP_GROUP_LANES;
    frame->groups = tsr_dsp_groups[tsr_dsp_count_groups(config, (int)(lane + radius)) - 1u];
    if (lane < at_end) {
        next = next < at_end ? next : at_end;
    } else if (lane == at_end) {
        frame->right_new = row->right_new + (config->width - config->disparities);
        frame->right_old = row->right_old + (config->width - config->disparities);
    }
    frame->change = row->start + (next < config->disparities ? next : config->disparities - 1u);
    if (x <= radius + 1u) { /* the column that leaves is column 0 */
        frame->leave = row->scratch.columns - config->disparities;
        frame->tex_leave = row->scratch.texture - (x <= radius ? x : radius + 1u);
        frame->change = x + 1u;
    }
    if (lane == config->disparities - 1u && config->mode == TSR_MATCH_SAD8) {
        narrow_sums(frame);
    }
}

/* Right of the image: the last column is taken again, and does not change. */
static void take_last_column(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row)
{
    unsigned last = row->config->width - 1u;
    frame->right_new = row->right_new + row->start;
    frame->right_old = frame->right_new;
    frame->enter = row->scratch.columns + (size_t)(last - 1u) * frame->stride;
    frame->left_new = row->left_new + last - frame->x;
    frame->left_old = frame->left_new;
    frame->tex_enter = row->scratch.texture + last - frame->x;
}

/* Not 0 when the row is done. */
static __attribute__((noinline)) uint32_t change(struct tsr_dsp_frame *frame, const struct tsr_dsp_row *row)
{
    unsigned width = row->config->width;
    unsigned lane = frame->x - row->start;
    if (frame->x == width) {
        return 1;
    }
    if (lane < frame->stride) {
        change_left(frame, row, lane);
    }
    if (frame->x + row->radius >= width) {
        take_last_column(frame, row);
        frame->change = frame->x + 1u;
    } else if (lane + 1u >= frame->stride) {
        frame->stop = width - row->radius;
        frame->change = frame->stop;
    } else if (frame->change + row->radius > width) {
        frame->change = width - row->radius;
    }
    return 0;
}

uint32_t tsr_dsp_prepare(struct tsr_dsp_frame *frame)
{
    const struct tsr_dsp_row *row = frame->row;
    unsigned lane = frame->x - row->start;
    frame->stop = frame->x + 1u;
    if (lane < frame->stride) {
        uint16_t *sum = (uint16_t *)(void *)frame->sums + ((lane & ~3u) | (lane & 1u) << 1 | (lane >> 1 & 1u));
        *sum = (uint16_t)(*sum - OUT_OF_REACH);
    }
    return frame->x < frame->change ? 0u : change(frame, row);
}

/* As the columns in match_dsp_window.c, with the cap in place of the left pixels. */
static void move_texture_columns(const struct tsr_dsp_row *row)
{
    uint8_t *columns = row->scratch.texture;
    const uint8_t *left_new = row->left_new;
    const uint8_t *left_old = row->left_old;
    const uint8_t *end = left_new + row->config->width;
    uint32_t cap = row->config->prefilter_cap;
    uint32_t caps = cap * 0x01010101u;
    uint32_t sums, pixels, t;
    __asm volatile("1:\n\t"
                   "ldr %[sums], [%[columns]]\n\t"
                   "ldr %[pixels], [%[left_new]], #4\n\t"
                   "uqadd8 %[t], %[pixels], %[not_caps]\n\t"
                   "umaal %[sums], %[pixels], %[t], %[minus_two]\n\t"
                   "ldr %[pixels], [%[left_old]], #4\n\t"
                   "uqsub8 %[t], %[pixels], %[caps]\n\t"
                   "umaal %[sums], %[pixels], %[t], %[minus_two]\n\t"
                   "add %[sums], %[sums], %[common]\n\t"
                   "str %[sums], [%[columns]], #4\n\t"
                   "cmp %[left_new], %[last]\n\t"
                   "bls 1b"
                   : [columns] "+&r"(columns), [left_new] "+&r"(left_new), [left_old] "+&r"(left_old),
                     [sums] "=&r"(sums), [pixels] "=&r"(pixels), [t] "=&r"(t)
                   : [caps] "r"(caps), [not_caps] "r"(~caps), [minus_two] "r"(-2), [common] "r"(-2u * caps - 2u),
                     [last] "r"(end - 4)
                   : "cc", "memory");
    for (; left_new < end; left_new++, left_old++, columns++) {
        *columns = (uint8_t)(*columns + tsr_dsp_difference(*left_new, cap) - tsr_dsp_difference(*left_old, cap));
    }
}

/* And choices, which follow. */
static void clear_claims(const struct tsr_dsp_row *row)
{
    uint32_t *words = (uint32_t *)(void *)row->scratch.claims;
    unsigned count = row->config->width;
    for (; count >= 8u; count -= 8u, words += 8) {
        for (unsigned i = 0; i < 8u; i++) {
            words[i] = UINT32_MAX;
        }
    }
    for (; count > 0; count--) {
        *words++ = UINT32_MAX;
    }
}

static void match_row(const struct tsr_match *match, unsigned y, unsigned y_new, unsigned y_old)
{
    const struct tsr_match_config *config = &match->config;
    struct tsr_dsp_row row = {.config = config,
                              .scratch = tsr_match_share_scratch(match),
                              .radius = config->window / 2u,
                              .start = (uint32_t)config->search_start_px, /* not negative: match.c */
                              .left_new = match->left.pixels + (size_t)y_new * match->left.stride,
                              .left_old = match->left.pixels + (size_t)y_old * match->left.stride,
                              .right_new = match->right.pixels + (size_t)y_new * match->right.stride,
                              .right_old = match->right.pixels + (size_t)y_old * match->right.stride,
                              .edge_new = match->scratch,
                              .edge_old = match->scratch + TSR_DSP_EDGE_LEN(config->disparities)};
    tsr_dsp_fill_edge(config, row.right_new, row.edge_new);
    tsr_dsp_fill_edge(config, row.right_old, row.edge_old);
    clear_claims(&row);
    move_texture_columns(&row);
    tsr_dsp_match_pixels(&row);
    tsr_dsp_write_row(match, y);
}

const struct tsr_match_kernel tsr_match_kernel_dsp = {
    .name = "dsp",
    .prefilter_row = tsr_dsp_prefilter_row,
    .add_row = tsr_dsp_add_row,
    .match_row = match_row,
};
#endif
