"""The C codec of gray images against held ones against tests/support/codec_decoder_history.py, written from docs/codec.md.

Both must decode the same sequences of images of every content, shape, near and choice of tiles, the same damaged bytes, and
refuse the same headers and the same held images. SEED replays a run:
SEED=n python3 tests/vectors/test_codec_decoder_history.py

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_decoder_history: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import history_library  # noqa: E402
from codec_decoder import FormatError, NoReferenceError, VersionError  # noqa: E402
from codec_decoder_history import HistoryDecoder  # noqa: E402

STATUS = {FormatError: -4, VersionError: -5, NoReferenceError: -13}
SEQUENCES, IMAGES = 60, 3


def draw(rng, width, height):
    y, x = np.mgrid[0:height, 0:width]
    return [np.full(x.shape, rng.integers(0, 256)), 2 * x + y + rng.integers(0, 4, x.shape),
            (x // 9) * 70 + (y // 5) * 110 + rng.integers(0, 3, x.shape),
            rng.integers(0, 256, x.shape)][rng.integers(0, 4)].astype(np.uint8)


def check(data, held):
    """That both say the same of these bytes; the image, or None. `held` (a Held) takes it if it decodes."""
    before = held.pixels.copy() if held.struct.full else None
    found = history_library.try_decode(data, held)
    try:
        expected = np.array(HistoryDecoder(data, before).decode(), np.uint8)
    except (FormatError, VersionError, NoReferenceError) as error:
        assert found == STATUS[type(error)], (found, data.hex())
        return None
    assert not isinstance(found, int), (found, data.hex())
    assert np.array_equal(found, expected), data.hex()
    return found


def copy_of(held):
    other = history_library.Held(held.pixels.shape[1], held.pixels.shape[0])
    other.pixels[:] = held.pixels
    for field in ("width", "height", "check", "full"):
        setattr(other.struct, field, getattr(held.struct, field))
    return other


def check_sequence(rng, counts):
    width, height, near = int(rng.integers(1, 50)), int(rng.integers(1, 40)), int(rng.integers(0, 9))
    wing, lead = history_library.Held(width, height), history_library.Held(width, height)
    tile_count = -(-width // 8) * -(-height // 8)
    for turn in range(IMAGES):
        tiles = rng.integers(0, 2, tile_count).astype(np.uint8) if turn else None
        data = history_library.encode(draw(rng, width, height), near, wing, tiles)
        for _ in range(2):
            damaged = bytearray(data[:rng.integers(0, len(data) + 1)])
            for _ in range(2 if damaged else 0):
                damaged[rng.integers(0, min(len(damaged), rng.choice((8, 400))))] ^= 1 << int(rng.integers(0, 8))
            if len(damaged) < 6 or damaged[2:6] == data[2:6]:  # the size that there is room for
                counts["refused"] += check(bytes(damaged), copy_of(lead)) is None
                counts["damaged"] += 1
        assert check(data, lead) is not None
        assert np.array_equal(wing.pixels, lead.pixels)
        counts["images"] += 1


def main():
    seed = int(os.environ.get("SEED", "1"))
    print(f"replay: SEED={seed} python3 tests/vectors/test_codec_decoder_history.py")
    rng, counts = np.random.default_rng(seed), {"images": 0, "damaged": 0, "refused": 0}
    for _ in range(SEQUENCES):
        check_sequence(rng, counts)
    print(", ".join(f"{value} {name}" for name, value in counts.items()))


if __name__ == "__main__":
    main()
