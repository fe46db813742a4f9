"""Bytes and likeness of reference images by the picture codec's step, beside near-lossless gray: docs/codec.md, 5.11.

    TSR_BUILD=build/release python3 tests/bench/measure_reference.py FOLDER_OF_PAIRS [FIRST_STEP LAST_STEP]

Left views of all pairs, cut and reduced as every figure has them. Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sys

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import picture_library  # noqa: E402
import stereo_pairs  # noqa: E402
import view_library  # noqa: E402

STEPS = (30, 40)
NEAR = 4


def ssim(a, b):
    """docs/math.md, (89), without holes."""
    kernel = cv2.getGaussianKernel(11, 1.5)
    a, b = a.astype(np.float64), b.astype(np.float64)
    mean_a, mean_b, aa, bb, ab = (cv2.sepFilter2D(i, -1, kernel, kernel)[5:-5, 5:-5] for i in (a, b, a * a, b * b, a * b))
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    return float((((2 * mean_a * mean_b + c1) * (2 * (ab - mean_a * mean_b) + c2)) /
                  ((mean_a ** 2 + mean_b ** 2 + c1) * (aa - mean_a ** 2 + bb - mean_b ** 2 + c2))).mean())


def code(picture, step):
    """Bytes of a picture, and the picture as it is decoded."""
    data = picture_library.encode(picture, step)
    return len(data), picture_library.decode(data)


def show(name, views, coder):
    text, everything = f"{name:8s}", []
    for (width, height), pictures in views.items():
        found = [(size, ssim(picture, decoded)) for picture in pictures for size, decoded in [coder(picture)]]
        sizes, likeness = zip(*found)
        everything += likeness
        text += (f"   {width}x{height}: {np.mean(sizes):6.0f} bytes ({min(sizes)} .. {max(sizes)}), SSIM "
                 f"{np.mean(likeness):.4f} ({min(likeness):.3f} .. {max(likeness):.3f})")
    print(f"{text}   all {len(everything)}: SSIM {np.mean(everything):.4f}")


def main(folder, first, last):
    views = {(width, height): [stereo_pairs.load(one, width, height)[0] for one in stereo_pairs.folders(folder)]
             for width, height, _ in stereo_pairs.CASES}
    for step in range(first, last + 1):
        show(f"step {step}", views, lambda picture, k=step: code(picture, k))
    show(f"near {NEAR}", views, lambda picture: view_library.code_gray(picture, NEAR))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), *(map(int, sys.argv[2:4]) if len(sys.argv) > 3 else STEPS))
