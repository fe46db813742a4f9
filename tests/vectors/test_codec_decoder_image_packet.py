"""The C codec of packets of images against tests/support/codec_decoder_image_packet.py, written from docs/codec.md.

Both must decode the same of every packet alone, of images of every content, shape and packet length, of damaged packets and
of bytes at random, and refuse the same headers. SEED replays a run:
SEED=n python3 tests/vectors/test_codec_decoder_image_packet.py

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_decoder_image_packet: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import codec_decoder_image_packet as reference  # noqa: E402
import packet_library  # noqa: E402
from codec_decoder import FormatError, NoReferenceError, VersionError  # noqa: E402
from vision_library import LIB  # noqa: E402

STATUS = {FormatError: -4, VersionError: -5, NoReferenceError: -13}
DECODERS = {"gray": reference.GrayPacketDecoder, "view": reference.ViewPacketDecoder,
            "picture": reference.PicturePacketDecoder}
WAYS = {"gray": [(near,) for near in range(9)],  # fields of info after width and height
        "view": [(cap, False) for cap in range(1, 8)] + [(7, True)],
        "picture": [(step, 1) for step in (0, 12, 24, 36, 48, 63)]}
CONTENTS = ("flat", "slope", "blocks", "noise")
IMAGES = 12  # of each way and content


def draw(rng, content, width, height):
    y, x = np.mgrid[0:height, 0:width]
    return {"flat": np.full(x.shape, rng.integers(0, 256)),
            "slope": 2 * x + y + rng.integers(0, 4, x.shape),
            "blocks": (x // 9) * 70 + (y // 5) * 110 + rng.integers(0, 3, x.shape),
            "noise": rng.integers(0, 256, x.shape)}[content].astype(np.uint8)


def check(kind, info, how, packet_id, data):
    """That both say the same of these bytes; gives the status."""
    width, height = info
    expected, pixels = np.zeros((height, width), np.uint8), []
    decoder = None
    try:
        decoder = DECODERS[kind]((width, height, *how), packet_id, data)
        pixels, status = decoder.decode(), 0
    except (FormatError, VersionError, NoReferenceError) as error:
        status = STATUS[type(error)]
    for x, y, pixel in pixels:
        expected[y, x] = pixel
    receiver = packet_library.Receiver(LIB, kind, width, height, how, packet_id)
    where = f"{kind} {width}x{height} {how} id {packet_id}: {data.hex()}"
    assert receiver.take(data)[0] == status, where
    assert np.array_equal(receiver.image, expected), where
    if kind == "picture" and decoder:
        marks = receiver.arrived.reshape(-(-height // 8), -1)
        assert {(x, y): marks[y, x] - 1 for y, x in zip(*np.nonzero(marks))} == decoder.limits, where
    return status


def check_image(rng, kind, how, content, counts):
    width, height = (int(n) for n in rng.integers(1, 60, 2))
    packet_id, cap = int(rng.integers(0, 8)), int(rng.integers(20, 200))
    image = draw(rng, content, width, height)
    for data in packet_library.Sender(LIB, kind, image, how, packet_id).all(cap):
        assert check(kind, (width, height), how, packet_id, data) == 0
        damaged = bytearray(data[:rng.integers(0, len(data) + 1)])
        for _ in range(3 if damaged else 0):
            damaged[rng.integers(0, len(damaged))] ^= 1 << int(rng.integers(0, 8))
        check(kind, (width, height), how, packet_id, bytes(damaged))
        counts["packets"] += 1
        counts["literal"] += data[3] >> 2 & 1
    for literal in (0, 1):
        header = (1 << 30 | packet_id << 27 | literal << 26 | int(rng.integers(0, 3)) << 17).to_bytes(4, "little")
        check(kind, (width, height), how, packet_id, header + rng.integers(0, 256, 80, dtype=np.uint8).tobytes())


def check_headers(kind, how):
    refused = 0
    for version in range(4):
        for packet_id in (0, 5):
            for first in (0, 1, 73, 74, 75, 0x1FFF):
                for count in (0, 1, 74, 75, 511):
                    word = version << 30 | packet_id << 27 | count << 17 | first
                    refused += check(kind, (35, 17), how, 5, word.to_bytes(4, "little")) != 0
    return refused


def main():
    seed = int(os.environ.get("SEED", "1"))
    print(f"replay: SEED={seed} python3 tests/vectors/test_codec_decoder_image_packet.py")
    rng, counts = np.random.default_rng(seed), {"packets": 0, "literal": 0}
    for kind, ways in WAYS.items():
        for how in ways:
            for content in CONTENTS:
                for _ in range(-(-IMAGES // len(ways))):
                    check_image(rng, kind, how, content, counts)
        print(f"{kind}: {check_headers(kind, ways[0])} headers refused alike")
    print(", ".join(f"{value} {name}" for name, value in counts.items()))


if __name__ == "__main__":
    main()
