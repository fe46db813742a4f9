"""The C codec of prefiltered views against tests/support/codec_decoder_view.py, written from docs/codec.md, chapter 4.

Both must decode the same views and hold the same afterwards: views exact with every cap and coarse, alone and against
the held one, of prefiltered pictures and of values at random; the same bytes damaged and cut, bytes at random, and
streams of decisions that no encoder takes; both must refuse the same headers. Literal pixels, which noise brings about
only in a large view with cap 7, are also had by lowering `allowed` on both sides. The C encoder's bytes are those that
1.4 says for the decisions in them. SEED replays a run: SEED=n python3 tests/vectors/test_codec_decoder_view.py

SPDX-License-Identifier: Apache-2.0
"""
import copy
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_decoder_view: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vector_pictures  # noqa: E402
import view_library  # noqa: E402
from codec_decoder import FormatError, NoReferenceError, VersionError  # noqa: E402
from codec_decoder_view import Held, ViewDecoder, decode_view  # noqa: E402
from codec_encoder import Decisions, Encoder  # noqa: E402

STATUS = {FormatError: -4, VersionError: -5, NoReferenceError: -13}
SIZES = ((1, 1), (1, 9), (9, 1), (8, 8), (7, 17), (33, 5), (40, 32), (71, 27))  # width, height
FRAMES = 3


class BothHeld:
    """What the C holds, and the Python."""

    def __init__(self, width, height):
        self.shape = width, height
        self.c = view_library.Held(width, height)
        self.python = Held()

    def copy(self):
        other = BothHeld(*self.shape)
        other.python = copy.deepcopy(self.python)
        other.c.packed[:] = self.c.packed
        other.c.struct.info, other.c.struct.check = self.c.struct.info, self.c.struct.check
        other.c.struct.full = self.c.struct.full
        return other

    def check(self, where):
        assert self.c.struct.full == (self.python.rows is not None), where
        if self.c.struct.full:
            assert self.c.struct.check == self.python.check(), where
            info = self.c.struct.info
            assert (info.width, info.height, info.cap, info.coarse) == self.python.shape, where


def check(data, held, where):
    """That both decode the same or refuse the same; the status, and the Python's rows."""
    found = view_library.decode(data, held.c)
    rows, status = None, 0
    try:
        rows = decode_view(data, held.python)[1]
    except (FormatError, VersionError, NoReferenceError) as error:
        status = STATUS[type(error)]
    if rows is None:
        assert isinstance(found, int) and found == status, (where, found, status)
    else:
        assert not isinstance(found, int) and (found == rows).all(), where
    held.check(where)
    return status, rows


def check_encoded(data, held, where):
    before = copy.deepcopy(held.python)
    _, rows = check(data, held, where)
    decoder = ViewDecoder(data, before)
    decoder.coder = Encoder(decoder.coder)
    assert decoder.decode() == rows
    assert data[:8 if decoder.mode else 6] + decoder.coder.finish() == data, where
    return rows


def damaged(rng, data):
    """Some bytes changed but those of the size, perhaps cut."""
    changed = bytearray(data)
    for _ in range(int(rng.integers(1, 4))):
        in_header = rng.random() < 0.1 or len(data) == 6
        at = int(rng.integers(0, 2) if in_header else rng.integers(6, len(data)))
        changed[at] ^= int(rng.integers(1, 256))
    return bytes(changed[:int(rng.integers(0, len(data) + 1))] if rng.random() < 0.3 else changed)


def header(held, mode):
    """Of a view as the held one."""
    width, height, cap, coarse = held.python.shape
    start = bytes([1 | mode << 4, cap | coarse << 3 | coarse << 4]) + width.to_bytes(2, "little")
    return start + height.to_bytes(2, "little") + (held.python.check().to_bytes(2, "little") if mode else b"")


def check_random(rng, held):
    """Decisions by chance, and plain bytes; alone and against what is held."""
    width, height = held.shape
    for mode in (0, 1):
        start = header(held, mode)
        decoder = ViewDecoder(start, copy.deepcopy(held.python))
        decoder.coder = Encoder(Decisions(rng))
        rows = decoder.decode()
        assert check(start + decoder.coder.finish(), held.copy(), "decisions")[1] == rows
        noise = rng.integers(0, 256, int(rng.integers(0, 64 + width * height)), np.uint8).tobytes()
        check(start + noise, held.copy(), "bytes")


class LoweredDecoder(ViewDecoder):
    """That has less allowed after each row, and so more literal pixels."""

    cuts = ()

    def row(self, y, *others):
        found = super().row(y, *others)
        self.allowed = max(self.allowed - self.cuts[y], 0)
        return found


