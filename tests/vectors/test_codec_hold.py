"""tsr_map_hold against the rule of docs/codec.md, 2.10, written down with NumPy: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_codec_hold.py

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_hold: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import map_library  # noqa: E402

RADIUS, COUNT = 3, 25
SHAPES = ((1, 1), (1, 30), (30, 1), (2, 5), (3, 3), (6, 8), (7, 7), (24, 31), (60, 80), (3, 640), (480, 3))  # height, width
SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)


def around(mask):
    """How many pixels of the window around each are set, the map's only."""
    height, width = mask.shape
    padded = np.pad(mask.astype(int), RADIUS)
    return sum(padded[y:y + height, x:x + width] for y in range(2 * RADIUS + 1) for x in range(2 * RADIUS + 1))


def wanted(disparity_map, earlier):
    windows = around(disparity_map != earlier) >= COUNT
    return np.where(around(windows) > 0, disparity_map, earlier)


def changes(height, width):
    """An earlier map and later ones: noise of some density, and blocks of any size."""
    earlier = (8 * RNG.integers(0, 64, (height, width))).astype(np.uint16)
    earlier[RNG.random(earlier.shape) < 0.2] = 0xFFFF
    for density in (0, 0.1, 0.3, 0.5, 0.6, 1):
        later = earlier.copy()
        for _ in range(int(RNG.integers(0, 4))):
            y, x = RNG.integers(0, height), RNG.integers(0, width)
            later[y:y + RNG.integers(1, 12), x:x + RNG.integers(1, 12)] = RNG.choice([0, 8, 0xFFFF])
        noise = RNG.random(later.shape) < density
        later[noise] = RNG.choice([0, 8, 16, 0xFFFF], later.shape)[noise]
        yield earlier, later


def test_rule():
    moved = 0
    for height, width in SHAPES:
        for _ in range(20):
            for earlier, later in changes(height, width):
                held, changed = map_library.hold(later, earlier)
                assert np.array_equal(held, wanted(later, earlier)), ((height, width), SEED)
                assert changed == (held != earlier).sum(), ((height, width), SEED)
                moved += changed
    assert moved > 0


if __name__ == "__main__":
    print(f"replay: SEED={SEED} python3 tests/vectors/test_codec_hold.py")
    test_rule()
    print("test_rule: passed")
