"""The matcher's census and smooth modes against tests/support/vision_smooth_reference.py: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_vision_smooth.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_smooth: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vision_reference  # noqa: E402
import vision_smooth_reference as reference  # noqa: E402
from vision_library import LIB, Gray, MatchConfig, portable_kernel  # noqa: E402
import vision_library  # noqa: E402

CENSUS, SMOOTH = 2, 3
SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)


def run_match(left, right, config, in_pair_layout):
    """The map, the frames in the pair layout or apart from it with any stride."""
    height, width = left.shape
    if in_pair_layout:
        rows_above = (7 if config.mode == SMOOTH else config.window or 9) // 2 + 1
        pair = RNG.integers(0, 256, (height + rows_above, 2 * width), np.uint8)
        assert pair.size == LIB.tsr_match_pair_len(ctypes.byref(config))
        pair[rows_above:, :width], pair[rows_above:, width:] = left, right
        views = [Gray(pair.ctypes.data + 2 * width * rows_above + i * width, width, height, 2 * width) for i in (0, 1)]
        result = pair.reshape(-1)[:2 * width * height].view(np.uint16).reshape(height, width)
    else:
        strides = [width + int(e) for e in RNG.integers(0, 9, 2)]
        frames = [np.pad(p, ((0, 0), (0, s - width)), constant_values=77) for p, s in zip((left, right), strides)]
        views = [Gray(f.ctypes.data, width, height, f.shape[1]) for f in frames]
        result = np.zeros((height, width), np.uint16)
    config.kernel = portable_kernel()
    return vision_library.run_match(views, config, result, RNG)


def seen_twice(height, width, shift):
    """A scene, a nearer patch, other light on the right, and noise."""
    scene = RNG.integers(0, 256, (height, 3 * width))
    left, right = scene[:, width:2 * width].copy(), scene[:, width + shift:2 * width + shift].copy()
    y, x = height // 3, width // 3
    patch = RNG.integers(0, 256, (height // 3, width // 4))
    near = max(0, min(width - patch.shape[1], x - shift - 5))
    left[y:y + patch.shape[0], x:x + patch.shape[1]] = patch
    right[y:y + patch.shape[0], near:near + patch.shape[1]] = patch
    noise = RNG.normal(0, 2, (2, height, width))
    return [np.clip(np.rint(v * gain + n), 0, 255).astype(np.uint8)
            for v, gain, n in zip((left, right), (0.8, 1), noise)]


def pictures(height, width, shift):
    yield RNG.integers(0, 256, (2, height, width), np.uint8)
    yield RNG.integers(0, 2, (2, height, width), np.uint8) * 255
    yield np.full((2, height, width), 77, np.uint8)
    yield np.tile((np.arange(width) * 3 % 256).astype(np.uint8), (2, height, 1))
    yield np.kron(RNG.integers(0, 256, (2, height // 4 + 1, width // 4 + 1)),
                  np.ones((1, 4, 4), np.int64))[:, :height, :width].astype(np.uint8)
    yield seen_twice(height, width, shift)


def check(left, right, config, in_pair_layout):
    got = run_match(left, right, config, in_pair_layout)
    smooth = config.mode == SMOOTH
    uniqueness = config.uniqueness_percent or (25 if smooth else 15)
    search = left, right, config.disparities, config.search_start_px
    sums = reference.smooth_sums(*search) if smooth else reference.census_sums(*search, config.window or 9)
    assert sums.max() <= (204 if smooth else 3600)
    wanted = vision_reference.choose(sums, np.ones(left.shape, bool), uniqueness, config.lr_tolerance_px or 1,
                                     config.search_start_px, 1 if smooth else 8)
    fields = {name: getattr(config, name) for name, _ in config._fields_}
    assert np.array_equal(got, wanted), (fields, np.argwhere(got != wanted)[:5].tolist())
    return int((wanted != vision_reference.INVALID).sum())


def main():
    print(f"replay: SEED={SEED} python3 tests/vectors/test_vision_smooth.py")
    cases = valid = 0
    for mode in (CENSUS, SMOOTH):
        for disparities, width, height in ((16, 16, 9), (16, 33, 15), (24, 37, 17), (32, 48, 20), (128, 131, 7)):
            room = width - disparities
            for start in sorted({0, room, -room, room // 2, -(room // 3)}):
                for left, right in pictures(height, width, min(6 + start, width)):
                    if RNG.random() < 0.5:
                        continue
                    windows = [w for w in (0, 5, 7, 11, 15) if (w or 9) <= height]
                    config = MatchConfig(width, height, disparities, int(RNG.choice(windows)) if windows else 5,
                                         mode, 0, int(RNG.choice([0, 1, 100, 255])), 0, int(RNG.choice([0, 3, 255])),
                                         start)
                    valid += check(left, right, config, width % 2 == 0 and RNG.random() < 0.5)
                    cases += 1
    print(f"census and smooth: {cases} pairs, {valid} valid pixels")


if __name__ == "__main__":
    main()