def check_literal(rng, held):
    width, height = held.shape
    cuts = [int(cut) for cut in rng.choice((0, 0, 4 * width, 2048), height)]
    for mode in (0, 1):
        data = header(held, mode) + rng.integers(0, 256, 64 + width * height // 2, np.uint8).tobytes()
        decoder, allowed = LoweredDecoder(data, copy.deepcopy(held.python)), []
        decoder.cuts = cuts

        def lower(y, model):
            model.allowed_bits = max(model.allowed_bits - cuts[y], 0)
            allowed.append(model.allowed_bits)

        found = view_library.decode(data, held.copy().c, lower)
        assert (found == decoder.decode()).all(), (held.python.shape, mode)
        assert allowed[-1] == decoder.allowed, (held.python.shape, mode)


def check_sequence(rng, pictures, cap, coarse, counts):
    """Views one after another: the first alone, the next against what is held."""
    height, width = pictures[0].shape
    held = BothHeld(width, height)
    tiles = None
    for i, filtered in enumerate(pictures):
        where = (width, height, cap, coarse, i)
        data = view_library.encode(filtered, cap, coarse, held.copy().c, tiles)
        for _ in range(2):
            status = check(damaged(rng, data), held.copy(), where)[0]
            counts["damaged"] += 1
            counts["refused"] += status != 0
        rows = check_encoded(data, held, where)
        counts["encoded"] += 1
        if tiles is None and not coarse:
            assert (filtered == rows).all(), where
        if i + 1 < len(pictures):
            tiles = view_library.choose_tiles(pictures[i + 1], held.c) if rng.random() < 0.5 else \
                (rng.random(-(-width // 8) * -(-height // 8)) < rng.choice((0.1, 0.5))).astype(np.uint8)
    check_random(rng, held)
    counts["random"] += 4
    check_literal(rng, held)
    counts["literal"] += 2


def changed(rng, picture):
    """With noise of one gray level, and an object."""
    height, width = picture.shape
    other = np.clip(picture.astype(int) + rng.integers(-1, 2, picture.shape), 0, 255)
    y, x = int(rng.integers(0, height)), int(rng.integers(0, width))
    place = other[y:y + height // 3 + 1, x:x + width // 3 + 1]
    place[:] = rng.integers(0, 256, place.shape)
    return other.astype(np.uint8)


def check_headers(rng):
    width, height = 9, 10
    held = BothHeld(width, height)
    filtered = view_library.prefilter(vector_pictures.synthetic(rng, "wave", width, height))
    check(view_library.encode(filtered), held, "held")
    shape = bytes((width, 0, height, 0))
    right, wrong = (number.to_bytes(2, "little") for number in (held.python.check(), held.python.check() ^ 256))
    tails = (b"", shape[:3], shape, shape + right[:1], shape + right, shape + wrong, b"\0\0\1\0" + right,
             b"\1\0\0\0" + right, b"\x81\2\1\0" + right, b"\1\0\xe1\1" + right, b"\1\0\1\0" + right)
    starts = [(first, second) for first in (0x01, 0x11) for second in range(256)]
    starts += [(first, second) for first in range(256) for second in (0x07, 0x17, 0x1f, 0x20)]
    for start in starts:
        for tail in tails:
            data = bytes(start) + tail
            check(data, held.copy(), data)
    for data in (b"", b"\1", b"\2"):
        check(data, held.copy(), data)
    check(shape, BothHeld(width, height), "nothing held")
    check(b"\x11\x1f" + shape + right, BothHeld(width, height), "nothing held")


def main():
    seed = int(os.environ.get("SEED", "1"))
    print(f"replay: SEED={seed} python3 tests/vectors/test_codec_decoder_view.py")
    rng = np.random.default_rng(seed)
    counts = {"encoded": 0, "damaged": 0, "refused": 0, "random": 0, "literal": 0, "real": 0}
    kinds = [(cap, False) for cap in range(1, 8)] + [(7, True)] * 3
    for width, height in SIZES:
        for i, (cap, coarse) in enumerate(kinds):
            first = vector_pictures.synthetic(rng, vector_pictures.KINDS[i % len(vector_pictures.KINDS)], width, height)
            if i % 2:
                frames = [view_library.prefilter(frame, cap) for frame in
                          (first, *(changed(rng, first) for _ in range(FRAMES - 1)))]
            else:
                frames = [rng.integers(0, 2 * cap + 1, (height, width)).astype(np.uint8) for _ in range(FRAMES)]
            check_sequence(rng, frames, cap, coarse, counts)
    check_sequence(rng, [rng.integers(0, 15, (160, 240)).astype(np.uint8)], 7, False, counts)
    for _, _, right in vector_pictures.pairs(157, 117, 2):
        for cap, coarse in ((7, True), (7, False), (3, False)):
            frames = [view_library.prefilter(frame, cap) for frame in (right, changed(rng, right))]
            check_sequence(rng, frames, cap, coarse, counts)
            counts["real"] += len(frames)
    check_headers(rng)
    print(", ".join(f"{value} {name}" for name, value in counts.items()))


if __name__ == "__main__":
    main()
