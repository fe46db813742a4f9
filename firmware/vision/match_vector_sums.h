/*
 * Window sums of a row in vectors of 16-bit keys, and the least of each pixel.
 *
 *     key = 16 S(x,y,d) + d / n - 2^15     where d is a candidate of pixel x
 *           16 S(x,y,d) + d / n            where it is not
 *
 * S is at most 1890, so candidates have negative keys and no other lane wins or
 * comes near a bound. A pixel moves all keys by the column that enters the window
 * and the one that leaves it; lane d changes sides at x = s + d and s + d + W.
 * n is 8, or less where 16 n > D serves: least_lanes(). The least key of all
 * vectors, lane by lane modulo n, says d / n, and the lane says d % n; the lowest
 * d of equal sums is found first.
 *
 * Keys of a block of pixels are kept until the bounds of eq. (15) are known, so
 * that no pixel waits for its own least key.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_MATCH_VECTOR_SUMS_H
#define TSR_VISION_MATCH_VECTOR_SUMS_H

#include "match_vector.h"

#define BLOCK 16u
#define KEY_PAD 16u /* lanes before and behind a pixel's keys; candidates of none */
#define KEYS_MAX (KEY_PAD + BLOCK * (TSR_DISPARITY_COUNT_MAX + KEY_PAD))

/* Keys of the last pixel in registers, where the count of vectors is small enough for that. */
struct held_keys {
    vec16 keys[2u * VECTORS_MAX];
};

/* What makes the difference between code for one D and another: constants where it is used. */
struct shape {
    unsigned vectors;
    bool excess; /* the last vector ends behind the last disparity */
    bool held;
    unsigned lanes; /* n */
};

INLINE int16_t *keys_at(int16_t *block, struct shape shape, unsigned pixel)
{
    return block + KEY_PAD + pixel * (shape.vectors * VECTOR_LEN + KEY_PAD);
}

/* Where the columns are that enter and leave. */
struct cursor {
    const uint8_t *left;
    const uint8_t *right; /* lane 0 */
    uint8_t *enter;
    const uint8_t *leave;
    vec8 first; /* of the column that enters, where shape.excess */
};

/* Columns that fill their vectors are aligned. */
INLINE vec8 load_column(const uint8_t *at, struct shape shape)
{
    return shape.excess ? load8(at) : load8_aligned(at);
}

INLINE unsigned lane_step(struct shape shape)
{
    return LANE_PAIR > 1u && !shape.excess ? 2u : 1u;
}

/* As it widens: the end of a column that does not fill its last vector would not be one with its lanes in pairs. */
INLINE vec8 paired(vec8 column, struct shape shape)
{
    return shape.excess ? pair_lanes(column) : column;
}

/* The column that enters, moved down. */
INLINE void move_column(const struct row_input *input, struct shape shape, struct cursor *at, vec8 *column)
{
    vec8 probe_new = probe4(at->left[0]);
    vec8 probe_old = probe4(at->left[sizeof input->rows->left[ENTERS]]);
    vec8 next = shape.excess ? load8(at->enter + input->disparities) : at->first;
    for (unsigned i = 0; i < shape.vectors; i++) {
        unsigned d = i * VECTOR_LEN;
        const uint8_t *right = at->right + d * lane_step(shape);
        vec8 added = probe_difference4(probe_new, load8(right));
        vec8 taken = probe_difference4(probe_old, load8(right + sizeof input->rows->right[ENTERS]));
        vec8 sums = shape.excess && i == 0 ? at->first : load_column(at->enter + d, shape);
        column[i] = add8(sums, subtract8(added, taken));
        store8(at->enter + d, column[i]);
    }
    at->first = next;
    at->left++;
    at->right -= lane_step(shape);
    at->enter += input->disparities;
}

