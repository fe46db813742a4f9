/*
 * The least lanes of eight vectors at once, where no instruction finds them:
 * keep_least16() and find_least16() of vector_sse2.h for vectors of 16 bytes.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_VISION_VECTOR_LEAST_H
#define TSR_VISION_VECTOR_LEAST_H

#define KEPT_LANES 8u

INLINE void keep_least16(vec16 a, int16_t *kept)
{
    store16(kept, a);
}

/* Rows a, b of lanes become rows of pairs, so three times of eight rows of lanes eight of columns. */
INLINE void zip_rows(const vec16 *rows, vec16 *zipped)
{
    for (unsigned i = 0; i < 4; i++) {
        zipped[2u * i] = zip_low16(rows[i], rows[i + 4u]);
        zipped[2u * i + 1u] = zip_high16(rows[i], rows[i + 4u]);
    }
}

INLINE void find_least16(const int16_t *kept, vec16 *least, vec16 *lane)
{
    vec16 rows[8];
    vec16 lanes[8];
    for (unsigned i = 0; i < 8; i++) {
        rows[i] = load16(kept + i * 8u);
    }
    zip_rows(rows, lanes);
    zip_rows(lanes, rows);
    zip_rows(rows, lanes);
    vec16 low = min16(min16(lanes[0], lanes[1]), min16(lanes[2], lanes[3]));
    vec16 high = min16(min16(lanes[4], lanes[5]), min16(lanes[6], lanes[7]));
    vec16 found = min16(low, high);
    vec16 above = above16(lanes[0], found); /* ones as long as no lane was the least */
    vec16 passed = above;
    for (unsigned i = 1; i < 7; i++) {
        above = and16(above, above16(lanes[i], found));
        passed = add16(passed, above);
    }
    *least = xor16(found, splat16(INT16_MIN));
    *lane = subtract16(splat16(0), passed);
}

#endif
