"""The C picture codec against tests/support/codec_decoder_picture.py, written from docs/codec.md, chapter 5.

Both must decode the same pictures: what the C encodes of every kind, size, step, prior and target, the same bytes
damaged and cut, bytes at random, and streams of decisions that no encoder takes. The C encoder's bytes are those that
1.4 says for the decisions in them. SEED replays a run: SEED=n python3 tests/vectors/test_codec_decoder_picture.py

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_decoder_picture: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vector_pictures  # noqa: E402
import picture_library  # noqa: E402
from codec_decoder import FormatError, VersionError  # noqa: E402
from codec_decoder_picture import PictureDecoder, decode_picture  # noqa: E402
from codec_encoder import Decisions, Encoder  # noqa: E402

ERR_FORMAT, ERR_VERSION = -4, -5
HEADER_LEN = 6
SIZES = ((1, 1), (1, 9), (9, 1), (8, 8), (7, 17), (33, 5), (40, 32), (70, 41))  # width, height


def check(data, where):
    """That both decode the same or refuse the same; the status, and the Python's rows."""
    found = picture_library.decode(data)
    rows, status = None, 0
    try:
        rows = decode_picture(data)[1]
    except FormatError:
        status = ERR_FORMAT
    except VersionError:
        status = ERR_VERSION
    if rows is None:
        assert isinstance(found, int) and found == status, (where, found, status)
    else:
        assert not isinstance(found, int) and (found == rows).all(), where
    return status, rows


def check_encoded(data, where):
    _, rows = check(data, where)
    decoder = PictureDecoder(data)
    decoder.coder = Encoder(decoder.coder)
    assert decoder.decode() == rows
    assert data[:HEADER_LEN] + decoder.coder.finish() == data, where


def damaged(rng, data):
    """The same header, but for the size; some bytes changed, perhaps cut."""
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, 4))):
        in_header = rng.random() < 0.1 or len(data) == HEADER_LEN
        at = int(rng.integers(0, 2) if in_header else rng.integers(HEADER_LEN, len(data)))
        changed[at] ^= int(rng.integers(1, 256))
    return bytes(changed[:int(rng.integers(0, len(data) + 1))] if rng.random() < 0.3 else changed)


def header(rng, width, height):
    return bytes([1, int(rng.integers(0, 64)) | int(rng.integers(0, 2)) << 6]) + width.to_bytes(2, "little") + \
        height.to_bytes(2, "little")


def check_random(rng, width, height):
    """Decisions by chance, and plain bytes."""
    start = header(rng, width, height)
    decoder = PictureDecoder(start)
    decoder.coder = Encoder(Decisions(rng))
    rows = decoder.decode()
    data = start + decoder.coder.finish()
    assert check(data, "decisions")[1] == rows
    check(start + rng.integers(0, 256, int(rng.integers(0, 64 + width * height)), np.uint8).tobytes(), "bytes")


def check_headers():
    for first in range(256):
        for second in (0, 63, 64, 127, 128, 192, 255):
            for size in (b"", b"\1\0\1", b"\1\0\1\0", b"\0\0\1\0", b"\1\0\0\0", b"\x81\2\1\0", b"\1\0\xe1\1"):
                check(bytes([first, second]) + size, (first, second, size))
    for data in (b"", b"\1", b"\2"):
        check(data, data)


def main():
    seed = int(os.environ.get("SEED", "1"))
    print(f"replay: SEED={seed} python3 tests/vectors/test_codec_decoder_picture.py")
    rng = np.random.default_rng(seed)
    counts = {"encoded": 0, "damaged": 0, "refused": 0, "random": 0, "real": 0}
    for width, height in SIZES:
        for kind in vector_pictures.KINDS:
            for prior in (0, 1):
                for step in (0, int(rng.integers(1, 30)), int(rng.integers(30, 45)), 63):
                    picture = vector_pictures.synthetic(rng, kind, width, height)
                    target_len = int(rng.choice((0, 0, width * height // 8 + 8)))
                    data = picture_library.encode(picture, step, prior, target_len)
                    where = (width, height, kind, prior, step, target_len)
                    check_encoded(data, where)
                    counts["encoded"] += 1
                    counts["refused"] += check(damaged(rng, data), where)[0] != 0
                    counts["damaged"] += 1
        for _ in range(8):
            check_random(rng, width, height)
            counts["random"] += 1
    for name, left, _ in vector_pictures.pairs(157, 117, 3):
        for step, target_len in ((35, 0), (int(rng.integers(0, 30)), 0), (36, 900)):
            check_encoded(picture_library.encode(left, step, target_len=target_len), (name, step, target_len))
            counts["real"] += 1
    check_headers()
    print(", ".join(f"{value} {name}" for name, value in counts.items()))


if __name__ == "__main__":
    main()
