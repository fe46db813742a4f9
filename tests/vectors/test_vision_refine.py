"""The C filters of a map against tests/support/refine_reference.py, written from docs/math.md: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_vision_refine.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_refine: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import refine_reference as reference  # noqa: E402
from vision_library import (AGAIN, ANY, LIB, OK, SIZE, STATE_LEN, STEPS, U8, U16, DiffusionConfig,  # noqa: E402
                            RefineConfig, SpeckleConfig, pointer)

SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)


def run_steps(before, names, speckle=(0, 0), diffusion=(0, 0, 0)):
    height, width = before.shape
    config = RefineConfig(width, height, (U8 * 8)(*[STEPS[name] for name in names]), SpeckleConfig(*speckle),
                          DiffusionConfig(*diffusion))
    got = before.copy()
    state = np.zeros(STATE_LEN, np.uint8)
    scratch = RNG.integers(0, 256, LIB.tsr_refine_scratch_len(ctypes.byref(config)), np.uint8)
    assert LIB.tsr_refine_start(pointer(state), ctypes.byref(config), pointer(got), got.size, pointer(scratch),
                                scratch.size) == OK
    while LIB.tsr_refine_run(pointer(state), int(RNG.integers(1, height + 2))) == AGAIN:
        pass
    return got


def maps():
    """Random values at every density, and patches of planes with edges and specks, as a matcher leaves them."""
    for height, width in ((1, 1), (1, 9), (9, 1), (2, 2), (3, 3), (17, 23), (24, 31)):
        for valid_rate in (0, 0.1, 0.5, 0.8, 1):
            for spread in (2, 40, 500, 65535):
                values = RNG.integers(0, spread, (height, width)).astype(np.uint16)
                values[RNG.random((height, width)) > valid_rate] = reference.INVALID
                yield values
    for _ in range(25):
        height, width = (int(n) for n in RNG.integers(4, 40, 2))
        y, x = np.mgrid[:height, :width]
        plane = 100 + RNG.integers(-6, 7) * x + RNG.integers(-6, 7) * y + RNG.integers(-3, 4, (height, width))
        top, left = int(RNG.integers(0, height)), int(RNG.integers(0, width))
        plane[top:, left:] += int(RNG.integers(0, 400))
        plane[RNG.random((height, width)) < 0.05] += 300
        values = np.clip(plane, 0, 2000).astype(np.uint16)
        for _ in range(4):
            top, left = int(RNG.integers(0, height)), int(RNG.integers(0, width))
            values[top:top + int(RNG.integers(1, 9)), left:left + int(RNG.integers(1, width + 1))] = reference.INVALID
        yield values


def expect_equal(label, before, got, wanted):
    assert np.array_equal(got, wanted), (label, before.shape, np.argwhere(got != wanted)[:5].tolist())


def test_median():
    for before in maps():
        for window in (3, 5):
            expect_equal(window, before, run_steps(before, [f"median{window}"]), reference.median(before, window))


def test_speckle():
    for before in maps():
        for min_size, difference in ((2, 1), (5, 16), (int(RNG.integers(2, 100)), int(RNG.integers(1, 60))),
                                     (4096, 65535)):
            expect_equal((min_size, difference), before, run_steps(before, ["speckle"], (min_size, difference)),
                         reference.speckle(before, min_size, difference))
    before = RNG.integers(0, 60, (20, 30)).astype(np.uint16)
    expect_equal("defaults", before, run_steps(before, ["speckle"]), reference.speckle(before, 50, 16))


def test_fill():
    for before in maps():
        for emptied in (0, 0.5, 0.9):
            rows = before.copy()
            rows[RNG.random(len(rows)) < emptied] = reference.INVALID
            wanted = reference.fill(rows)
            assert (wanted != reference.INVALID).all() or (rows == reference.INVALID).all()
            expect_equal("fill", rows, run_steps(rows, ["fill"]), wanted)


def test_gaussian():
    for before in maps():
        for window in (3, 5):
            expect_equal(window, before, run_steps(before, [f"gaussian{window}"]), reference.gaussian(before, window))


def test_diffusion():
    for before in maps():
        settings = (int(RNG.integers(1, 4)), int(RNG.choice([1, 16, 40, 255])), int(RNG.choice([1, 20, 64])))
        expect_equal(settings, before, run_steps(before, ["diffusion"], diffusion=settings),
                     reference.diffusion(before, *settings))
    before = RNG.integers(0, 60, (9, 12)).astype(np.uint16)
    expect_equal("defaults", before, run_steps(before, ["diffusion"]), reference.diffusion(before, 5, 16, 64))


def test_chain():
    one = {"median3": lambda m: reference.median(m, 3), "median5": lambda m: reference.median(m, 5),
           "speckle": lambda m: reference.speckle(m, 6, 16), "fill": reference.fill,
           "gaussian3": lambda m: reference.gaussian(m, 3), "gaussian5": lambda m: reference.gaussian(m, 5),
           "diffusion": lambda m: reference.diffusion(m, 2, 16, 64)}
    for before in maps():
        names = [str(name) for name in RNG.choice(sorted(one), int(RNG.integers(0, 9)))]
        wanted = before
        for name in names:
            wanted = one[name](wanted)
        expect_equal(names, before, run_steps(before, names, (6, 16), (2, 16, 64)), wanted)


if __name__ == "__main__":
    print(f"replay: SEED={SEED} python3 tests/vectors/test_vision_refine.py")
    for test in (test_median, test_speckle, test_fill, test_gaussian, test_diffusion, test_chain):
        test()
        print(f"{test.__name__}: passed")
