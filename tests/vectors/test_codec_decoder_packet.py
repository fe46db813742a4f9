"""The C codec of packets of maps against tests/support/codec_decoder_packet.py, written from docs/codec.md, chapter 2a.

Both must decode the same pixels of every packet alone, and stop at the same one with the same error: packets of maps of
every kind, shape, step and length, the same packets damaged and cut, bytes at random, and streams of decisions that no
encoder takes; and both must refuse the same headers. The C encoder's bytes are those that 1.4 says for the decisions in
them. SEED replays a run: SEED=n python3 tests/vectors/test_codec_decoder_packet.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_decoder_packet: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vector_pictures  # noqa: E402
import map_library  # noqa: E402
import vision_library  # noqa: E402
from codec_decoder import FormatError, NoReferenceError, VersionError  # noqa: E402
from codec_decoder_packet import PacketDecoder, decode_packet  # noqa: E402
from codec_encoder import Decisions, Encoder  # noqa: E402
from codec_library import MISSING, PACKET_SCRATCH_COUNT, Info, pointer  # noqa: E402
from vision_library import AGAIN, ANY, LIB, OK, SIZE, U8  # noqa: E402

STATUS = {FormatError: -4, VersionError: -5, NoReferenceError: -13}
SHIFT = 5
VERSION, HEADER_LEN, LEN_MIN, COUNT_MAX = 2, 4, 20, 4096
STATE_LEN = 16384
SIZES = ((1, 1), (1, 9), (9, 1), (5, 7), (39, 6), (40, 5), (41, 9), (80, 20), (83, 23), (121, 12))  # width, height
KINDS = ("noise", "slope", "blocks", "zero", "empty")


class Packet(ctypes.Structure):
    _fields_ = [("map_id", U8), ("is_literal", ctypes.c_bool), ("first", ctypes.c_uint32), ("count", ctypes.c_uint32)]


LIB.tsr_map_packets_start.argtypes = [ANY, ANY, ANY, SIZE, U8, ANY, SIZE]
LIB.tsr_map_packets_next.argtypes = [ANY, ANY, SIZE, ANY]
LIB.tsr_map_packets_clear.argtypes = [ANY, ANY, SIZE]
LIB.tsr_map_packet_decode.argtypes = [ANY, ANY, U8, ANY, SIZE, ANY, SIZE, ANY, ANY, SIZE]


def encode(disparity_map, info, map_id, lens):
    """Packets of the lengths that the iterator says."""
    rows = np.ascontiguousarray(disparity_map)
    state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(PACKET_SCRATCH_COUNT, np.uint16)
    assert LIB.tsr_map_packets_start(pointer(state), ctypes.byref(info), pointer(rows), info.width, map_id,
                                     pointer(scratch), scratch.size) == OK
    packets, status = [], AGAIN
    while status == AGAIN:
        out, length = np.zeros(next(lens), np.uint8), SIZE(0)
        status = LIB.tsr_map_packets_next(pointer(state), pointer(out), out.size, ctypes.byref(length))
        assert status in (OK, AGAIN), status
        packets.append(out[:length.value].tobytes())
    return packets


def decode(rng, info, map_id, data):
    """The C: (status, what the packet says of itself, the map with only its pixels)"""
    told, result = Packet(), np.zeros((info.height, info.width), np.uint16)
    assert LIB.tsr_map_packets_clear(ctypes.byref(info), pointer(result), info.width) == OK
    state, scratch = np.zeros(STATE_LEN, np.uint8), rng.integers(0, 65536, PACKET_SCRATCH_COUNT).astype(np.uint16)
    status = LIB.tsr_map_packet_decode(pointer(state), ctypes.byref(info), map_id, data, len(data), pointer(scratch),
                                       scratch.size, ctypes.byref(told), pointer(result), info.width)
    return status, told, result


def check(rng, info, map_id, data, where):
    """That both decode the same and stop the same; the status, and the map with the packet's pixels."""
    expected = np.full((info.height, info.width), MISSING, np.uint16)
    expected_status, pixels, decoder = 0, (), None
    try:
        decoder, pixels = decode_packet(info, map_id, data)
    except (FormatError, VersionError, NoReferenceError) as error:
        expected_status, pixels = STATUS[type(error)], getattr(error, "rows", ())
    for x, y, value in pixels:
        expected[y, x] = value
    status, told, found = decode(rng, info, map_id, data)
    assert status == expected_status, (where, status, expected_status)
    assert (found == expected).all(), where
    if pixels:
        assert told.count == len(pixels), where
    if decoder is not None:
        assert (told.map_id, told.is_literal, told.first) == (map_id, decoder.is_literal, decoder.first), where
    return status, found


