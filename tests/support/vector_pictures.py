"""Pictures for tests of the codecs: synthetic ones of every kind, and stereo pairs where the data are.

Pairs come from TSR_DATA (by default ../shared/data beside the source tree).

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

import numpy as np

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "target"))
from pictures import read_png  # noqa: E402

KINDS = ("noise", "steps", "flat", "wave")


def synthetic(rng, kind, width, height):
    y, x = np.mgrid[0:height, 0:width]
    if kind == "noise":
        return rng.integers(0, 256, (height, width)).astype(np.uint8)
    if kind == "steps":
        return np.where((x // 5 + y // 3) % 2 == 0, 0, 255).astype(np.uint8)
    if kind == "flat":
        return np.full((height, width), rng.integers(0, 256), np.uint8)
    wave = 128 + 90 * np.sin(x / 4 + rng.random()) * np.cos(y / 7) + rng.normal(0, 4, (height, width))
    return np.clip(wave, 0, 255).astype(np.uint8)


def synthetic_map(rng, kind, width, height, disparities, step_log2, invalid=65535):
    """Disparities UQ12.4, multiples of the step, with holes."""
    labels = (16 * disparities) >> step_log2
    y, x = np.mgrid[0:height, 0:width]
    if kind == "noise":
        label = rng.integers(0, labels, (height, width))
    elif kind == "slope":
        label = (x * rng.integers(1, 5) + y + rng.integers(0, 2, (height, width))) // 3 % labels
    elif kind == "blocks":
        label = rng.integers(0, labels, (height // 8 + 1, width // 8 + 1))[y // 8, x // 8]
        change = rng.integers(-1, 2, (height, width)) * (rng.random((height, width)) < 0.2)
        label = np.clip(label + change, 0, labels - 1)
    else:
        label = np.zeros((height, width), np.int64)
    result = (label << step_log2).astype(np.uint16)
    share = {"empty": 1.0, "noise": 0.1, "blocks": 0.2}.get(kind, 0.02)
    result[rng.random((height // 4 + 1, width // 4 + 1))[y // 4, x // 4] < share] = invalid
    return result


def reduced(path, width, height):
    """The centre of a picture file, by the mean of the whole blocks that fit."""
    columns, rows, pixels = read_png(path)
    picture = np.frombuffer(pixels, np.uint8).reshape(rows, columns)
    n = max(1, min(columns // width, rows // height))
    x, y = (columns - n * width) // 2, (rows - n * height) // 2
    blocks = picture[y:y + n * height, x:x + n * width].reshape(height, n, width, n)
    return (blocks.mean((1, 3)) + 0.5).astype(np.uint8)


def pairs(width, height, count):
    """[(name, left, right)] of at most count pairs, spread over the data; none where there are none."""
    data = pathlib.Path(os.environ.get("TSR_DATA", SOURCE.parent / "shared/data"))
    folders = sorted(data.glob("mb*"))
    chosen = folders[::max(1, len(folders) // count)][:count]
    return [(folder.name, *(reduced(folder / f"{side}.png", width, height) for side in ("left", "right")))
            for folder in chosen]