/* The last column, which enters again. Its first vector is whole: only columns before it could overwrite that. */
INLINE void repeat_column(const struct row_input *input, struct shape shape, const struct cursor *at, vec8 *column)
{
    for (unsigned i = 0; i < shape.vectors; i++) {
        column[i] = load_column(at->enter - input->disparities + i * VECTOR_LEN, shape);
    }
}

/* Lanes behind the last disparity hold anything; without their sign they are no candidates. */
INLINE vec16 mask_excess(vec16 keys, struct shape shape, unsigned vector, unsigned disparities)
{
#define EIGHT(n) n, n, n, n, n, n, n, n
    static const _Alignas(32)
        int16_t keep[64] = {EIGHT(-1),        EIGHT(-1),        EIGHT(-1),        EIGHT(-1),
                            EIGHT(INT16_MAX), EIGHT(INT16_MAX), EIGHT(INT16_MAX), EIGHT(INT16_MAX)};
#undef EIGHT
    unsigned first = vector * LANES16;
    if (!shape.excess || vector + 2u < 2u * shape.vectors) {
        return keys;
    }
    return and16(keys, load16_anywhere(keep + 32u + first - disparities));
}

/* Keys of a pixel from those of the pixel before. Returns the least of VECTOR_LEN / 2 groups of lanes. */
INLINE vec16 slide_window(const struct row_input *input, struct shape shape, const vec8 *column, const uint8_t *leave,
                          struct held_keys *held, const int16_t *before, int16_t *keys)
{
    vec16 least_first = splat16(INT16_MAX);
    vec16 least_second = splat16(INT16_MAX);
    for (unsigned i = 0; i < shape.vectors; i++) {
        vec8 change = paired(subtract8(column[i], load_column(leave + i * VECTOR_LEN, shape)), shape);
        const int16_t *at = before + i * VECTOR_LEN;
        vec16 first = shape.held ? held->keys[2u * i] : load16(at);
        vec16 second = shape.held ? held->keys[2u * i + 1u] : load16(at + LANES16);
        first = mask_excess(add16(first, first_times16(change)), shape, 2u * i, input->disparities);
        second = mask_excess(add16(second, second_times16(change)), shape, 2u * i + 1u, input->disparities);
        if (shape.held) {
            held->keys[2u * i] = first;
            held->keys[2u * i + 1u] = second;
        }
        store16(keys + i * VECTOR_LEN, first);
        store16(keys + i * VECTOR_LEN + LANES16, second);
        least_first = min16(least_first, first);
        least_second = min16(least_second, second);
    }
    return min16(least_first, least_second);
}

/* Lane d becomes a candidate, or ceases to be one. Returns the keys of the pixel before, so changed. */
INLINE const int16_t *toggle_lane(struct shape shape, unsigned d, struct held_keys *held, const int16_t *before,
                                  int16_t *changed)
{
    static const _Alignas(32) int16_t toggles[2u * TSR_DISPARITY_COUNT_MAX] = {[TSR_DISPARITY_COUNT_MAX] = INT16_MIN};
    const int16_t *toggle = toggles + TSR_DISPARITY_COUNT_MAX - d;
    for (unsigned i = 0; i < 2u * shape.vectors; i++) {
        vec16 keys = shape.held ? held->keys[i] : load16(before + i * LANES16);
        keys = xor16(keys, load16_anywhere(toggle + i * LANES16));
        if (shape.held) {
            held->keys[i] = keys;
        } else {
            store16(changed + i * LANES16, keys);
        }
    }
    return shape.held ? before : changed;
}