def check_map(rng, disparity_map, info, counts):
    map_id = int(rng.integers(0, 8))
    cap = int(rng.choice((LEN_MIN, 30, 100, 1000)))
    lens = iter(lambda: cap if rng.random() < 0.7 else int(rng.integers(LEN_MIN, 200)), None)
    whole = np.full(disparity_map.shape, MISSING, np.uint16)
    for data in encode(disparity_map, info, map_id, lens):
        where = (info.width, info.height, info.disparities, info.step_log2, info.near, data)
        status, found = check(rng, info, map_id, data, where)
        assert status == OK, where
        whole = np.where(found == MISSING, whole, found)
        decoder = PacketDecoder(info, map_id, data)
        counts["literal"] += decoder.is_literal
        decoder.coder = Encoder(decoder.coder, SHIFT)
        decoder.decode()
        assert data[:HEADER_LEN] + decoder.coder.finish() == data, where
        counts["encoded"] += 1
        changed = bytearray(data)
        for _ in range(int(rng.integers(1, 4))):
            last = HEADER_LEN if rng.random() < 0.2 else len(changed)
            changed[int(rng.integers(0, last))] ^= int(rng.integers(1, 256))
        changed = bytes(changed[:int(rng.integers(0, len(changed) + 1))] if rng.random() < 0.3 else changed)
        counts["refused"] += check(rng, info, map_id, changed, where)[0] != OK
        counts["damaged"] += 1
    wrong = whole.astype(int) - disparity_map
    assert np.abs(wrong).max() <= info.near << info.step_log2, info.near


def check_random(rng, info):
    """Decisions by chance, and plain bytes."""
    groups = -(-info.width * info.height // 8)
    first = int(rng.integers(0, groups))
    count = int(rng.integers(1, min(COUNT_MAX // 8, groups - first) + 1))
    map_id = int(rng.integers(0, 8))
    start = (VERSION << 30 | map_id << 27 | int(rng.random() < 0.1) << 26 | (count - 1) << 17 | first).to_bytes(4, "little")
    decoder = PacketDecoder(info, map_id, start)
    decoder.coder = Encoder(Decisions(rng), SHIFT)
    try:
        decoded = len(decoder.decode())
    except FormatError as error:
        decoded = len(error.rows)
    data = start + decoder.coder.finish()
    assert (check(rng, info, map_id, data, data)[1] != MISSING).sum() == decoded, data
    data = start + rng.integers(0, 256, int(rng.integers(0, 200)), np.uint8).tobytes()
    check(rng, info, map_id, data, data)


def check_headers(rng):
    info = Info(35, 17, 16, 2)  # 595 pixels: the last group of 8 has 3
    for length in range(4):
        check(rng, info, 0, b"\0\0\0\x80"[:length], length)
    groups = -(-info.width * info.height // 8)
    for version in range(4):
        for map_id in (0, 1, 7):
            for first in (0, groups - 2, groups - 1, groups, groups + 1, 2**17 - 1):
                for count in (0, 1, groups - 1, groups, 511):
                    data = (version << 30 | map_id << 27 | count << 17 | first).to_bytes(4, "little")
                    check(rng, info, 1, data, data)


def real_maps():
    """Of stereo pairs, as a node would send them."""
    for _, left, right in vector_pictures.pairs(120, 90, 2):
        disparity_map = vision_library.match(left, right, 32, window=9, mode=0, prefilter_cap=7, uniqueness_percent=15,
                                             kernel=vision_library.portable_kernel())
        for step_log2 in (0, 2, 4):
            yield map_library.quantise(disparity_map, 32, step_log2), step_log2


def main():
    seed = int(os.environ.get("SEED", "1"))
    print(f"replay: SEED={seed} python3 tests/vectors/test_codec_decoder_packet.py")
    rng = np.random.default_rng(seed)
    counts = {"encoded": 0, "literal": 0, "damaged": 0, "refused": 0, "random": 0, "real maps": 0}
    for width, height in SIZES:
        for kind in KINDS:
            for step_log2 in range(5):
                disparities = int(rng.choice([1, 2, 16, 31, 48, 64, 128]))
                info = Info(width, height, disparities, step_log2, int(rng.integers(0, 2)))
                disparity_map = vector_pictures.synthetic_map(rng, kind, width, height, disparities, step_log2)
                check_map(rng, disparity_map, info, counts)
                for _ in range(2):
                    check_random(rng, info)
                    counts["random"] += 2
    for disparity_map, step_log2 in real_maps():
        height, width = disparity_map.shape
        check_map(rng, disparity_map, Info(width, height, 32, step_log2), counts)
        counts["real maps"] += 1
    check_headers(rng)
    print(", ".join(f"{value} {name}" for name, value in counts.items()))


if __name__ == "__main__":
    main()
