"""Measure the vision layer on stereo pairs with ground truth: the figures of docs/math.md, chapter 6, as JSON.

    TSR_BUILD=build/release python3 tests/support/vision_measure.py FOLDER_OF_PAIRS [TRIALS]

FOLDER_OF_PAIRS/mb*/ holds left.png, right.png and gt256_left.png (disparity = value / 256, 0 unknown). Needs
python3-opencv. All randomness comes from SEED (environment, default 77). Maps are compared in steps of
2^STEP_LOG2 sixteenths of a pixel (environment, default 3: as a node sends them).

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import json
import os
import pathlib
import sys

import cv2
import map_library
import numpy as np
import stereo_pairs
import vision_library
from vision_library import (LIB, SIZE, U16, ChangeConfig, ChangeResult, SimilarityConfig, SimilarityResult, pointer,
                            view)

NOISE_SIGMA = 2
LIGHT_GAIN = 1.3
OBJECT_PARTS = (0.02, 0.03, 0.05, 0.10)
NEARER_PX = 2  # an object is at least this much nearer than everything it hides
TEXTURE_STD_MIN = 12  # gray levels: what counts as a textured patch
STEP_LOG2 = int(os.environ.get("STEP_LOG2", "3"))
RNG = np.random.default_rng(int(os.environ.get("SEED", "77")))


def as_picture(values):
    return np.ascontiguousarray(np.clip(np.rint(values), 0, 255), np.uint8)


def noisy(picture):
    return as_picture(picture + RNG.normal(0, NOISE_SIGMA, picture.shape))


def match(left, right, disparities):
    """The map after matcher and median, with their defaults."""
    return vision_library.refine(vision_library.match(left, right, disparities), ["median3"])


def sent(left, right, disparities):
    return map_library.quantise(match(left, right, disparities), disparities, STEP_LOG2)


def is_similar(a, b):
    height, width = a.shape
    config, result, state = SimilarityConfig(width, height), SimilarityResult(), np.zeros(512, np.uint8)
    assert LIB.tsr_similarity_start(pointer(state), ctypes.byref(config), pointer(a), pointer(b), SIZE(a.size)) == 0
    assert LIB.tsr_similarity_run(pointer(state), U16(65535)) == 0
    assert LIB.tsr_similarity_get_result(pointer(state), ctypes.byref(result)) == 0
    return LIB.tsr_similarity_is_similar(ctypes.byref(config), ctypes.byref(result))


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
    def mean(change):
        return stereo_pairs.mean([stereo_pairs.judge(match(change(left), change(right), disparities), truth)
                                  for left, right, truth in pairs])

    return {"clean": mean(lambda picture: picture), "noise": mean(noisy)}


def measure_similarity(pairs, disparities, trials):
    """How often two maps are called similar: [count, of]."""
    counts = {}
    for i, (left, right, truth) in enumerate(pairs):
        others = [p[0] for j, p in enumerate(pairs) if j != i]
        for _ in range(trials):
            before = sent(noisy(left), noisy(right), disparities)
            gain = light_ramp(*left.shape)
            cases = {"noise": (left, right), "light": (left * gain, right * gain)}
            cases.update({f"object {part:.0%}": with_object(left, right, truth, disparities, part, others)
                          for part in OBJECT_PARTS})
            for name, views in cases.items():
                if views is not None:
                    count = counts.setdefault(name, [0, 0])
                    count[0] += is_similar(sent(noisy(views[0]), noisy(views[1]), disparities), before)
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
    folders = stereo_pairs.folders(pathlib.Path(sys.argv[1]))
    trials = int(sys.argv[2]) if len(sys.argv) > 2 else 30
    report = {}
    for width, height, disparities in stereo_pairs.CASES:
        pairs = [stereo_pairs.load(folder, width, height) for folder in folders]
        report[f"{width}x{height}"] = {"pairs": len(pairs), "quality": measure_quality(pairs, disparities),
                                       "similar": measure_similarity(pairs, disparities, trials),
                                       "woken": measure_change(pairs, trials)}
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    main()
