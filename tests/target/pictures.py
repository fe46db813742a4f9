"""Pictures for the workbench: the demo's Aloe frames, and with TSR_DATA the stereo pairs in that folder. Not a test.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import re
import struct
import zlib

import board

OPENCV_PICTURES = pathlib.Path("/usr/share/doc/opencv-doc/examples/data")
SIZES = {"160x120": (160, 120, 32), "320x240": (320, 240, 64)}  # width, height, disparities
FRAME_BEFORE, FRAME_AFTER = "000", "040"  # of the demo's recording: an object has come in between
PNG_CHANNELS = {0: 1, 2: 3, 6: 4}
LUMA = (77, 150, 29)  # / 256, ITU-R BT.601


def read_pgm(path):
    """Width, height and pixels of an 8-bit P5 file."""
    data = pathlib.Path(path).read_bytes()
    header = re.match(rb"P5\s+(\d+)\s+(\d+)\s+255\s", data)
    if header is None:
        raise board.BoardError(f"{path}: not an 8-bit P5 file")
    width, height = int(header[1]), int(header[2])
    return width, height, data[header.end():header.end() + width * height]


def unfilter_row(kind, row, above, step):
    """PNG (ISO/IEC 15948), chapter 9."""
    for i in range(len(row)):
        a = row[i - step] if i >= step else 0
        b = above[i]
        c = above[i - step] if i >= step else 0
        if kind == 4:
            p = a + b - c
            guess = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        else:
            guess = (0, a, b, (a + b) // 2)[kind]
        row[i] = (row[i] + guess) & 255
    return row


def read_png(path):
    """Width, height and gray pixels of a PNG of 8 bits per channel, not interlaced."""
    data = pathlib.Path(path).read_bytes()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", data[at + 8:at + 21])
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    if depth != 8 or colour not in PNG_CHANNELS or interlace:
        raise board.BoardError(f"{path}: a kind of PNG that is not read here")
    step = PNG_CHANNELS[colour]
    lines, line = zlib.decompress(packed), width * step
    row, pixels = bytearray(line), bytearray()
    for start in range(0, len(lines), line + 1):
        row = unfilter_row(lines[start], bytearray(lines[start + 1:start + 1 + line]), row, step)
        if step == 1:
            pixels += row
        else:
            pixels += bytes(sum(w * v for w, v in zip(LUMA, row[i:i + 3])) >> 8 for i in range(0, line, step))
    return width, height, bytes(pixels)


def scaled(width, height, pixels, to_width, to_height):
    """Box mean of whole pixels."""
    out = bytearray()
    for v in range(to_height):
        rows = range(v * height // to_height, max((v + 1) * height // to_height, v * height // to_height + 1))
        for u in range(to_width):
            left = u * width // to_width
            right = max((u + 1) * width // to_width, left + 1)
            values = [value for y in rows for value in pixels[y * width + left:y * width + right]]
            out.append((sum(values) + len(values) // 2) // len(values))
    return bytes(out)


def demo_scene(folder):
    """The demo's frames and site, written below folder by the tarsier program."""
    program = board.HOST_BUILD / "bin/tarsier"
    if not (OPENCV_PICTURES / "aloeL.jpg").exists():
        raise board.Missing(f"no aloeL.jpg in {OPENCV_PICTURES}; run tools/setup test")
    if not program.exists():
        raise board.Missing(f"{program} is not built")
    scene = pathlib.Path(folder) / "scene"
    if not scene.exists():
        board.run([program, "demo-scene", "--pictures", OPENCV_PICTURES, "--out", scene])
    return scene


def write_case(folder, before, left, right):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, pixels in (("before", before), ("left", left), ("right", right)):
        (folder / f"{name}.gray").write_bytes(pixels)
    return folder


def aloe_cases(work_folder):
    """Workbench cases of the Aloe pair in both sizes: (name, folder, (width, height, disparities))."""
    scene = demo_scene(work_folder)
    found = []
    for size, shape in SIZES.items():
        pixels = {}
        for name, path in (("before", f"left{shape[0]}/{FRAME_BEFORE}.pgm"),
                           ("left", f"left{shape[0]}/{FRAME_AFTER}.pgm"),
                           ("right", f"right{shape[0]}/{FRAME_AFTER}.pgm")):
            *found_shape, pixels[name] = read_pgm(scene / path)
            if tuple(found_shape) != shape[:2]:
                raise board.BoardError(f"{path}: {found_shape}, not {shape[:2]}")
        found.append((f"aloe {size}", write_case(pathlib.Path(work_folder) / f"aloe-{size}", **pixels), shape))
    return found


def data_cases(work_folder):
    """Cases of the pairs left.png, right.png in the folders of TSR_DATA, at 160x120; none if it is not set."""
    data = os.environ.get("TSR_DATA")
    found = []
    shape = SIZES["160x120"]
    for left_file in sorted(pathlib.Path(data).glob("*/left.png")) if data else []:
        pair = left_file.parent
        if (pair / "right.png").exists():
            left, right = (scaled(*read_png(pair / f"{side}.png"), *shape[:2]) for side in ("left", "right"))
            folder = write_case(pathlib.Path(work_folder) / pair.name, bytes(len(left)), left, right)
            found.append((f"{pair.name} 160x120", folder, shape))
    return found
