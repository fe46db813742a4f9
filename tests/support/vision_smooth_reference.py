"""The census modes of the matcher computed from docs/math.md, eqs. (40) to (47), with NumPy: whole volumes, nothing
incremental.

SPDX-License-Identifier: Apache-2.0
"""
import numpy as np
from vision_reference import inside, window_sums

CROSS = [(-2, 0), (-1, 0), (1, 0), (2, 0), (0, -2), (0, -1), (0, 1), (0, 2)]
KNIGHT = [(i, j) for i in (-2, -1, 1, 2) for j in (-2, -1, 1, 2) if abs(i) != abs(j)]
PATHS = [(1, 0), (0, 1), (-1, 1)]  # steps: to the right, down, down left
NEAR, FAR = 8, 32


def describe(picture):
    """Eq. (40): [16, y, x] of 0 and 1."""
    height, width = picture.shape
    y, x = np.mgrid[:height, :width]
    return np.array([picture[inside(y + j, 0, height - 1), inside(x + i, 0, width - 1)] > picture
                     for i, j in CROSS + KNIGHT])


def distances(left, right, disparities, start):
    """Eq. (41): C[y, x, d], for every x and d."""
    height, width = left.shape
    left, right = describe(left), describe(right)
    x = np.arange(width)
    return np.stack([(left != right[:, :, inside(x - start - d, 0, width - 1)]).sum(axis=0)
                     for d in range(disparities)], axis=-1).astype(np.int64)


def box(costs, radius):
    """The sum over the window around every pixel, clipped to the picture."""
    return np.stack([window_sums(costs[:, :, d], radius) for d in range(costs.shape[2])], axis=-1)


def path_costs(costs, gray, step):
    """Eqs. (43) to (45)."""
    height, width, disparities = costs.shape
    result = np.zeros_like(costs)
    apart = np.abs(np.subtract.outer(np.arange(disparities), np.arange(disparities)))
    for y in range(height):
        for x in range(width):
            px, py = x - step[0], y - step[1]
            result[y, x] = costs[y, x]
            if not (0 <= px < width and 0 <= py < height):
                continue
            far = max(NEAR, FAR - abs(int(gray[y, x]) - int(gray[py, px])))
            penalty = np.where(apart == 0, 0, np.where(apart == 1, NEAR, far))
            before = result[py, px]
            result[y, x] += (before[None, :] + penalty).min(axis=1) - before.min()
    return result


def smooth_sums(left, right, disparities, start):
    """Eqs. (42), (46)."""
    costs = box(distances(left, right, disparities, start), 1) // 4
    return sum(path_costs(costs, left, step) for step in PATHS)


def census_sums(left, right, disparities, start, window):
    """Eq. (47)."""
    return box(distances(left, right, disparities, start), window // 2)
