"""Change detection in C against tests/support/change_reference.py, written from docs/math.md: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_vision_change.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_change: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import change_reference as reference  # noqa: E402
from vision_library import LIB, OK, SIZE, STATE_LEN, ChangeConfig, ChangeResult, Gray, pointer  # noqa: E402

SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)
SIZES = ((8, 8), (30, 41), (64, 80), (120, 160))  # height, width
MARKED = 0x80  # of V in C: the cell was counted


def padded(picture):
    rows = RNG.integers(0, 256, (picture.shape[0], picture.shape[1] + int(RNG.integers(0, 5))), np.uint8)
    rows[:, :picture.shape[1]] = picture
    return rows


def frames_of_a_day(height, width):
    """Areas and edges, noise, drifting and stepping light that clips, an object from the middle on."""
    scene = np.kron(RNG.integers(0, 256, (height // 6 + 1, width // 6 + 1)), np.ones((6, 6)))[:height, :width]
    scene = scene * RNG.choice([0.05, 0.5, 1]) + RNG.normal(0, 6, scene.shape)
    light, level = 1.0, RNG.choice([0, 1])
    noise = RNG.choice([0.5, 2, 20])
    for i in range(40):
        light *= RNG.choice([1, 1, 1, 1, 0.75, 1.2, 0.98, 1.01, 3])
        light = light if 0.2 < light < 4 else 1.0
        frame = scene * light + RNG.normal(0, noise, scene.shape) + i * level
        if i > 20:
            frame[: height // 2, width // 3:] = 255 - frame[: height // 2, width // 3:]
        yield np.clip(np.rint(frame), 0, 255).astype(np.uint8)


def some_rectangles(height, width):
    rectangles = []
    for _ in range(int(RNG.integers(0, 5))):
        x, y = int(RNG.integers(0, width)), int(RNG.integers(0, height))
        rectangles.append((x, y, int(RNG.integers(1, width - x + 1)), int(RNG.integers(1, height - y + 1))))
    return rectangles


def test_day(height, width, reduction):
    cells = (height // reduction) * (width // reduction)
    settings = (reduction, int(RNG.integers(1, 9)), int(RNG.integers(1, 30)), int(RNG.integers(30, 128)),
                int(RNG.integers(1, cells + 1) if RNG.random() < 0.3 else RNG.integers(1, min(cells, 20) + 1)),
                int(RNG.integers(1, 8)))
    rectangles = some_rectangles(height, width)
    config = ChangeConfig(width, height, *settings, len(rectangles))
    for i, rectangle in enumerate(rectangles):
        config.watched[i] = rectangle
    wanted = reference.Change(*settings, rectangles)
    change, state = np.zeros(STATE_LEN, np.uint8), RNG.integers(0, 256, 3 * cells, np.uint8)
    assert LIB.tsr_change_init(pointer(change), ctypes.byref(config), pointer(state), SIZE(state.size)) == OK
    seen = set()
    for frame in frames_of_a_day(height, width):
        rows = padded(frame)
        view = Gray(rows.ctypes.data, width, height, rows.shape[1])
        if RNG.random() < 0.15:
            wanted.rebase(frame)
            assert LIB.tsr_change_rebase(pointer(change), ctypes.byref(view)) == OK
        else:
            result = ChangeResult()
            assert LIB.tsr_change_update(pointer(change), ctypes.byref(view), ctypes.byref(result)) == OK
            got = (result.changed, result.settling, result.changed_cells, result.light_q8)
            assert got == wanted.update(frame), (settings, rectangles, height, width, got)
            seen.add((result.changed, result.light_q8 != 256))
        assert np.array_equal(state[cells:2 * cells], wanted.mean.ravel())
        assert np.array_equal(state[2 * cells:] & (MARKED - 1), wanted.deviation.ravel())
    return seen


def test_default_min_cells():
    for rectangles, reduction, min_cells in (((), 4, 3), ((), 2, 12), ((), 8, 2), (((0, 0, 160, 60), (0, 60, 160, 40)), 4, 2),
                                             (((0, 0, 160, 120), (0, 0, 160, 120)), 4, 6), (((3, 3, 1, 1),), 4, 2)):
        config = ChangeConfig(160, 120, reduction)
        config.watched_count = len(rectangles)
        for i, rectangle in enumerate(rectangles):
            config.watched[i] = rectangle
        change, state = np.zeros(STATE_LEN, np.uint8), np.zeros(3 * 80 * 60, np.uint8)
        assert LIB.tsr_change_init(pointer(change), ctypes.byref(config), pointer(state), SIZE(state.size)) == OK
        assert ChangeConfig.from_buffer(change).min_cells == min_cells, (rectangles, reduction)


if __name__ == "__main__":
    print(f"replay: SEED={SEED} python3 tests/vectors/test_vision_change.py")
    met = set()
    for day_height, day_width in SIZES:
        for side in (2, 4, 8):
            for _ in range(3):
                met |= test_day(day_height, day_width, side)
    assert met == {(False, False), (False, True), (True, False), (True, True)}, met
    test_default_min_cells()
    print("passed")