/* The keys one pixel left of the row: column 0 radius + 2 times, 1 .. radius - 1 once. */
INLINE void begin_keys(const struct row_input *input, struct shape shape, struct held_keys *held, int16_t *keys)
{
    for (unsigned d = 0; d < shape.vectors * VECTOR_LEN; d++) {
        bool is_candidate = (int)d < -input->start && d < input->disparities;
        keys[d] = (int16_t)((int)(d / shape.lanes) + (is_candidate ? INT16_MIN : 0));
    }
    for (unsigned i = 0; i < shape.vectors; i++) {
        const uint8_t *column = input->columns + i * VECTOR_LEN;
        vec16 times = splat16((int16_t)(input->radius + 2u));
        vec16 first = multiply16(first_times16(paired(load8(column), shape)), times);
        vec16 second = multiply16(second_times16(paired(load8(column), shape)), times);
        for (unsigned x = 1; x < input->radius; x++) {
            vec8 sums = paired(load8(column + (size_t)x * input->disparities), shape);
            first = add16(first, first_times16(sums));
            second = add16(second, second_times16(sums));
        }
        int16_t *at = keys + i * VECTOR_LEN;
        held->keys[2u * i] = add16(first, load16(at));
        held->keys[2u * i + 1u] = add16(second, load16(at + LANES16));
        store16(at, held->keys[2u * i]);
        store16(at + LANES16, held->keys[2u * i + 1u]);
    }
}

/* d, and what other sums are not to reach: floor(S (100 + percent) / 100), which eq. (15) compares with. */
INLINE void find_bounds(struct shape shape, unsigned from, unsigned percent, struct winners *winners)
{
    uint32_t scale = ((uint32_t)percent << 18) / 100u + 1u;
    for (unsigned x = from; x < from + BLOCK; x += LANES16) {
        vec16 key;
        vec16 lane;
        find_least16(winners->kept + (size_t)x * KEPT_LANES, shape.lanes, &key, &lane);
        store16(winners->sum + x, key);
        store16(winners->d + x, add16(multiply16(and16(key, splat16(15)), splat16((int16_t)shape.lanes)), lane));
        vec16 sum = SHIFT_RIGHT_UNSIGNED16(key, 4);
        vec16 more = add16(multiply_high16(sum, splat16((int16_t)(uint16_t)scale)),
                           multiply16(sum, splat16((int16_t)(scale >> 16))));
        vec16 limit = add16(sum, SHIFT_RIGHT_UNSIGNED16(more, 2));
        limit = min16(limit, splat16(INT16_MAX / 16)); /* no sum lies above */
        store16(winners->bound + x, xor16(SHIFT_LEFT16(add16(limit, splat16(1)), 4), splat16(INT16_MIN)));
    }
}

/* 0 less how many keys are below the bound, in any lanes. */
INLINE vec16 count_of_pixel(struct shape shape, const int16_t *keys, size_t x, struct winners *winners)
{
    vec16 bound = load_splat16(winners->bound + x);
    vec16 within = splat16(0);
    for (unsigned i = 0; i < shape.vectors; i++) {
        const int16_t *at = keys + i * VECTOR_LEN;
        within = add16(within, add16(above16(bound, load16(at)), above16(bound, load16(at + LANES16))));
    }
    const int16_t *own = keys + winners->d[x];
    winners->below[x] = own[-1];
    winners->above[x] = own[1];
    return within;
}

/* A whole block: the counts of pixels behind the row's end are not used. */
INLINE void count_within(struct shape shape, int16_t *block, unsigned from, struct winners *winners)
{
    for (size_t i = 0; i < BLOCK; i += 2) {
        const int16_t *keys = keys_at(block, shape, (unsigned)i);
        vec16 first = count_of_pixel(shape, keys, from + i, winners);
        vec16 second = count_of_pixel(shape, keys + (shape.vectors * VECTOR_LEN + KEY_PAD), from + i + 1u, winners);
        keep_counts16(first, second, winners->counts + (from + i) * KEPT_COUNTS);
    }
}

/* What is particular about the pixels of a block: constants where it is used, so that most are without. */
struct border {
    bool starts; /* lanes are toggled, or columns that are to leave are kept */
    bool ends;   /* the last column enters again */
};

INLINE struct border border_of(const struct row_input *input, unsigned from)
{
    int lane = (int)from - input->start;
    bool toggles = (lane + (int)BLOCK > 0 && lane < (int)input->disparities) || lane + (int)BLOCK > (int)input->width;
    struct border border = {toggles || from <= input->radius, from + BLOCK + input->radius > input->width};
    return border;
}

