"""Quality of a mode and filters on stereo pairs with ground truth, per pair and mean, as JSON.

    TSR_BUILD=build/release python3 tests/support/vision_quality.py FOLDER_OF_PAIRS MODE [STEP,STEP...] [FIELD=N ...]

MODE and STEPs are those of `tarsier match`; FIELD is one of struct tsr_match_config, or speckle, the least size of an
island at 160x120 (default 60, twice that at 320x240). Figures: tests/support/stereo_pairs.py. NOISE=sigma adds sensor
noise to both views, LIGHT=gain multiplies the right view, SEED is the noise's. Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import json
import os
import pathlib
import sys

import numpy as np
import stereo_pairs
from vision_library import MODES, match, refine


def worsen(left, right, rng):
    noise, light = float(os.environ.get("NOISE", "0")), float(os.environ.get("LIGHT", "1"))
    return [np.clip(np.rint(p * gain + rng.normal(0, noise, p.shape)), 0, 255).astype(np.uint8)
            for p, gain in ((left, 1), (right, light))]


def measure(folder, mode, steps, speckle=60, **fields):
    """{size: {pair: figures, "mean": figures}}"""
    rng = np.random.default_rng(int(os.environ.get("SEED", "77")))
    report = {}
    for width, height, disparities in stereo_pairs.CASES:
        pairs = {}
        for pair in stereo_pairs.folders(pathlib.Path(folder)):
            left, right, truth = stereo_pairs.load(pair, width, height)
            result = match(*worsen(left, right, rng), disparities, mode=MODES[mode], **fields)
            result = refine(result, steps, speckle * width // 160) if steps else result
            pairs[pair.name] = {key: round(float(value), 4) for key, value in
                                stereo_pairs.judge(result, truth).items()}
        pairs["mean"] = stereo_pairs.mean(list(pairs.values()))
        report[f"{width}x{height}"] = pairs
    return report


def main():
    words = [word for word in sys.argv[1:] if "=" not in word]
    fields = {name: int(value) for name, value in (word.split("=") for word in sys.argv[1:] if "=" in word)}
    steps = words[2].split(",") if len(words) > 2 else []
    report = {"mode": words[1], "steps": steps, **measure(words[0], words[1], steps, **fields)}
    print(json.dumps(report, indent=1).replace("\n   ", "").replace("\n  }", " }"))


if __name__ == "__main__":
    main()
