"""The C rectification against the equations of docs/math.md, in whole numbers of any size: equal bit for bit.

Tables, CRC and rows above are made here too, so that the format has a second writer.
SEED replays a run: SEED=n python3 tests/vectors/test_vision_rectify.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import struct
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_rectify: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
from vision_library import LIB, OK, STATE_LEN, U16, Gray  # noqa: E402

FORMAT = -4
CASES = 60


def nearest(numerator, denominator):
    """R(numerator / denominator): to nearest, ties up."""
    return (2 * numerator + denominator) // (2 * denominator)


def weights(t, step):
    """6 S^3 B_k(t / S), eq. (61)."""
    def inner(a):
        return 3 * a**3 - 6 * a**2 * step + 4 * step**3
    return [(step - t)**3, inner(t), inner(step - t), t**3]


def sums_of_row(points, y, width, step):
    """P(t) of every pixel of row y, px 2^-21, eq. (62) to (64); points[row][column]."""
    j0, u = divmod(y, step)
    down = weights(u, step)
    v = [nearest(nearest(sum(down[k] * int(points[j0 + k][i]) for k in range(4)), (step // 8)**3), 24)
         for i in range(points.shape[1])]
    sums = []
    for x in range(width):
        i0, t = divmod(x, step)
        v0, v1, v2, v3 = v[i0:i0 + 4]
        g, b, a = v2 - v0, v0 - 2 * v1 + v2, v3 - 3 * v2 + 3 * v1 - v0
        d3 = nearest(2**8 * a, step**3)
        d2 = nearest(2**8 * b, step**2) + d3
        d1 = nearest(2**7 * g, step) + nearest(2**7 * b, step**2) + nearest(2**7 * a, 3 * step**3)
        p0 = 2**8 * v1 + nearest(2**7 * b, 3)
        sums.append(p0 + t * d1 + t * (t - 1) // 2 * d2 + t * (t - 1) * (t - 2) // 6 * d3)
    return sums


def positions(points, size, source_length, step):
    """q of one coordinate, px 2^-8, eq. (65)."""
    width, height = size
    middle = source_length // 2
    q = [[(p + 2**21 * middle + 2**12) // 2**13 for p in sums_of_row(points, y, width, step)] for y in range(height)]
    return np.clip(np.array(q, dtype=np.int64), 0, 256 * (source_length - 1))


def rectified(source, q_x, q_y):
    """Eq. (66)."""
    padded = np.pad(source.astype(np.int64), ((0, 1), (0, 1)), mode="edge")
    x, y, f_x, f_y = q_x // 256, q_y // 256, q_x % 256, q_y % 256

    def across(row):
        return 256 * padded[row, x] + f_x * (padded[row, x + 1] - padded[row, x])
    upper, lower = across(y), across(y + 1)
    return ((256 * upper + f_y * (lower - upper) + 2**15) // 2**16).astype(np.uint8)


def crc16(data):
    crc = 0xffff
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc ^ 0xffff


def table_bytes(size, source_size, step, rows_above, grids):
    data = b"TSRM" + struct.pack("<BB6HhHIIii", 1, step.bit_length() - 1, *size, *source_size, *rows_above, -5, 0,
                                 250 << 16, 60 << 16, 80 << 16, 60 << 16)
    for grid in grids:
        data += np.stack(grid, axis=-1).astype("<i2").tobytes()
    return data + struct.pack("<H", crc16(data))


def random_case(rng):
    step = int(rng.choice([8, 16, 32]))
    size = int(rng.integers(16, 90)), int(rng.integers(16, 70))
    source_size = size if rng.random() < 0.5 else (int(rng.integers(16, 641)), int(rng.integers(16, 481)))
    shape = [-(-length // step) + 3 for length in reversed(size)]
    wobble = float(rng.choice([0, 30, 600, 8000, 32767]))
    grids = []
    for _ in range(2):
        rows, columns = np.indices(shape)
        straight = [((columns - 1) * step - size[0] // 2) * 64, ((rows - 1) * step - size[1] // 2) * 64]
        grids.append([np.clip(axis + np.rint(rng.uniform(-wobble, wobble, shape)), -32768, 32767).astype(np.int64)
                      for axis in straight])
    return step, size, source_size, grids


def check_case(LIB, rng):
    step, size, source_size, grids = random_case(rng)
    q = [[positions(grid[axis], size, source_size[axis], step) for axis in range(2)] for grid in grids]
    own_row = np.arange(size[1])[:, None]
    rows_above = [max(0, int((own_row - q_y // 256).max())) for _, q_y in q]
    data = table_bytes(size, source_size, step, rows_above, grids)
    table = ctypes.create_string_buffer(STATE_LEN)
    status = LIB.tsr_rectify_open(table, data, ctypes.c_size_t(len(data)))
    assert status == OK, f"open: {status}"
    more = table_bytes(size, source_size, step, [rows_above[0] + 1, rows_above[1]], grids)
    assert LIB.tsr_rectify_open(ctypes.create_string_buffer(STATE_LEN), more,
                                    ctypes.c_size_t(len(more))) == FORMAT, "a row too many"
    source = np.ascontiguousarray(rng.integers(0, 256, source_size[::-1], dtype=np.uint8))
    for side in range(2):
        target = np.zeros(size[::-1], dtype=np.uint8)
        work = ctypes.create_string_buffer(STATE_LEN)
        status = LIB.tsr_rectify_start(work, table, side, Gray(source.ctypes.data, *source_size, source_size[0]),
                                           Gray(target.ctypes.data, *size, size[0]))
        assert status == OK, f"start: {status}"
        assert LIB.tsr_rectify_run(work, U16(size[1])) == OK
        assert np.array_equal(target, rectified(source, *q[side])), f"{size} from {source_size}, step {step}"


seed = int(os.environ.get("SEED", "1"))
print(f"replay: SEED={seed} python3 tests/vectors/test_vision_rectify.py")
rng = np.random.default_rng(seed)
for _ in range(CASES):
    check_case(LIB, rng)
print(f"{CASES} tables, both sides: equal")
