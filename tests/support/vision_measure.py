"""Measure the vision layer on stereo pairs with ground truth: the figures of docs/math.md, chapter 6, as JSON.

    TSR_BUILD=build/release python3 tests/support/vision_measure.py FOLDER_OF_PAIRS [TRIALS]

FOLDER_OF_PAIRS/mb*/ holds left.png, right.png and gt256_left.png (disparity = value / 256, 0 unknown). Needs
python3-opencv. All randomness comes from SEED (environment, default 77).

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
SIZES = (((160, 120), 32), ((320, 240), 64))
NOISE_SIGMA = 2
LIGHT_GAIN = 1.3
OBJECT_PARTS = (0.02, 0.03, 0.05, 0.10)
NEARER_PX = 2  # an object is at least this much nearer than everything it hides
TEXTURE_STD_MIN = 12  # gray levels: what counts as a textured patch
U8, U16, I16, U32, SIZE = ctypes.c_uint8, ctypes.c_uint16, ctypes.c_int16, ctypes.c_uint32, ctypes.c_size_t


class Gray(ctypes.Structure):
    _fields_ = [("pixels", ctypes.c_void_p), ("width", U16), ("height", U16), ("stride", U16)]


class MatchConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("disparities", U16), ("window", U8), ("mode", U8), ("prefilter_cap", U8),
                ("uniqueness_percent", U8), ("texture_min", U8), ("lr_tolerance_px", U8), ("search_start_px", I16),
                ("kernel", ctypes.c_void_p)]


class SimilarityConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("block_log2", U8), ("clip_q4", U8), ("threshold_q8", U16),
                ("min_blocks", U16)]


class SimilarityResult(ctypes.Structure):
    _fields_ = [("mse_q8", U32), ("both_count", U32), ("one_count", U32), ("blocks", U16), ("different_blocks", U16)]


class ChangeConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("reduction", U8), ("amplification", U8), ("deviation_min", U8),
                ("deviation_max", U8), ("min_cells", U16), ("settle_frames", U8)]


class ChangeResult(ctypes.Structure):
    _fields_ = [("changed", ctypes.c_bool), ("settling", ctypes.c_bool), ("changed_cells", U16)]


def load_library():
    build = pathlib.Path(os.environ.get("TSR_BUILD", "build"))
    found = sorted(build.rglob("libtsr_firmware.so"))
    if not found:
        sys.exit(f"no libtsr_firmware.so under {build}")
    library = ctypes.CDLL(str(found[0]))
    library.tsr_match_scratch_len.restype = SIZE
    library.tsr_change_state_len.restype = SIZE
    library.tsr_similarity_is_similar.restype = ctypes.c_bool
    library.tsr_match_start.argtypes = [ctypes.c_void_p, ctypes.c_void_p, Gray, Gray, ctypes.c_void_p, SIZE,
                                        ctypes.c_void_p, SIZE]
    return library


LIB = load_library()
RNG = np.random.default_rng(int(os.environ.get("SEED", "77")))


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def view(picture):
    height, width = picture.shape
    return Gray(picture.ctypes.data, width, height, width)


def as_picture(values):
    return np.ascontiguousarray(np.clip(np.rint(values), 0, 255), np.uint8)


def noisy(picture):
    return as_picture(picture + RNG.normal(0, NOISE_SIGMA, picture.shape))


def match(left, right, disparities):
    """The map after matcher and median, with their defaults."""
    left, right = left.copy(), right.copy()
    height, width = left.shape
    config = MatchConfig(width, height, disparities)
    result = np.zeros((height, width), np.uint16)
    scratch = np.zeros(LIB.tsr_match_scratch_len(ctypes.byref(config)), np.uint8)
    state = np.zeros(512, np.uint8)
    assert LIB.tsr_match_start(pointer(state), ctypes.byref(config), view(left), view(right), pointer(result),
                               result.size, pointer(scratch), scratch.size) == 0
    assert LIB.tsr_match_run(pointer(state), U16(65535)) == 0
    assert LIB.tsr_median_start(pointer(state), U16(width), U16(height), pointer(result), SIZE(result.size),
                                pointer(scratch), SIZE(scratch.size)) == 0
    assert LIB.tsr_median_run(pointer(state), U16(65535)) == 0
    return result


def is_similar(a, b):
    height, width = a.shape
    config, result, state = SimilarityConfig(width, height), SimilarityResult(), np.zeros(512, np.uint8)
    assert LIB.tsr_similarity_start(pointer(state), ctypes.byref(config), pointer(a), pointer(b), SIZE(a.size)) == 0
    assert LIB.tsr_similarity_run(pointer(state), U16(65535)) == 0
    assert LIB.tsr_similarity_get_result(pointer(state), ctypes.byref(result)) == 0
    return LIB.tsr_similarity_is_similar(ctypes.byref(config), ctypes.byref(result))


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


def quality(result, truth):
    known, valid = truth > 0, result != INVALID
    error = np.abs(result / 16 - truth)
    judged = known & valid
    right = judged & (error <= 1)
    return {"correct": right.sum() / known.sum(), "bad1": 1 - right.sum() / judged.sum(),
            "correct_half": (judged & (error <= 0.5)).sum() / known.sum(), "median_error": np.median(error[judged]),
            "valid": judged.sum() / known.sum()}


def light_ramp(height, width):
    """A gain from 1 to LIGHT_GAIN across the picture, down it, or a spot."""
    x, y = np.meshgrid(np.linspace(0, 1, width), np.linspace(0, 1, height))
    kind = RNG.integers(0, 3)
    if kind == 2:
        centre, spread = RNG.uniform(0.2, 0.8, 2), RNG.uniform(0.15, 0.4)
        shape = np.exp(-((x - centre[0]) ** 2 + (y - centre[1]) ** 2) / (2 * spread ** 2))
    else:
        shape = y if kind else x
    return 1 + (LIGHT_GAIN - 1) * shape


def object_texture(height, width, others):
    """A textured patch of another scene, or smooth noise."""
    for _ in range(20 if RNG.random() < 0.5 else 0):
        scene = others[RNG.integers(len(others))]
        y, x = RNG.integers(0, scene.shape[0] - height + 1), RNG.integers(0, scene.shape[1] - width + 1)
        patch = scene[y:y + height, x:x + width]
        if patch.std() > TEXTURE_STD_MIN:
            return patch
    rough = RNG.uniform(0, 255, (height // 3 + 2, width // 3 + 2))
    return cv2.resize(rough, (width, height), interpolation=cv2.INTER_LINEAR)


def object_box(shape, part):
    area = part * shape[0] * shape[1]
    height = round((area / RNG.uniform(0.6, 1.6)) ** 0.5)
    width = round(area / height)
    return RNG.integers(0, shape[0] - height + 1), RNG.integers(0, shape[1] - width + 1), height, width


def with_object(left, right, truth, disparities, part, others):
    """Both views with an object before everything it hides and seen whole by both; nothing if it fits nowhere."""
    for _ in range(300):
        y, x, height, width = object_box(left.shape, part)
        hidden = truth[y:y + height, x:x + width]
        d = int(np.ceil(hidden.max() + NEARER_PX)) + int(RNG.integers(0, 4))
        if not (hidden > 0).any() or d > disparities - 2 or x < d:
            continue
        left, right = left.copy(), right.copy()
        left[y:y + height, x:x + width] = object_texture(height, width, others)
        right[y:y + height, x - d:x - d + width] = left[y:y + height, x:x + width]
        return left, right
    return None


def measure_quality(pairs, disparities):
    clean = [quality(match(left, right, disparities), truth) for left, right, truth in pairs]
    noise = [quality(match(noisy(left), noisy(right), disparities), truth) for left, right, truth in pairs]
    return {name: {key: round(float(np.mean([q[key] for q in values])), 4) for key in values[0]}
            for name, values in (("clean", clean), ("noise", noise))}


def measure_similarity(pairs, disparities, trials):
    """How often two maps are called similar: [count, of]."""
    counts = {}
    for i, (left, right, truth) in enumerate(pairs):
        others = [p[0] for j, p in enumerate(pairs) if j != i]
        for _ in range(trials):
            before = match(noisy(left), noisy(right), disparities)
            gain = light_ramp(*left.shape)
            cases = {"noise": (left, right), "light": (left * gain, right * gain)}
            cases.update({f"object {part:.0%}": with_object(left, right, truth, disparities, part, others)
                          for part in OBJECT_PARTS})
            for name, views in cases.items():
                if views is not None:
                    count = counts.setdefault(name, [0, 0])
                    count[0] += is_similar(match(noisy(views[0]), noisy(views[1]), disparities), before)
                    count[1] += 1
    return counts


class Watch:
    def __init__(self, height, width):
        config = ChangeConfig(width, height)
        self.state = np.zeros(LIB.tsr_change_state_len(ctypes.byref(config)), np.uint8)
        self.change = np.zeros(512, np.uint8)
        assert LIB.tsr_change_init(pointer(self.change), ctypes.byref(config), pointer(self.state),
                                   SIZE(self.state.size)) == 0

    def sees_change(self, frame):
        result, gray = ChangeResult(), view(frame)
        assert LIB.tsr_change_update(pointer(self.change), ctypes.byref(gray), ctypes.byref(result)) == 0
        return result.changed


def measure_change(pairs, trials):
    """Wakes by noise alone and by an object: [count, of]."""
    wakes = {"noise": [0, 0]}
    for i, (left, _, _) in enumerate(pairs):
        others = [p[0] for j, p in enumerate(pairs) if j != i]
        watch = Watch(*left.shape)
        for _ in range(10 * trials + 4):
            wakes["noise"][0] += watch.sees_change(noisy(left))
        wakes["noise"][1] += 10 * trials
        for part in (0.01, *OBJECT_PARTS):
            count = wakes.setdefault(f"object {part:.0%}", [0, 0])
            for _ in range(trials):
                watch = Watch(*left.shape)
                for _ in range(5):
                    watch.sees_change(noisy(left))
                y, x, height, width = object_box(left.shape, part)
                frame = left.copy()
                frame[y:y + height, x:x + width] = object_texture(height, width, others)
                count[0] += watch.sees_change(noisy(frame))
                count[1] += 1
    return wakes


def main():
    folders = sorted(pathlib.Path(sys.argv[1]).glob("mb*"))
    trials = int(sys.argv[2]) if len(sys.argv) > 2 else 30
    report = {}
    for (width, height), disparities in SIZES:
        pairs = [load_pair(folder, width, height) for folder in folders]
        report[f"{width}x{height}"] = {"pairs": len(pairs), "quality": measure_quality(pairs, disparities),
                                       "similar": measure_similarity(pairs, disparities, trials),
                                       "woken": measure_change(pairs, trials)}
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
