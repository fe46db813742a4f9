"""Change detection computed from docs/math.md, chapter 2, with NumPy: whole pictures, every candidate of g tried.

SPDX-License-Identifier: Apache-2.0
"""
import numpy as np


def reduce(picture, n):
    """Eq. (6)."""
    rows, columns = picture.shape[0] // n, picture.shape[1] // n
    sums = picture[:rows * n, :columns * n].astype(np.int64).reshape(rows, n, columns, n).sum(axis=(1, 3))
    return (sums + n * n // 2) // (n * n)


def light(now, mean):
    """Eq. (26)."""
    now, mean = now.ravel()[::7], mean.ravel()[::7]
    voters = (mean >= 16) & (mean <= 239)
    if voters.sum() < 8:
        return 256
    brighter = [2 * int((256 * now[voters] > k * mean[voters]).sum()) <= voters.sum() for k in range(128, 513)]
    return 128 + brighter.index(True) if any(brighter) else 512


def contrast(now):
    """C of eq. (9)."""
    most = np.zeros_like(now)
    for axis in (0, 1):
        steps = np.abs(np.diff(now, axis=axis))
        none = [(0, 0), (0, 0)]
        for side in ((1, 0), (0, 1)):
            none[axis] = side
            most = np.maximum(most, np.pad(steps, none))
    return most


def watched_cells(shape, n, rectangles):
    watched = np.full(shape, not rectangles)
    for x, y, width, height in rectangles:
        watched[y // n:-(-(y + height) // n), x // n:-(-(x + width) // n)] = True
    return watched


def largest_region(changed):
    """Cells of the largest set that touch one another: labels spread until nothing moves."""
    labels = np.where(changed, np.arange(1, changed.size + 1).reshape(changed.shape), 0)
    while True:
        around = np.pad(labels, 1)
        height, width = labels.shape
        spread = np.where(changed, np.max([around[j:j + height, i:i + width] for j in range(3) for i in range(3)], axis=0), 0)
        if np.array_equal(spread, labels):
            return int(np.bincount(labels[changed]).max()) if changed.any() else 0
        labels = spread


class Change:
    def __init__(self, reduction, amplification, deviation_min, deviation_max, min_cells, settle_frames, rectangles=()):
        self.n, self.amplification = reduction, amplification
        self.low, self.high = deviation_min, deviation_max
        self.min_cells, self.settle_frames, self.rectangles = min_cells, settle_frames, rectangles
        self.frames, self.updates, self.mean, self.deviation = 0, 0, None, None

    def rebase(self, picture):
        self.mean = reduce(picture, self.n)
        if self.frames == 0:
            self.deviation = np.full_like(self.mean, self.low)
        self.frames += 1

    def follow(self, now):
        """Eqs. (26), (27), (7), (8), (28), (9): g, and the cells that changed."""
        g = light(now, self.mean)
        expected = np.minimum(255, (g * self.mean + 128) // 256)
        lit = np.abs(expected - self.mean)
        step = 1 + np.where(np.maximum(expected, self.mean) >= 192, lit, lit // 4)
        moved = expected + np.clip(now - expected, -step, step)
        away = np.abs(now - moved)
        rise = 4 if self.frames < self.settle_frames else 1
        self.deviation = np.clip(self.deviation + np.clip(self.amplification * away - self.deviation, -1, rise), self.low,
                                 self.high)
        self.mean = np.where((away > self.deviation) & (self.updates % 8 > 0), expected, moved)
        self.updates += 1
        limit = self.deviation + contrast(now) // 8
        return g, (away > limit) & watched_cells(now.shape, self.n, self.rectangles)

    def update(self, picture):
        """(changed, settling, changed cells, g)"""
        settling = self.frames < self.settle_frames
        g, count, region = 256, 0, 0
        if self.frames == 0:
            self.rebase(picture)
        else:
            g, changed = self.follow(reduce(picture, self.n))
            count, region = int(changed.sum()), largest_region(changed)
            self.frames += 1
        return (not settling and region >= self.min_cells), settling, 0 if settling else count, g
