"""Bytes and likeness of reference images by the picture codec's step, beside near-lossless gray: docs/codec.md, 5.11.

    TSR_BUILD=build/release python3 tests/bench/measure_reference.py FOLDER_OF_PAIRS [FIRST_STEP LAST_STEP]

Left views of all pairs, cut and reduced as every figure has them. Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import pathlib
import sys

import cv2
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import stereo_pairs  # noqa: E402
import view_library  # noqa: E402
from vision_library import ANY, LIB, OK, SIZE, U8, U16, U32, pointer  # noqa: E402

STATE_LEN = 4096  # more than a coder of pictures
PRIOR_TRAINED = 1
BLOCK, EXCESS_LEN = 8, 2048
STEPS = (30, 40)
NEAR = 4


class PictureInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("step", U8), ("prior", U8)]


LIB.tsr_picture_encode_start.argtypes = [ANY, ANY, U32, ANY, SIZE, ANY, SIZE]
LIB.tsr_picture_encode_rows.argtypes = LIB.tsr_picture_decode_rows.argtypes = [ANY, ANY, SIZE, U16]
LIB.tsr_picture_decode_start.argtypes = [ANY, ANY, SIZE, ANY, SIZE, ANY]


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
    height, width = picture.shape
    info, length, picture = PictureInfo(width, height, step, PRIOR_TRAINED), SIZE(), np.ascontiguousarray(picture)
    out, decoded = np.zeros(picture.size + EXCESS_LEN, np.uint8), np.zeros_like(picture)
    state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(11 * (width + BLOCK), np.uint8)
    assert LIB.tsr_picture_encode_start(pointer(state), ctypes.byref(info), 0, pointer(out), out.size, pointer(scratch),
                                        scratch.size) == OK
    assert LIB.tsr_picture_encode_rows(pointer(state), pointer(picture), width, height) == OK
    assert LIB.tsr_picture_encode_finish(pointer(state), ctypes.byref(length)) == OK
    assert LIB.tsr_picture_decode_start(pointer(state), pointer(out), length.value, pointer(scratch), scratch.size,
                                        ctypes.byref(info)) == OK
    assert LIB.tsr_picture_decode_rows(pointer(state), pointer(decoded), width, height) == OK
    return length.value, decoded


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
