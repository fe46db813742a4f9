#!/usr/bin/env python3
"""Make the folders of maps from which `tarsier train-prior` learns the map codec's prior.

    map_maps.py DATA OUT
    tarsier train-prior OUT/maps OUT/sequences -o firmware/codec/map_prior.c

DATA is searched for the rectified pairs in PAIRS. Each is cropped to 4:3, reduced to the sizes of the product and matched
by `tarsier match` as nodes do unless told otherwise, upright and upside down: OUT/maps. OUT/sequences has a folder for every scene of
one static camera, two maps each: a pair with noise, and the same with other noise and a part of another picture in front.
TSR_BUILD names the build's folder, by default build/release. Needs NumPy and OpenCV.

SPDX-License-Identifier: Apache-2.0
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import stereo_pairs

TARSIER = pathlib.Path(os.environ.get("TSR_BUILD", ROOT / "build/release")) / "bin/tarsier"
PAIRS = ("mb*/left.png", "boofcv_bumblebee2/rectified/*_left.png")
MODE, REFINE = "sad", "median3"
SCENES = 2  # of a pair and size
NOISE = 1.0  # gray levels, standard deviation
AREA = (0.1, 0.3)  # of the picture, that the new object takes
RNG = np.random.default_rng(7)


def read(file):
    picture = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        sys.exit(f"map_maps.py: {file}: not a picture")
    return picture


def pairs(data):
    """(name, left, right) as files hold them."""
    for pattern in PAIRS:
        for left in sorted(data.glob(pattern)):
            right = left.with_name(left.name.replace("left", "right"))
            yield f"{left.parent.name}_{left.stem}", read(left), read(right)


def match(left, right, disparities, out):
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        files = [pathlib.Path(folder) / f"{side}.pgm" for side in ("left", "right")]
        for file, picture in zip(files, (left, right)):
            cv2.imwrite(str(file), picture)
        words = [TARSIER, "match", *files, "--disparities", disparities, "--mode", MODE, "--refine", REFINE, "-o", out]
        subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def noisy(picture):
    return np.clip(np.rint(picture + RNG.normal(0, NOISE, picture.shape)), 0, 255).astype(np.uint8)


def with_object(left, right, other, disparities):
    """Both views with a rectangle of the other picture, nearer than half of the search."""
    height, width = left.shape
    side = np.sqrt(RNG.uniform(*AREA))
    w, h = int(width * side), int(height * side)
    x, y = int(RNG.integers(disparities, width - w)), int(RNG.integers(0, height - h))
    disparity = int(RNG.integers(disparities // 2, disparities - 2))
    left, right = left.copy(), right.copy()
    left[y:y + h, x:x + w] = right[y:y + h, x - disparity:x - disparity + w] = other[y:y + h, x:x + w]
    return left, right


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path, help="folder of pairs")
    parser.add_argument("out", type=pathlib.Path, help="folder to write")
    options = parser.parse_args()
    found = list(pairs(options.data))
    if not found:
        sys.exit(f"map_maps.py: {options.data}: no pair in it")
    for i, (name, *views) in enumerate(found):
        for width, height, disparities in stereo_pairs.CASES:
            left, right = (stereo_pairs.reduced(view, width, height) for view in views)
            for turned, step in (("", 1), ("_turned", -1)):
                match(left[::step], right[::step], disparities, options.out / f"maps/{name}_{width}{turned}.pfm")
            other = stereo_pairs.reduced(found[(i + 3) % len(found)][1], width, height)
            for scene in range(SCENES):
                later = with_object(left, right, other, disparities)
                for number, (a, b) in enumerate(((left, right), later)):
                    match(noisy(a), noisy(b), disparities,
                          options.out / f"sequences/{name}_{width}_{scene}/{number}.pfm")
    print(f"{options.out}: {len(found)} pairs")


if __name__ == "__main__":
    main()
