"""The matcher's plain modes raw and ssd against tests/support/vision_reference.py: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_vision_plain.py

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_plain: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vision_reference as reference  # noqa: E402
from vision_library import MODES, TEST_OFF, Gray, MatchConfig, run_match  # noqa: E402

DEFAULT_UNIQUENESS = {"raw": 15, "ssd": 30}
SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)


def pictures(height, width, shift):
    yield "random", RNG.integers(0, 256, (2, height, width))
    yield "two values", RNG.integers(0, 2, (2, height, width)) * 255
    yield "opposite", np.stack([np.zeros((height, width)), np.full((height, width), 255)])
    yield "constant", np.full((2, height, width), 77)
    yield "ramp", np.tile(np.arange(width) * 3 % 256, (2, height, 1))
    scene = RNG.integers(0, 256, (height, 3 * width))
    yield "seen twice", np.stack([scene[:, width:2 * width], scene[:, width + shift:2 * width + shift]])


def check(mode, left, right, disparities, window, uniqueness, tolerance, start):
    height, width = left.shape
    strides = [width + int(e) for e in RNG.integers(0, 9, 2)]
    frames = [np.pad(p, ((0, 0), (0, s - width)), constant_values=77).astype(np.uint8)
              for p, s in zip((left, right), strides)]
    views = [Gray(f.ctypes.data, width, height, f.shape[1]) for f in frames]
    config = MatchConfig(width, height, disparities, window, MODES[mode], 0, uniqueness, 0, tolerance, start)
    got = run_match(views, config, np.zeros((height, width), np.uint16), RNG)
    sums = reference.plain_sums(left, right, disparities, window or 9, start, mode == "ssd")
    offset = reference.parabola_offset_q4 if mode == "ssd" else reference.offset_q4
    wanted = reference.choose(sums, np.ones(left.shape, bool), uniqueness or DEFAULT_UNIQUENESS[mode], tolerance or 1,
                              start, 1, offset)
    assert np.array_equal(got, wanted), (mode, disparities, window, uniqueness, tolerance, start,
                                         np.argwhere(got != wanted)[:5].tolist())
    return int((wanted != reference.INVALID).sum())


def main():
    print(f"replay: SEED={SEED} python3 tests/vectors/test_vision_plain.py")
    cases = valid = 0
    for mode in ("raw", "ssd"):
        for disparities, width, height in ((16, 16, 9), (16, 33, 15), (24, 37, 17), (32, 48, 20), (128, 131, 15)):
            room = width - disparities
            for start in sorted({0, room, -room, room // 2, -(room // 3)}):
                for _, (left, right) in pictures(height, width, min(6 + max(start, 0), width)):
                    if RNG.random() < 0.5:
                        continue
                    window = int(RNG.choice([w for w in (0, 5, 7, 11, 15) if (w or 9) <= height]))
                    valid += check(mode, left, right, disparities, window, int(RNG.choice([0, 1, 100, TEST_OFF])),
                                   int(RNG.choice([0, 3, TEST_OFF])), start)
                    cases += 1
    print(f"raw and ssd: {cases} pairs, {valid} valid pixels")


if __name__ == "__main__":
    main()
