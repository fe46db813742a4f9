"""Stereo pairs with ground truth, cut and reduced as every figure of the project has them, and the judge of maps.

A folder of pairs has mb*/ with left.png, right.png and gt256_left.png (disparity = value / 256, 0 unknown). Needs
python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import cv2
import numpy as np

INVALID = 65535
CASES = ((160, 120, 32), (320, 240, 64))  # width, height, disparities


def folders(folder):
    return sorted(folder.glob("mb*"))


def crop(picture):
    """The centre, 4:3."""
    rows, columns = picture.shape
    width, height = min(columns, rows * 4 // 3), min(rows, columns * 3 // 4)
    x, y = (columns - width) // 2, (rows - height) // 2
    return picture[y:y + height, x:x + width]


def reduced(view, width, height):
    """The centre, by area."""
    return cv2.resize(crop(view), (width, height), interpolation=cv2.INTER_AREA)


def load(folder, width, height):
    """Views, and the truth by nearest, in px of the reduced picture."""
    left, right = (reduced(cv2.imread(str(folder / f"{side}.png"), cv2.IMREAD_GRAYSCALE), width, height)
                   for side in ("left", "right"))
    truth = crop(cv2.imread(str(folder / "gt256_left.png"), cv2.IMREAD_UNCHANGED).astype(np.float32) / 256)
    crop_width = truth.shape[1]
    return left, right, cv2.resize(truth, (width, height), interpolation=cv2.INTER_NEAREST) * width / crop_width


def judge(disparity_map, truth):
    """correct: within 1 px, of all pixels with truth; bad1: not so, of the valid ones; _half: the same for 1/2 px."""
    known, valid = truth > 0, disparity_map != INVALID
    error = np.abs(disparity_map / 16 - truth)
    judged = known & valid
    right, right_half = (int((judged & (error <= limit)).sum()) for limit in (1, 0.5))
    return {"correct": right / known.sum(), "bad1": 1 - right / judged.sum(), "correct_half": right_half / known.sum(),
            "bad_half": 1 - right_half / judged.sum(), "median_error": float(np.median(error[judged])),
            "valid": judged.sum() / known.sum()}


def mean(judged):
    return {key: round(float(np.mean([one[key] for one in judged])), 4) for key in judged[0]}
