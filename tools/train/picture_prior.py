#!/usr/bin/env python3
"""Train the prior of the picture codec on a folder of pictures and write firmware/codec/picture_prior.c.

    picture_prior.py DATA [--without PREFIX] [--out FILE]

DATA is searched for the kinds of pictures in SOURCES. Each is cropped to 4:3, reduced to one of the two sizes of the
product and coded at the steps that come closest to an SSIM of 0.86, 0.90 and 0.94; what each context is asked there is
one stream of bits. The prior of a context is the pair of probability and count with which the codec's own
contexts code all of its streams in the fewest bits. --without leaves out the pictures whose folder's name begins so, to measure on them.
Needs a C compiler, NumPy and OpenCV.

SPDX-License-Identifier: Apache-2.0
"""
import argparse
import ctypes
import pathlib
import re
import subprocess
import sys
import tempfile

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
CODEC = ROOT / "firmware/codec"
SIZES = ((320, 240), (160, 120))
SSIM_TARGETS = (0.86, 0.90, 0.94)
STEPS = range(12, 60, 4)
BITS_MAX = 1 << 22
CODEC_SOURCES = ("picture*.c", "gray*.c", "view*.c", "packet*.c")
# Pattern, every how many of its files. Views of one place are alike, so few of each are taken.
SOURCES = (("mb*/left.png", 1), ("mb2006*/right.png", 1), ("mb2014*/right.png", 1), ("boofcv_bumblebee2/scenes/*", 3),
           ("boofcv_bumblebee2/rectified/*", 2), ("boofcv_bumblebee2/chess/*", 11), ("stereopi_chess_320x240/**/*", 14),
           ("strecha_*/*.jpg", 3), ("strecha_*/*.png", 3), ("mview_temple_sparse_ring/*.png", 8),
           ("rgbd_office_slambook2/color/*", 1))


def build(folder):
    """The codec with its questions recorded, as a library."""
    includes = [f"-I{ROOT}/firmware/{layer}/include" for layer in ("base", "codec")]
    compile_one = ["cc", "-O2", "-fPIC", "-std=c11", *includes, "-c"]
    sources = [path for pattern in ("range_port.c", "frame.c", *CODEC_SOURCES) for path in CODEC.glob(pattern)]
    sources = {*sources, *(ROOT / "firmware/base").glob("*.c")}
    for source in sources:
        subprocess.run([*compile_one, "-Dtsr_range_encode_bit=prior_trace_bit", source], cwd=folder, check=True)
    for source in (CODEC / "range.c", ROOT / "tools/train/prior_trace.c"):
        subprocess.run([*compile_one, source], cwd=folder, check=True)
    subprocess.run(["cc", "-shared", "-o", "trace.so", *folder.glob("*.o"), "-lm"], cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "trace.so"))
    library.prior_trace_picture.restype = library.prior_trace_count.restype = ctypes.c_size_t
    library.prior_fit.restype = ctypes.c_uint16
    return library


