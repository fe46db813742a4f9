"""Bytes of gray views against the one before, and what they cost of the map: the figures of docs/codec.md, 3.8.

    TSR_BUILD=build/release python3 tests/bench/measure_history.py FOLDER_OF_PAIRS [TRIALS]

As measure_view.py's next views: an object of a tenth of the picture has appeared, or nothing, and every capture has noise
of one gray level. `lost` is what is lost of the correct pixels of the mode's map against exchanging the whole view.
Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import history_library  # noqa: E402
import stereo_pairs  # noqa: E402
import vision_library  # noqa: E402
from measure_view import NOISE_SIGMA, OBJECT_PART, changed_scenes, correct, noisy, show  # noqa: E402


def next_views(pairs, near, trials, mode, part):
    sizes, losses = [], []
    for i, pair in enumerate(pairs):
        lost, right, disparities = [], pair[1], pair[3]
        for new_left, new_right, new_truth, rng in changed_scenes(pair, pairs, i, trials, part):
            height, width = right.shape
            wing, lead = history_library.Held(width, height), history_library.Held(width, height)
            history_library.decode(history_library.encode(noisy(right, rng, NOISE_SIGMA), near, wing), lead)
            seen_left, seen_right = noisy(new_left, rng, NOISE_SIGMA), noisy(new_right, rng, NOISE_SIGMA)
            data = history_library.encode(seen_right, near, wing, history_library.choose_tiles(seen_right, wing))
            got = history_library.decode(data, lead)
            assert np.array_equal(wing.pixels, lead.pixels) and wing.struct.check == lead.struct.check
            sizes.append(len(data))
            fields = {"mode": vision_library.MODES[mode]}
            lost.append(correct(seen_left, seen_right, disparities, new_truth, **fields) -
                        correct(seen_left, got, disparities, new_truth, **fields))
        losses.append(np.mean(lost))
    return sizes, losses


def main(folder, trials):
    for width, height, disparities in stereo_pairs.CASES:
        pairs = [stereo_pairs.load(one, width, height) + (disparities,) for one in stereo_pairs.folders(folder)]
        print(f"{width}x{height}, {len(pairs)} pairs")
        for near, name in ((0, "lossless"), (8, "by activity")):
            for mode in ("smooth", "census"):
                show(f"next, {name}, {mode}", *next_views(pairs, near, trials, mode, OBJECT_PART))
            show(f"next, {name}, nothing changed", *next_views(pairs, near, 1, "smooth", 0.0))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 4)
