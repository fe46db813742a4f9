"""Restoring a decoded map, computed from docs/math.md, 4.7, with NumPy: whole maps, integers without bounds.

SPDX-License-Identifier: Apache-2.0
"""
import numpy as np

INVALID = 65535
REACH = 2
ITERATIONS = 8


def surrounded(values, filling):
    return np.pad(values, REACH, constant_values=filling)


def windows(values):
    """The 25 neighbours of every pixel of the surrounded array's inside, on a third axis."""
    return np.lib.stride_tricks.sliding_window_view(values, (2 * REACH + 1, 2 * REACH + 1)).reshape(
        *(n - 2 * REACH for n in values.shape), -1)


def restore(decoded, step_log2):
    m = decoded.astype(np.int64)
    valid = m != INVALID
    step = 2 ** step_log2
    a = step // 2
    b = (step - 1) // 2
    least, most = np.maximum(m - a, 0), m + b  # eq. (90)
    joined = (windows(surrounded(valid, False)) &
              (np.abs(windows(surrounded(m, 0)) - m[:, :, None]) <= step))  # eq. (91)
    count = np.maximum(joined.sum(2), 1)
    r = np.maximum(16 * m - 8 * (a - b), 0)  # eq. (92)
    for _ in range(ITERATIONS):
        total = np.where(joined, windows(surrounded(r, 0)), 0).sum(2)
        mean = (2 * total + count) // (2 * count)
        r = np.clip(mean, 16 * least, 16 * most)  # eq. (93)
    return np.where(valid, (r + 8) // 16, INVALID).astype(np.uint16)  # eq. (94)
