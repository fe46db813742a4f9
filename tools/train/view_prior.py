#!/usr/bin/env python3
"""Train a prior of coarse views on a folder of pictures and write a view_prior.c.

    view_prior.py DATA --out FILE [--without PREFIX]

DATA is searched for the kinds of pictures in SOURCES; each is cropped to 4:3, reduced to SIZE and coded as a wing's first view. Then a
part of another picture appears in front, between two captures with noise, and the second is coded against the first: SCENES times a
picture. What each context is asked in a view is one stream of bits. The prior of a context is the pair of probability and
count with which the codec's own contexts code all of its streams in the fewest bits. --without leaves out the pictures whose folder's name
begins so, to measure on them. A codec with another firmware/codec/view_prior.c is another format: it needs the next PRIOR_OF_COARSE in
view.c. Needs a C compiler, NumPy and OpenCV.

SPDX-License-Identifier: Apache-2.0
"""
import argparse
import ctypes
import pathlib
import re
import sys
import tempfile

import cv2
import numpy as np
import prior_training
from prior_training import CODEC, ROOT, TRAIN

sys.path.insert(0, str(ROOT / "tests/support"))
import stereo_pairs

SIZE = (160, 120)
SCENES = 3  # objects a picture
AREAS = (0.02, 0.05, 0.1, 0.2)  # of the picture, that an object takes
NOISE_SIGMA = 1.0  # gray levels, of each capture
# Pattern, every how many of its files. Views of one place are alike, so few of each are taken.
SOURCES = (("mb*/left.png", 1), ("mb*/right.png", 1), ("boofcv_bumblebee2/*/*.png", 1), ("boofcv_bumblebee2/chess/right*.jpg", 3),
           ("boofcv_bumblebee2/scenes/*.jpg", 1), ("stereopi*/**/right*.png", 3), ("strecha*/*.jpg", 2), ("mview*/*.png", 8),
           ("rgbd*/color/*.png", 1))
COMMENT = """ * Where the contexts of coarse views start: docs/codec.md, 4.5. tools/train/view_prior.py
 * writes this file.
"""


def pictures(data, without):
    for pattern, every in SOURCES:
        for path in sorted(data.glob(pattern))[::every]:
            image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
            if image is None or (without and path.relative_to(data).parts[0].startswith(without)):
                continue
            if image.shape[1] > 2 * image.shape[0]:  # both views of a raw pair, side by side
                image = image[:, :image.shape[1] // 2]
            yield np.ascontiguousarray(stereo_pairs.reduced(image, *SIZE))


def noisy(image, rng):
    return np.clip(np.rint(image + rng.normal(0, NOISE_SIGMA, image.shape)), 0, 255).astype(np.uint8)


def with_object(image, other, rng):
    """A rectangle of the other picture, at another place than there."""
    height, width = image.shape
    across = int(rng.integers(width // 8, width * 2 // 5))
    down = min(max(round(width * height * rng.choice(AREAS) / across), 4), height - 8)
    (x, from_x), (y, from_y) = rng.integers(0, width - across, 2), rng.integers(0, height - down, 2)
    changed = image.copy()
    changed[y:y + down, x:x + across] = other[from_y:from_y + down, from_x:from_x + across]
    return changed


def streams(library, images, rng):
    """What is asked in first views, and in those after an object has appeared."""
    def code(image, is_next):
        return prior_training.trace(library.prior_trace_view, image.copy(), ctypes.c_bool(is_next))

    for i, image in enumerate(images):
        yield code(image, False)
        for _ in range(SCENES):
            other = images[(i + 1 + rng.integers(len(images) - 1)) % len(images)]
            code(noisy(image, rng), False)
            yield code(noisy(with_object(image, other, rng), rng), True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--without", default="", metavar="PREFIX")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    header = (CODEC / "include/tsr/codec/view.h").read_text("utf-8")
    context_count = int(re.search(r"TSR_VIEW_CONTEXT_COUNT (\d+)", header)[1])
    images = list(pictures(arguments.data, arguments.without))
    if len(images) < 2:
        sys.exit(f"view_prior.py: {arguments.data}: fewer than two pictures")
    with tempfile.TemporaryDirectory() as folder:
        library = prior_training.build(pathlib.Path(folder), CODEC.glob("view*.c"),
                                       (ROOT / "firmware/vision").glob("prefilter*.c"), TRAIN / "view_trace.c")
        asked_of = list(streams(library, images, np.random.default_rng(7)))
        prior, cost = prior_training.fit(library, asked_of, context_count)
    arguments.out.write_text(prior_training.table(prior, COMMENT, "view_row.h", "tsr_view_prior[TSR_VIEW_CONTEXT_COUNT]"),
                             "utf-8")
    print(f"{len(images)} pictures, {len(asked_of)} streams, {sum(map(len, asked_of))} adaptive bits, coded in {cost:.0f}")


if __name__ == "__main__":
    main()
