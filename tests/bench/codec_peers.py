"""Other codecs, as bytes of one picture: what the codecs of this project are measured beside.

JPEG XL is cjxl and djxl (libjxl-tools), PNG, WebP and the JPEG of libjpeg-turbo are OpenCV's, JPEG-LS is CharLS by the Python package
pillow-jpls and left out where that is not installed. Files count whole, headers included.

SPDX-License-Identifier: Apache-2.0
"""
import functools
import io
import math
import pathlib
import subprocess
import tempfile

import cv2
import numpy as np

try:
    import pillow_jpls  # noqa: F401  (gives Pillow the format)
    from PIL import Image
except ImportError:
    Image = None

XL_EFFORT = "9"
XL_LOSSY_EFFORT = "7"  # 9 takes ten times as long for a few hundredths
WEBP_LOSSLESS = 101


def write_pgm(path, picture):
    largest = 255 if picture.max() < 256 else 65535
    path.write_bytes(b"P5\n%d %d\n%d\n" % (picture.shape[1], picture.shape[0], largest) +
                     picture.astype(">u2" if largest > 255 else "u1").tobytes())


def run_xl(picture, *options):
    """The bytes, and the decoded picture."""
    with tempfile.TemporaryDirectory() as name:
        plain, coded, back = (pathlib.Path(name) / file for file in ("in.pgm", "coded.jxl", "out.pgm"))
        write_pgm(plain, picture)
        subprocess.run(["cjxl", plain, coded, *options, "--quiet"], check=True, stderr=subprocess.DEVNULL)
        subprocess.run(["djxl", coded, back, "--quiet"], check=True, stderr=subprocess.DEVNULL)
        return coded.stat().st_size, cv2.imread(str(back), cv2.IMREAD_UNCHANGED)


def lossless_xl(picture):
    size, decoded = run_xl(picture, "-d", "0", "-e", XL_EFFORT)
    assert np.array_equal(decoded, picture)
    return size


def encoded(picture, ending, *options):
    done, data = cv2.imencode(ending, picture, list(options))
    assert done
    return data


def lossless_webp(picture):
    """WebP has 8 bits a channel: the upper byte goes into a second one."""
    low, high = (picture & 255).astype(np.uint8), (picture >> 8).astype(np.uint8)
    channels = cv2.merge([low, low, low] if picture.max() < 256 else [low, high, low])
    data = encoded(channels, ".webp", cv2.IMWRITE_WEBP_QUALITY, WEBP_LOSSLESS)
    assert np.array_equal(cv2.imdecode(data, cv2.IMREAD_UNCHANGED), channels)
    return data.size


def lossless_ls(picture):
    data = io.BytesIO()
    Image.fromarray(picture).save(data, "JPEG-LS")
    return len(data.getvalue())


def lossless(picture):
    """{codec: bytes} of a picture of whole numbers below 65,536."""
    picture = np.ascontiguousarray(picture, np.uint8 if picture.max() < 256 else np.uint16)
    sizes = {"JPEG XL e9": lossless_xl(picture), "WebP": lossless_webp(picture)}
    if Image is not None:
        sizes["JPEG-LS"] = lossless_ls(picture)
    sizes["PNG"] = encoded(picture, ".png", cv2.IMWRITE_PNG_COMPRESSION, 9).size
    return sizes


def jpeg(picture, quality, optimise=1):
    data = encoded(picture, ".jpg", cv2.IMWRITE_JPEG_QUALITY, quality, cv2.IMWRITE_JPEG_OPTIMIZE, optimise)
    return data.size, cv2.imdecode(data, cv2.IMREAD_GRAYSCALE)


def webp(picture, quality):
    data = encoded(cv2.merge([picture] * 3), ".webp", cv2.IMWRITE_WEBP_QUALITY, quality)
    return data.size, cv2.cvtColor(cv2.imdecode(data, cv2.IMREAD_COLOR), cv2.COLOR_BGR2GRAY)


def lossy_xl(picture, distance):
    return run_xl(picture, "-d", f"{distance:.3f}", "-e", XL_LOSSY_EFFORT)


# {codec: (coder of (picture, level), levels from the poorest to the best)}
LOSSY = {
    "JPEG, optimised": (jpeg, range(1, 101)),
    "JPEG": (functools.partial(jpeg, optimise=0), range(1, 101)),
    "WebP": (webp, range(0, 101)),
    "JPEG XL e7": (lossy_xl, [15 * 0.9 ** i for i in range(36)]),
}


def bytes_at(goal, picture, code, levels, likeness):
    """Bytes at which a codec's picture is just as like as `goal`.

    By bisection the last level that is less like and the first that is not; between them the logarithm of the bytes goes
    along with the likeness, so that a codec of few levels is at no disadvantage.
    """
    @functools.lru_cache(maxsize=None)
    def at(index):
        size, decoded = code(picture, levels[index])
        return likeness(picture, decoded), size

    low, high = 0, len(levels) - 1
    if not at(low)[0] < goal <= at(high)[0]:
        raise ValueError(f"no level of the codec is at {goal}")
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if at(middle)[0] < goal else (low, middle)
    (less, small), (more, large) = at(low), at(high)
    return math.exp(np.interp(goal, [less, more], [math.log(small), math.log(large)]))
