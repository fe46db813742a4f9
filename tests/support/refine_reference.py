"""The filters of a disparity map computed from docs/math.md, chapter 4, with NumPy: whole maps, exact fractions.

Invalid disparities are INVALID in maps given and returned. Slow and plain on purpose.

SPDX-License-Identifier: Apache-2.0
"""
import math
from fractions import Fraction

import numpy as np

INVALID = 65535
HALF = Fraction(1, 2)


def neighbours(height, width, y, x):
    """The up to four pixels beside (x, y) in its row and column."""
    return [(v, u) for v, u in ((y, x - 1), (y, x + 1), (y - 1, x), (y + 1, x)) if 0 <= v < height and 0 <= u < width]


def median(disparity_map, window):
    """Eqs. (18), (80)."""
    height, width = disparity_map.shape
    r = window // 2
    result = np.full_like(disparity_map, INVALID)
    for y in range(height):
        for x in range(width):
            around = disparity_map[max(0, y - r):y + r + 1, max(0, x - r):x + r + 1].ravel()
            values = sorted(int(v) for v in around if v != INVALID)
            if len(values) >= (4 if window == 3 else around.size // 2 + 1):
                result[y, x] = values[(len(values) - 1) // 2]
    return result


def speckle(disparity_map, min_size, max_difference_q4):
    """Eqs. (81), (82), one flood for each component."""
    height, width = disparity_map.shape
    values = disparity_map.astype(np.int64)
    result, seen = disparity_map.copy(), disparity_map == INVALID
    for start in zip(*np.nonzero(~seen)):
        if seen[start]:
            continue
        seen[start] = True
        component = [start]
        for here in component:
            for there in neighbours(height, width, *here):
                if not seen[there] and abs(values[here] - values[there]) <= max_difference_q4:
                    seen[there] = True
                    component.append(there)
        if len(component) < min_size:
            for pixel in component:
                result[pixel] = INVALID
    return result


def fill(disparity_map):
    """Eqs. (83), (84)."""
    height, width = disparity_map.shape
    full = [y for y in range(height) if (disparity_map[y] != INVALID).any()]
    result = disparity_map.copy()
    for y in full:
        valid = np.nonzero(disparity_map[y] != INVALID)[0]
        for x in np.nonzero(disparity_map[y] == INVALID)[0]:
            beside = [valid[valid < x][-1:], valid[valid > x][:1]]
            result[y, x] = min(int(disparity_map[y, i[0]]) for i in beside if len(i))
    rows = result.copy()
    for y in range(height):
        if full and y not in full:
            result[y] = rows[min(full, key=lambda row: (abs(row - y), row))]
    return result


def gaussian(disparity_map, window):
    """Eq. (85)."""
    height, width = disparity_map.shape
    r = window // 2
    b = [math.comb(2 * r, i) for i in range(window)]
    result = disparity_map.copy()
    for y, x in zip(*np.nonzero(disparity_map != INVALID)):
        total = weights = 0
        for v in range(max(0, y - r), min(height, y + r + 1)):
            for u in range(max(0, x - r), min(width, x + r + 1)):
                if disparity_map[v, u] != INVALID:
                    weight = b[v - y + r] * b[u - x + r]
                    weights += weight
                    total += weight * int(disparity_map[v, u])
        result[y, x] = math.floor(Fraction(total, weights) + HALF)
    return result


def conductance(difference, edge_q4):
    """Eq. (86)."""
    return math.floor(Fraction(256 * edge_q4 ** 2, edge_q4 ** 2 + difference ** 2) + HALF)


def diffusion(disparity_map, iterations, edge_q4, rate_q8):
    """Eq. (87)."""
    height, width = disparity_map.shape
    before = [[int(v) for v in row] for row in disparity_map]
    for _ in range(iterations):
        after = [row[:] for row in before]
        for y in range(height):
            for x in range(width):
                if before[y][x] == INVALID:
                    continue
                beside = [before[v][u] for v, u in neighbours(height, width, y, x)]
                differences = [v - before[y][x] for v in beside if v != INVALID]
                change = Fraction(rate_q8 * sum(conductance(s, edge_q4) * s for s in differences), 2 ** 16)
                magnitude = math.floor(abs(change) + HALF)
                after[y][x] += magnitude if change > 0 else -magnitude
        before = after
    return np.array(before, np.uint16)
