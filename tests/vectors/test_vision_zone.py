"""Zones of a map against docs/math.md, equations (95) and (96), with exact fractions.

SEED replays a run: SEED=n python3 tests/vectors/test_vision_zone.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import math
import os
import pathlib
import sys
from fractions import Fraction

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_zone: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vision_reference as reference  # noqa: E402
from vision_library import ANY, LIB, OK, U8, U16, U32, pointer  # noqa: E402

SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)
NEARER, FARTHER, SURFACE = 1, 2, 3
NO_DISPARITY = 65535
STATE_LEN = 1024  # more than struct tsr_zone


class ZoneConfig(ctypes.Structure):
    _fields_ = [("x", U16), ("y", U16), ("width", U16), ("height", U16), ("kind", U8), ("limit_q4", U16)]


class ZoneResult(ctypes.Structure):
    _fields_ = [("valid", U32), ("counted", U32), ("disparity_q8", U16)]


def expected(part, kind, limit_q4):
    values = sorted(int(v) for v in part.flat if v != reference.INVALID)
    if kind == NEARER:
        counted = [v for v in values if v >= limit_q4]
    elif kind == FARTHER:
        counted = [v for v in values if v < limit_q4]
    else:
        counted = [v for v in values if abs(v - values[(len(values) - 1) // 2]) <= 16]
    mean = math.floor(Fraction(16 * sum(counted), len(counted)) + Fraction(1, 2)) if counted else NO_DISPARITY
    return len(values), len(counted), mean


def measured(values, config):
    state = np.zeros(STATE_LEN, np.uint8)
    height, width = values.shape
    assert LIB.tsr_zone_start(pointer(state), ctypes.byref(config), pointer(values), U16(width), U16(height)) == OK
    while LIB.tsr_zone_run(pointer(state), U16(int(RNG.integers(1, height + 1)))) != OK:
        pass
    result = LIB.tsr_zone_get_result(pointer(state))
    return result.valid, result.counted, result.disparity_q8


def random_map(height, width):
    kind = RNG.integers(0, 3)
    if kind == 0:
        values = RNG.integers(0, 2048, (height, width))
    else:
        x, y = np.meshgrid(np.arange(width), np.arange(height))
        plane = RNG.uniform(0, 1500) + RNG.uniform(0, 12) * x + RNG.uniform(0, 12) * y
        values = np.clip(plane + RNG.normal(0, RNG.choice([0, 3, 20]), plane.shape), 0, 2047).astype(int)
    return np.where(RNG.random((height, width)) < RNG.choice([0, 0.3, 0.95, 1]), reference.INVALID, values).astype(np.uint16)


def test_zones():
    LIB.tsr_zone_start.argtypes = [ANY, ANY, ANY, U16, U16]
    LIB.tsr_zone_get_result.restype = ZoneResult
    for _ in range(600):
        height, width = int(RNG.integers(1, 40)), int(RNG.integers(1, 60))
        values = random_map(height, width)
        x, y = int(RNG.integers(0, width)), int(RNG.integers(0, height))
        w, h = int(RNG.integers(1, width - x + 1)), int(RNG.integers(1, height - y + 1))
        kind, limit_q4 = int(RNG.integers(NEARER, SURFACE + 1)), int(RNG.integers(0, 2100))
        got = measured(values, ZoneConfig(x, y, w, h, kind, limit_q4))
        wanted = expected(values[y:y + h, x:x + w], kind, limit_q4)
        assert got == wanted, (got, wanted, kind, limit_q4)


if __name__ == "__main__":
    print(f"replay: SEED={SEED} python3 tests/vectors/test_vision_zone.py")
    test_zones()
    print("test_zones: passed")
