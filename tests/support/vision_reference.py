"""The vision layer computed from docs/math.md with NumPy: whole volumes, exact fractions, nothing incremental.

Invalid disparities are INVALID in maps given and returned. Slow and plain on purpose.

SPDX-License-Identifier: Apache-2.0
"""
import functools
import math
from fractions import Fraction

import numpy as np

INVALID = 65535
TEST_OFF = 255


def inside(coordinates, low, high):
    return np.clip(coordinates, low, high)


def prefilter(picture, cap):
    """Eq. (10)."""
    height, width = picture.shape
    y, x = np.mgrid[:height, :width]

    def p(dx, dy):
        return picture.astype(np.int64)[inside(y + dy, 0, height - 1), inside(x + dx, 0, width - 1)]

    gradient = p(1, -1) + 2 * p(1, 0) + p(1, 1) - p(-1, -1) - 2 * p(-1, 0) - p(-1, 1)
    return np.clip(np.floor_divide(gradient + 2, 4), -cap, cap) + cap


def window_sums(values, radius):
    """The sum over the window around every pixel, columns and rows clipped to the picture."""
    height, width = values.shape
    rows = sum(values[inside(np.arange(height) + j, 0, height - 1)] for j in range(-radius, radius + 1))
    return sum(rows[:, inside(np.arange(width) + i, 0, width - 1)] for i in range(-radius, radius + 1))


def volume(left, right, disparities, window, start):
    """Eqs. (11), (12): S[y, x, d], for every d; candidates() says which of them a pixel may choose."""
    height, width = left.shape
    sums = np.empty((height, width, disparities), np.int64)
    for d in range(disparities):
        met = right[:, inside(np.arange(width) - start - d, 0, width - 1)]
        sums[:, :, d] = window_sums(np.abs(left - met), window // 2)
    return sums


def plain_sums(left, right, disparities, window, start, squared):
    """Eqs. (23), (24)."""
    if squared:
        def met(d):
            return right[:, inside(np.arange(left.shape[1]) - start - d, 0, left.shape[1] - 1)]
        left, right = left.astype(np.int64), right.astype(np.int64)
        return np.stack([window_sums((left - met(d)) ** 2, window // 2) for d in range(disparities)], axis=-1)
    return volume(left.astype(np.int64), right.astype(np.int64), disparities, window, start)


def candidates(x, width, disparities, start):
    """D(x): the d whose right pixel lies in the picture."""
    return [d for d in range(disparities) if 0 <= x - start - d < width]


@functools.lru_cache(maxsize=None)
def offset_q4(below, least, above):
    """Eq. (16), to nearest, ties away from zero."""
    offset = Fraction(16 * (below - above), 2 * (max(below, above) - least))
    magnitude = math.floor(abs(offset) + Fraction(1, 2))
    return magnitude if offset > 0 else -magnitude


@functools.lru_cache(maxsize=None)
def parabola_offset_q4(below, least, above):
    """Eq. (25), to nearest, ties away from zero."""
    offset = Fraction(16 * (below - above), 2 * (below - 2 * least + above))
    magnitude = math.floor(abs(offset) + Fraction(1, 2))
    return magnitude if offset > 0 else -magnitude


def choose(sums, textured, uniqueness, tolerance, start, claim_step, offset=offset_q4):
    """Eqs. (14) to (17): the map of the sums S[y, x, d]. Claims compare floor(m / claim_step)."""
    height, width, disparities = sums.shape
    result = np.full((height, width), INVALID, np.uint16)
    for y in range(height):
        winners, claims = {}, {}
        for x in range(width):
            offered = candidates(x, width, disparities, start)
            if offered:
                best = min(offered, key=lambda d: (sums[y, x, d], d))
                winners[x] = best, offered
                claims.setdefault(x - start - best, []).append((int(sums[y, x, best]) // claim_step, best))
        for x, (best, offered) in winners.items():
            costs = sums[y, x].tolist()
            if not textured[y, x]:
                continue
            if uniqueness != TEST_OFF and any(100 * costs[d] <= (100 + uniqueness) * costs[best]
                                              for d in offered if abs(d - best) > 1):
                continue
            if tolerance != TEST_OFF and abs(min(claims[x - start - best])[1] - best) > tolerance:
                continue
            value = 16 * best
            if best - 1 in offered and best + 1 in offered:
                value += offset(costs[best - 1], costs[best], costs[best + 1])
            result[y, x] = value
    return result


def match(left, right, disparities, window, cap, uniqueness, texture_min, tolerance, start):
    """Chapter 3. The map as a uint16 array."""
    left, right = prefilter(left, cap), prefilter(right, cap)
    sums = volume(left, right, disparities, window, start)
    texture = window_sums(np.abs(left - cap), window // 2)
    textured = texture >= (0 if texture_min == TEST_OFF else texture_min * window)
    return choose(sums, textured, uniqueness, tolerance, start, 4)


def median(disparity_map, valid_min):
    """Eq. (18)."""
    height, width = disparity_map.shape
    result = np.full_like(disparity_map, INVALID)
    for y in range(height):
        for x in range(width):
            around = disparity_map[max(0, y - 1):y + 2, max(0, x - 1):x + 2].ravel()
            values = sorted(int(v) for v in around if v != INVALID)
            if len(values) >= valid_min:
                result[y, x] = values[(len(values) - 1) // 2]
    return result


def quantise(values, step_log2, disparities):
    """Eq. (19)."""
    step = 2 ** step_log2

    def one(v):
        return v if v == INVALID else min(step * ((v + step // 2) // step), 16 * (disparities - 1))

    return np.array([one(int(v)) for v in values], np.uint16)


def similarity(a, b, block_log2, clip_q4, threshold_q8):
    """Eqs. (20) to (22): (squares summed, pixels in both, pixels in one, blocks that count, different blocks)."""
    a, b = a.astype(object), b.astype(object)
    both = (a != INVALID) & (b != INVALID)
    one = (a != INVALID) ^ (b != INVALID)
    squares = np.where(both, (a - b) ** 2, 0)
    count = int(both.sum())
    side = 2 ** block_log2
    blocks = different = 0
    for y in range(0, a.shape[0] - side + 1, side):
        for x in range(0, a.shape[1] - side + 1, side):
            valid = both[y:y + side, x:x + side]
            if 2 * int(valid.sum()) < side * side:
                continue
            blocks += 1
            clipped = np.minimum(squares[y:y + side, x:x + side], clip_q4 ** 2)[valid]
            different += Fraction(int(clipped.sum()), int(valid.sum())) > threshold_q8
    return int(squares.sum()), count, int(one.sum()), blocks, different
