/*
 * The least lanes of eight vectors at once, where no instruction finds them:
 * keep_least16() and find_least16() of vector_sse2.h for vectors of 16 bytes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_VECTOR_LEAST_H
#define TSR_VISION_VECTOR_LEAST_H

#define KEPT_LANES 8u

/* The others are folded into them while lanes are zipped. */
INLINE unsigned least_lanes(unsigned vectors)
{
    return vectors <= 2u ? vectors : vectors <= 4u ? 4u : 8u;
}

INLINE void keep_least16(vec16 a, int16_t *kept)
{
    store16(kept, a);
}

/* Rows a, b of lanes become rows of pairs, so three times of eight rows of lanes eight of columns. */
INLINE void zip_rows8(const vec16 *rows, vec16 *zipped)
{
    for (unsigned i = 0; i < 4; i++) {
        zipped[2u * i] = zip_low16(rows[i], rows[i + 4u]);
        zipped[2u * i + 1u] = zip_high16(rows[i], rows[i + 4u]);
    }
}

INLINE void zip_rows4(const vec16 *rows, vec16 *zipped)
{
    for (unsigned i = 0; i < 2; i++) {
        zipped[2u * i] = zip_low16(rows[i], rows[i + 2u]);
        zipped[2u * i + 1u] = zip_high16(rows[i], rows[i + 2u]);
    }
}

/* The least of the lanes, and how many come before it. */
INLINE void rank_lanes(const vec16 *lanes, unsigned count, vec16 *least, vec16 *lane)
{
    vec16 found = lanes[0];
    for (unsigned i = 1; i < count; i++) {
        found = min16(found, lanes[i]);
    }
    vec16 above = splat16(-1); /* ones as long as no lane was the least */
    vec16 passed = splat16(0);
    for (unsigned i = 0; i + 1u < count; i++) {
        above = and16(above, above16(lanes[i], found));
        passed = subtract16(passed, above);
    }
    *least = xor16(found, splat16(INT16_MIN));
    *lane = passed;
}

INLINE void find_least16(const int16_t *kept, unsigned lanes, vec16 *least, vec16 *lane)
{
    vec16 rows[8];
    vec16 pairs[8];
    for (unsigned i = 0; i < 8; i++) {
        rows[i] = load16(kept + i * 8u);
    }
    zip_rows8(rows, pairs);
    if (lanes == 8u) {
        zip_rows8(pairs, rows);
        zip_rows8(rows, pairs);
        rank_lanes(pairs, 8, least, lane);
        return;
    }
    vec16 fours[4]; /* lanes 0 .. 3 and 4 .. 7 in one */
    vec16 zipped[4];
    for (unsigned i = 0; i < 4; i++) {
        fours[i] = min16(pairs[2u * i], pairs[2u * i + 1u]);
    }
    zip_rows4(fours, zipped);
    if (lanes == 4u) {
        zip_rows4(zipped, fours);
        rank_lanes(fours, 4, least, lane);
        return;
    }
    vec16 even = min16(zipped[0], zipped[1]);
    vec16 odd = min16(zipped[2], zipped[3]);
    const vec16 two[2] = {zip_low16(even, odd), zip_high16(even, odd)};
    if (lanes == 2u) {
        rank_lanes(two, 2, least, lane);
        return;
    }
    const vec16 one = min16(two[0], two[1]);
    rank_lanes(&one, 1, least, lane);
}

#endif
