"""Error of maps against their bytes for every step a map can be sent in, as decoded and as restored: JSON.

    TSR_BUILD=build/release python3 tests/bench/step_curve.py FOLDER_OF_PAIRS > CURVE.json

Importing it loads the library of the build in TSR_BUILD. Pairs and sizes: tests/support/stereo_pairs.py. Needs
python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import json
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import map_library  # noqa: E402
import stereo_pairs  # noqa: E402
import vision_library  # noqa: E402

FILTERS = {"sad": ("median3",), "smooth": ("median5", "speckle")}  # sad's are a node's
SPECKLE_OF_160 = 60
STEPS_LOG2 = range(5)
GOOD_PX = 1  # a match this near to the truth is no wrong match, and its error one of precision


def judge(disparity_map, truth, good):
    """rms and mean over the good pixels, median over all with match and truth, correct of all with truth; px."""
    error = np.abs(disparity_map / 16 - truth)
    judged = (truth > 0) & (disparity_map != vision_library.INVALID)
    return {"rms_px": float(np.sqrt((error[good] ** 2).mean())), "mean_px": float(error[good].mean()),
            "median_px": float(np.median(error[judged])),
            "correct_half": float((judged & (error <= 0.5)).sum() / (truth > 0).sum())}


def there_and_back(found, truth, disparities, step_log2):
    """Bytes of one map, and what the receiver has of it; good are the same pixels for every step."""
    good = (truth > 0) & (found != vision_library.INVALID) & (np.abs(found / 16 - truth) <= GOOD_PX)
    sent = map_library.quantise(found, disparities, step_log2)
    data = map_library.CODEC.encode(sent, disparities, step_log2)
    decoded = map_library.CODEC.decode(data, sent.shape)
    assert np.array_equal(decoded, sent)
    restored = map_library.restore(decoded, map_library.info_of(decoded, disparities, step_log2))
    return {"bytes": len(data), **judge(decoded, truth, good),
            **{f"restored_{key}": value for key, value in judge(restored, truth, good).items()}}


def curve(folder):
    """One dict a mode, size and step: mode, width, height, step_px and means over the pairs. bytes of the coded map;
    rms_px and mean_px of pixels that the map as matched has within GOOD_PX; median_px of all with match and truth;
    correct_half, the part of all with truth that is within 1/2 px; and the last four of the restored map, restored_*."""
    points = []
    for mode, filters in FILTERS.items():
        for width, height, disparities in stereo_pairs.CASES:
            found = []
            for pair in stereo_pairs.folders(pathlib.Path(folder)):
                left, right, truth = stereo_pairs.load(pair, width, height)
                found.append((vision_library.refine(
                    vision_library.match(left, right, disparities, mode=vision_library.MODES[mode]), filters,
                    SPECKLE_OF_160 * width // 160), truth))
            for step_log2 in STEPS_LOG2:
                figures = [there_and_back(*one, disparities, step_log2) for one in found]
                points.append({"mode": mode, "width": width, "height": height, "step_px": 2 ** step_log2 / 16,
                               **stereo_pairs.mean(figures)})
    return points


if __name__ == "__main__":
    print(json.dumps(curve(sys.argv[1]), indent=1))
