"""tsr_map_restore against tests/support/restore_reference.py, written from docs/math.md: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_codec_restore.py

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_restore: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import map_library  # noqa: E402
import restore_reference as reference  # noqa: E402

INVALID = reference.INVALID
SHAPES = ((1, 1), (1, 9), (9, 1), (2, 2), (3, 4), (5, 5), (17, 23), (24, 31), (60, 80))
SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)


def labels(kind, height, width, count):
    """Labels as decoded maps have them, and such as no matcher leaves."""
    y, x = np.mgrid[:height, :width]
    slope = (x * RNG.uniform(-0.6, 0.6) + y * RNG.uniform(-0.6, 0.6) + RNG.uniform(0, count)) % count
    return {"flat": np.full((height, width), RNG.integers(0, count)),
            "noise": RNG.integers(0, count, (height, width)),
            "near noise": RNG.integers(0, min(count, 4), (height, width)),
            "slope": slope.astype(np.int64),
            "rough slope": np.clip(slope.astype(np.int64) + RNG.integers(-1, 2, (height, width)), 0, count - 1),
            "edge": np.where(x > width // 2, count - 1, count // 2),
            "ends": RNG.choice([0, count - 1], (height, width))}[kind]


KINDS = ("flat", "noise", "near noise", "slope", "rough slope", "edge", "ends")


def maps(disparities, step_log2):
    for height, width in SHAPES:
        for kind in KINDS:
            for valid_part in (1, 0.8, 0.3):
                decoded = (labels(kind, height, width, 16 * disparities >> step_log2) << step_log2).astype(np.uint16)
                decoded[RNG.random((height, width)) > valid_part] = INVALID
                yield kind, decoded


def check(kind, decoded, disparities, step_log2, near):
    where = (kind, decoded.shape, disparities, step_log2, near, SEED)
    info = map_library.info_of(decoded, disparities, step_log2, near)
    got = map_library.restore(decoded, info, RNG)
    wanted = reference.restore(decoded, step_log2)
    assert np.array_equal(got, wanted), (where, np.argwhere(got != wanted)[:5].tolist())
    if decoded[decoded != INVALID].max(initial=0) <= 16 * (disparities - 1):
        assert np.array_equal(map_library.quantise(got, disparities, step_log2), decoded), where


def test_every_step():
    for step_log2 in range(5):
        for near in (0, 1):
            for disparities in (1, 32, 128):
                for kind, decoded in maps(disparities, step_log2):
                    check(kind, decoded, disparities, step_log2, near)


def test_what_quantising_took():
    """A plane of a slope that the step cuts into stairs: restored, it is nearer to itself."""
    y, x = np.mgrid[:48, :64]
    plane = np.rint(100 + 1.1 * x + 0.7 * y).astype(np.uint16)
    quantised = map_library.quantise(plane, 32, 3)
    restored = map_library.restore(quantised, map_library.info_of(quantised, 32, 3))
    before, after = (np.abs(values.astype(int) - plane).mean() for values in (quantised, restored))
    assert after < before / 3, (before, after)


if __name__ == "__main__":
    print(f"replay: SEED={SEED} python3 tests/vectors/test_codec_restore.py")
    for test in (test_every_step, test_what_quantising_took):
        test()
        print(f"{test.__name__}: passed")