/* The keys and the least of them of one pixel. */
INLINE void slide_pixel(const struct row_input *input, struct shape shape, struct border border, struct cursor *at,
                        struct held_keys *held, size_t x, const int16_t *before, int16_t *keys, struct winners *winners)
{
    _Alignas(32) int16_t changed[TSR_DISPARITY_COUNT_MAX];
    vec8 column[VECTORS_MAX];
    if (border.ends && x + input->radius >= input->width) {
        repeat_column(input, shape, at, column);
    } else {
        move_column(input, shape, at, column);
    }
    if (border.starts) {
        int lane = (int)x - input->start;
        lane -= lane >= (int)input->width ? (int)input->width : 0;
        if (lane >= 0 && lane < (int)input->disparities) {
            before = toggle_lane(shape, (unsigned)lane, held, before, changed);
        }
    }
    vec16 least = slide_window(input, shape, column, at->leave, held, before, keys);
    keep_least16(least, winners->kept + x * KEPT_LANES);
    at->leave += border.starts && x <= input->radius ? 0u : input->disparities;
}

/* Of a block, or of what the row has of it. */
INLINE void slide_block(const struct row_input *input, struct shape shape, struct border border, struct cursor *at,
                        struct held_keys *held, size_t from, const int16_t *before, int16_t *keys,
                        struct winners *winners)
{
    unsigned stride = shape.vectors * VECTOR_LEN + KEY_PAD;
    size_t end = border.ends && from + BLOCK > input->width ? input->width : from + BLOCK;
    for (size_t x = from; x < end; x++, keys += stride) {
        slide_pixel(input, shape, border, at, held, x, before, keys, winners);
        before = keys;
    }
}

/* The columns moved, and what is known of every pixel then. */
INLINE void find_winners(const struct row_input *input, struct shape shape, unsigned percent, struct winners *winners)
{
    _Alignas(32) int16_t keys[2u * KEYS_MAX];
    for (unsigned i = 0; i <= 2u * BLOCK; i++) {
        memset(keys_at(keys, shape, i) - KEY_PAD, 0, KEY_PAD * sizeof *keys);
    }
    struct cursor at = {input->rows->left[ENTERS], input->rows->right[ENTERS] + (input->width - 1u) * lane_step(shape),
                        input->columns, input->columns, load8(input->columns)};
    for (unsigned x = 0; x < input->radius; x++) {
        vec8 column[VECTORS_MAX];
        move_column(input, shape, &at, column);
    }
    memset(winners->kept + (size_t)input->width * KEPT_LANES, 0, BLOCK * KEPT_LANES * sizeof *winners->kept);
    struct held_keys held;
    int16_t *block = keys;
    int16_t *other = keys_at(keys, shape, BLOCK) - KEY_PAD;
    begin_keys(input, shape, &held, keys_at(other, shape, BLOCK - 1u));
    for (unsigned from = 0; from < input->width + BLOCK; from += BLOCK) {
        if (from < input->width) {
            const int16_t *before = keys_at(other, shape, BLOCK - 1u);
            int16_t *first = keys_at(block, shape, 0);
            struct border border = border_of(input, from);
            if (!border.starts && !border.ends) {
                slide_block(input, shape, (struct border){false, false}, &at, &held, from, before, first, winners);
            } else if (!border.ends) {
                slide_block(input, shape, (struct border){true, false}, &at, &held, from, before, first, winners);
            } else {
                slide_block(input, shape, (struct border){true, true}, &at, &held, from, before, first, winners);
            }
        }
        if (from > 0) { /* the block before: what it stored in pieces can be loaded in vectors by now */
            find_bounds(shape, from - BLOCK, percent, winners);
            count_within(shape, other, from - BLOCK, winners);
        }
        int16_t *swap = block;
        block = other;
        other = swap;
    }
}

#endif
