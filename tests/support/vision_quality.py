"""Quality of one mode of the matcher on stereo pairs with ground truth, per pair and mean, as JSON.

    TSR_BUILD=build/release python3 tests/support/vision_quality.py FOLDER_OF_PAIRS [sad|census|smooth] [raw|refined|dense]

raw is the matcher's map. refined (the default) adds the lower median over 5x5 (13 valid of 25 make a pixel valid) and
the removal of specks (4-connected, neighbours within 1 px, fewer than 60 pixels at 160x120, 120 at 320x240). dense
gives every invalid pixel the lesser of the nearest valid values to its left and right. correct: within 1 px, of all
pixels with ground truth; bad1: not so, of the valid ones; _half: the same for 1/2 px; median_error in px.
NOISE=sigma adds sensor noise to both views, LIGHT=gain multiplies the right view. Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import json
import os
import pathlib
import sys

import cv2
import numpy as np

INVALID = 65535
MODES = {"sad": 0, "sad8": 1, "census": 2, "smooth": 3}
CASES = ((160, 120, 32, 60), (320, 240, 64, 120))  # width, height, disparities, pixels of a speck
MEDIAN_RADIUS, MEDIAN_VALID_MIN = 2, 13
U8, U16, I16, SIZE = ctypes.c_uint8, ctypes.c_uint16, ctypes.c_int16, ctypes.c_size_t


class Gray(ctypes.Structure):
    _fields_ = [("pixels", ctypes.c_void_p), ("width", U16), ("height", U16), ("stride", U16)]


class MatchConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("disparities", U16), ("window", U8), ("mode", U8), ("prefilter_cap", U8),
                ("uniqueness_percent", U8), ("texture_min", U8), ("lr_tolerance_px", U8), ("search_start_px", I16),
                ("kernel", ctypes.c_void_p)]


def load_library():
    build = pathlib.Path(os.environ.get("TSR_BUILD", "build"))
    found = sorted(build.rglob("libtsr_firmware.so"))
    if not found:
        sys.exit(f"no libtsr_firmware.so under {build}")
    library = ctypes.CDLL(str(found[0]))
    library.tsr_match_scratch_len.restype = SIZE
    library.tsr_match_start.argtypes = [ctypes.c_void_p, ctypes.c_void_p, Gray, Gray, ctypes.c_void_p, SIZE,
                                        ctypes.c_void_p, SIZE]
    return library


def load_pair(folder, width, height):
    """Centre-cropped to 4:3, reduced by area; the truth by nearest, in px of the reduced picture."""
    left, right = (cv2.imread(str(folder / f"{side}.png"), cv2.IMREAD_GRAYSCALE) for side in ("left", "right"))
    truth = cv2.imread(str(folder / "gt256_left.png"), cv2.IMREAD_UNCHANGED).astype(np.float32) / 256
    rows, columns = left.shape
    crop_width, crop_height = min(columns, rows * 4 // 3), min(rows, columns * 3 // 4)
    x, y = (columns - crop_width) // 2, (rows - crop_height) // 2
    left, right, truth = (p[y:y + crop_height, x:x + crop_width] for p in (left, right, truth))
    left, right = (cv2.resize(p, (width, height), interpolation=cv2.INTER_AREA) for p in (left, right))
    return left, right, cv2.resize(truth, (width, height), interpolation=cv2.INTER_NEAREST) * width / crop_width


def worsen(left, right, rng):
    """Sensor noise and another exposure of the right view, as the environment asks."""
    noise, light = float(os.environ.get("NOISE", "0")), float(os.environ.get("LIGHT", "1"))
    return [np.clip(np.rint(p * gain + rng.normal(0, noise, p.shape)), 0, 255).astype(np.uint8)
            for p, gain in ((left, 1), (right, light))]


def match(library, left, right, disparities, mode):
    def pointer(array):
        return array.ctypes.data_as(ctypes.c_void_p)

    height, width = left.shape
    config = MatchConfig(width, height, disparities, mode=MODES[mode])
    views = [Gray(p.ctypes.data, width, height, width) for p in (left, right)]
    result = np.zeros((height, width), np.uint16)
    scratch = np.zeros(library.tsr_match_scratch_len(ctypes.byref(config)), np.uint8)
    state = np.zeros(512, np.uint8)
    assert library.tsr_match_start(pointer(state), ctypes.byref(config), *views, pointer(result), result.size,
                                   pointer(scratch), scratch.size) == 0
    assert library.tsr_match_run(pointer(state), U16(65535)) == 0
    return result


def median(values):
    height, width = values.shape
    side = 2 * MEDIAN_RADIUS + 1
    padded = np.pad(values, MEDIAN_RADIUS, constant_values=INVALID)
    around = np.sort([padded[j:j + height, i:i + width] for j in range(side) for i in range(side)], axis=0)
    count = (around != INVALID).sum(axis=0)
    middle = np.take_along_axis(around, np.maximum(count - 1, 0)[None] // 2, axis=0)[0]
    return np.where(count >= MEDIAN_VALID_MIN, middle, INVALID).astype(np.uint16)


def without_specks(values, pixels):
    signed = np.where(values == INVALID, -1, values).astype(np.int16)
    cv2.filterSpeckles(signed, -1, pixels - 1, 16)
    return np.where(signed < 0, INVALID, signed).astype(np.uint16)


def filled(values):
    """Rows without any valid pixel take the row above."""
    result = values.astype(np.int64)
    for y, row in enumerate(result):
        valid = np.flatnonzero(row != INVALID)
        if valid.size == 0:
            row[:] = result[y - 1] if y else 0
            continue
        after = np.searchsorted(valid, np.arange(row.size))
        left, right = valid[np.maximum(after - 1, 0)], valid[np.minimum(after, valid.size - 1)]
        row[:] = np.where(row != INVALID, row, np.minimum(row[left], row[right]))
    return result


def quality(result, truth):
    known, valid = truth > 0, result != INVALID
    error = np.abs(result / 16 - truth)
    judged = known & valid
    right, right_half = (int((judged & (error <= limit)).sum()) for limit in (1, 0.5))
    return {"correct": right / known.sum(), "bad1": 1 - right / judged.sum(), "correct_half": right_half / known.sum(),
            "bad_half": 1 - right_half / judged.sum(), "median_error": float(np.median(error[judged])),
            "valid": judged.sum() / known.sum()}


def main():
    mode = sys.argv[2] if len(sys.argv) > 2 else "smooth"
    stage = sys.argv[3] if len(sys.argv) > 3 else "refined"
    library, rng = load_library(), np.random.default_rng(int(os.environ.get("SEED", "77")))
    report = {"mode": mode, "stage": stage}
    for width, height, disparities, speck in CASES:
        pairs = {}
        for folder in sorted(pathlib.Path(sys.argv[1]).glob("mb*")):
            left, right, truth = load_pair(folder, width, height)
            result = match(library, *worsen(left, right, rng), disparities, mode)
            if stage != "raw":
                result = without_specks(median(result), speck)
            pairs[folder.name] = quality(filled(result) if stage == "dense" else result, truth)
        keys = next(iter(pairs.values()))
        pairs["mean"] = {key: np.mean([pair[key] for pair in pairs.values()]) for key in keys}
        report[f"{width}x{height}"] = {name: {key: round(float(value), 4) for key, value in pair.items()}
                                       for name, pair in pairs.items()}
    print(json.dumps(report, indent=1).replace("\n   ", "").replace("\n  }", " }"))


if __name__ == "__main__":
    main()
