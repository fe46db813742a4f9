"""The figures of `tarsier compare` with NumPy, from docs/math.md, eqs. (88) and (89); and readers of map files.

SPDX-License-Identifier: Apache-2.0
"""
import math
import struct
import zlib

import numpy as np


def read_pfm(path):
    header, size, scale, data = path.read_bytes().split(b"\n", 3)
    width, height = (int(number) for number in size.split())
    assert header == b"Pf" and float(scale) == -1, path
    return np.frombuffer(data, "<f4").reshape(height, width)[::-1].astype(np.float64)


def write_pfm(path, values):
    header = f"Pf\n{values.shape[1]} {values.shape[0]}\n-1.0\n".encode()
    path.write_bytes(header + np.ascontiguousarray(values[::-1], "<f4").tobytes())


def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def write_png(path, values):
    """A gray PNG of the array's depth, 8 or 16 bits."""
    depth = 8 * values.dtype.itemsize
    rows = b"".join(b"\0" + row.astype(values.dtype.newbyteorder(">")).tobytes() for row in values)
    header = struct.pack(">IIBBBBB", values.shape[1], values.shape[0], depth, 0, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + png_chunk(b"IHDR", header) + png_chunk(b"IDAT", zlib.compress(rows)) +
                     png_chunk(b"IEND", b""))


def structural_similarity(a, b, valid, value_range):
    """Eq. (89), one window after the other."""
    distance = np.arange(-5, 6)
    line = np.exp(-distance ** 2 / (2 * 1.5 ** 2))
    window = np.outer(line, line)
    c1, c2 = (0.01 * value_range) ** 2, (0.03 * value_range) ** 2
    found = []
    for y in range(5, a.shape[0] - 5):
        for x in range(5, a.shape[1] - 5):
            if not valid[y, x]:
                continue
            part = np.s_[y - 5:y + 6, x - 5:x + 6]
            inside = valid[part]
            w = window[inside] / window[inside].sum()
            u, v = a[part][inside], b[part][inside]
            mu, mv = (w * u).sum(), (w * v).sum()
            su, sv, suv = (w * (u - mu) ** 2).sum(), (w * (v - mv) ** 2).sum(), (w * (u - mu) * (v - mv)).sum()
            found.append((2 * mu * mv + c1) * (2 * suv + c2) / ((mu ** 2 + mv ** 2 + c1) * (su + sv + c2)))
    return float(np.mean(found)) if found else None


def judge(disparity, truth, mask=None, value_range=None):
    """The JSON of the command: infinity marks what is unknown."""
    known = np.isfinite(truth) & (mask == 255 if mask is not None else True)
    valid = known & np.isfinite(disparity)
    error = np.abs(disparity[valid] - truth[valid])
    value_range = value_range or float(truth[known].max())
    mse = float(np.mean(error ** 2)) if error.size else None
    limits = (("0.5", 0.5), ("1", 1), ("2", 2))
    return {"width": truth.shape[1], "height": truth.shape[0], "known": int(known.sum()), "valid": int(valid.sum()),
            "density": valid.sum() / known.sum(),
            "correct": {name: (error <= limit).sum() / known.sum() for name, limit in limits},
            "bad": {name: float(np.mean(error > limit)) if error.size else None for name, limit in limits},
            "median_error_px": float(np.median(error)) if error.size else None,
            "mean_error_px": float(np.mean(error)) if error.size else None, "mse_px2": mse, "range_px": value_range,
            "psnr_db": 10 * math.log10(value_range ** 2 / mse) if mse else None,
            "ssim": structural_similarity(disparity, truth, valid, value_range)}