def reduce(image, size):
    rows, columns = image.shape
    width, height = min(columns, rows * 4 // 3), min(rows, columns * 3 // 4)
    x, y = (columns - width) // 2, (rows - height) // 2
    return np.ascontiguousarray(cv2.resize(image[y:y + height, x:x + width], size, interpolation=cv2.INTER_AREA))


def pictures(data, without):
    for pattern, every in SOURCES:
        for i, path in enumerate(sorted(data.glob(pattern))[::every]):
            image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) if path.is_file() else None
            if image is None or (without and path.relative_to(data).parts[0].startswith(without)):
                continue
            if image.shape[1] > 2 * image.shape[0]:  # both views of a raw pair, side by side
                image = image[:, :image.shape[1] // 2]
            for size in SIZES if pattern.startswith("mb") else (SIZES[i % 2],):
                yield reduce(image, size)


def ssim(a, b):
    """docs/math.md, (89), without holes."""
    kernel = cv2.getGaussianKernel(11, 1.5)
    a, b = a.astype(np.float64), b.astype(np.float64)
    mean_a, mean_b, aa, bb, ab = (cv2.sepFilter2D(i, -1, kernel, kernel)[5:-5, 5:-5] for i in (a, b, a * a, b * b, a * b))
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    return float((((2 * mean_a * mean_b + c1) * (2 * (ab - mean_a * mean_b) + c2)) /
                  ((mean_a ** 2 + mean_b ** 2 + c1) * (aa - mean_a ** 2 + bb - mean_b ** 2 + c2))).mean())


def code(library, image, step):
    """The decoded picture, and what was asked: 2 * context + bit, in order."""
    decoded, asked, count = image.copy(), np.zeros(BITS_MAX, np.uint32), ctypes.c_size_t()
    height, width = image.shape
    length = library.prior_trace_picture(decoded.ctypes.data_as(ctypes.c_void_p), width, height, step, 0,
                                         asked.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(BITS_MAX),
                                         ctypes.byref(count))
    if not length:
        sys.exit("the codec refused a picture")
    return decoded, asked[:count.value].copy()


def streams(library, image):
    """What is asked at the steps nearest to the targets."""
    found = [(ssim(image, decoded), asked) for decoded, asked in (code(library, image, step) for step in STEPS)]
    return [min(found, key=lambda one: abs(one[0] - target))[1] for target in SSIM_TARGETS]


def fit(library, asked_of, context_count):
    """The prior of each context, and what it costs in bits."""
    by_context = []
    for asked in asked_of:
        order = np.argsort(asked >> 1, kind="stable")
        by_context.append(((asked[order] & 1).astype(np.uint8),
                           np.searchsorted(asked[order] >> 1, np.arange(context_count + 1))))
    prior, total, cost = [], 0.0, ctypes.c_double()
    for context in range(context_count):
        parts = [bits[at[context]:at[context + 1]] for bits, at in by_context]
        parts = [part for part in parts if len(part)]
        bits = np.concatenate([*parts, np.zeros(1, np.uint8)])
        begins = np.cumsum([0, *map(len, parts)]).astype(np.uintp)
        prior.append(library.prior_fit(bits.ctypes.data_as(ctypes.c_void_p), begins.ctypes.data_as(ctypes.c_void_p),
                                       ctypes.c_size_t(len(parts)), ctypes.byref(cost)) if parts else 0x8000)
        total += cost.value if parts else 0
    return prior, total


def rows_of(prior):
    return ",\n    ".join(", ".join(f"0x{value:04x}" for value in prior[i:i + 14]) for i in range(0, len(prior), 14))


def table(prior):
    return ("/*\n * What the contexts of pictures start from; tools/train/picture_prior.py writes this file.\n *\n"
            " * SPDX-License-Identifier: Apache-2.0\n */\n#include \"picture_block.h\"\n\n"
            "const uint16_t tsr_picture_prior[TSR_PICTURE_CONTEXT_COUNT] = {\n    " + rows_of(prior) + "};\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--without", default="", metavar="PREFIX")
    parser.add_argument("--out", type=pathlib.Path, default=CODEC / "picture_prior.c")
    arguments = parser.parse_args()
    header = (CODEC / "include/tsr/codec/picture.h").read_text("utf-8")
    context_count = int(re.search(r"TSR_PICTURE_CONTEXT_COUNT (\d+)", header)[1])
    with tempfile.TemporaryDirectory() as folder:
        library = build(pathlib.Path(folder))
        asked_of = [asked for image in pictures(arguments.data, arguments.without) for asked in streams(library, image)]
        prior, cost = fit(library, asked_of, context_count)
    arguments.out.write_text(table(prior), "utf-8")
    print(f"{len(asked_of)} streams, {sum(map(len, asked_of))} adaptive bits, coded in {cost:.0f}")


if __name__ == "__main__":
    main()
