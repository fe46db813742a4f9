"""The C codec against the decoders of tests/support/codec_decoder.py, written from docs/codec.md.

The C encodes pictures of every kind, maps also near-lossless and against references; the Python must decode the same
picture, and both must say the same about damaged bytes and streams of decisions that no encoder takes, row for row. The
C encoder's bytes are those that 1.4 says for the decisions in them. SEED replays a run:
SEED=n python3 tests/vectors/test_codec_decoder.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_codec_decoder: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import codec_decoder as reference  # noqa: E402
import vector_pictures  # noqa: E402
from codec_encoder import Decisions, Encoder  # noqa: E402

OK, AGAIN, ERR_FORMAT, ERR_VERSION, ERR_REFERENCE = 0, 1, -4, -5, -13
REFERENCES = (None, "equal", "shifted", "changed", "noise", "other", "invalid")
STATE_LEN = 16384  # more than any coder's state
SLOW_PIXELS = 4096  # a picture of as many is only decoded, once


def load_library():
    build = pathlib.Path(os.environ.get("TSR_BUILD", "build"))
    found = sorted(build.rglob("libtsr_firmware.so"))
    if not found:
        sys.exit(f"no libtsr_firmware.so under {build}")
    return ctypes.CDLL(str(found[0]))


class MapInfo(ctypes.Structure):
    _fields_ = [("width", ctypes.c_uint16), ("height", ctypes.c_uint16), ("disparities", ctypes.c_uint16),
                ("step_log2", ctypes.c_uint8), ("near", ctypes.c_uint8), ("d0_q4", ctypes.c_int16),
                ("has_reference", ctypes.c_bool), ("reference_id", ctypes.c_uint16)]


class MapReference(ctypes.Structure):
    """Of an array whose rows may lie apart; the array must outlive it."""
    _fields_ = [("map", ctypes.c_void_p), ("stride", ctypes.c_size_t), ("id", ctypes.c_uint16)]

    def __init__(self, array, name):
        super().__init__(array.ctypes.data, array.strides[0] // array.itemsize, name)


class GrayInfo(ctypes.Structure):
    _fields_ = [("width", ctypes.c_uint16), ("height", ctypes.c_uint16), ("near", ctypes.c_uint8)]


LIB = load_library()
for kind in ("map", "gray"):
    getattr(LIB, f"tsr_{kind}_encoded_len_max").restype = ctypes.c_size_t


def pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def reference_argument(kind, against):
    """The argument that only maps have."""
    return () if kind == "gray" else (None,) if against is None else (ctypes.byref(against),)


def encode(kind, info, pixels, against=None):
    state = np.zeros(STATE_LEN, np.uint8)
    out = np.zeros(getattr(LIB, f"tsr_{kind}_encoded_len_max")(ctypes.byref(info)), np.uint8)
    scratch = np.zeros(3 * (info.width + 5), pixels.dtype)
    length = ctypes.c_size_t(0)
    size = ctypes.c_size_t
    buffers = pointer(out), size(out.size), pointer(scratch), size(scratch.size)
    if against is None:
        status = getattr(LIB, f"tsr_{kind}_encode_start")(pointer(state), ctypes.byref(info), *buffers)
    else:
        status = LIB.tsr_map_encode_start_against(pointer(state), ctypes.byref(info), ctypes.byref(against), *buffers)
    assert status == OK, status
    status = getattr(LIB, f"tsr_{kind}_encode_rows")(pointer(state), pointer(pixels), size(info.width), info.height)
    assert status == OK, status
    status = getattr(LIB, f"tsr_{kind}_encode_finish")(pointer(state), ctypes.byref(length))
    assert status == OK, status
    return out[:length.value].tobytes()


def decode(kind, data, dtype, info, against=None):
    """(status, rows decoded before a status that is an error)"""
    state = np.zeros(STATE_LEN, np.uint8)
    data = np.frombuffer(data, np.uint8) if data else np.zeros(1, np.uint8)[:0]
    scratch = np.zeros(3 * 645, dtype)
    size = ctypes.c_size_t
    status = getattr(LIB, f"tsr_{kind}_decode_start")(pointer(state), pointer(data), size(data.size),
                                                      *reference_argument(kind, against), pointer(scratch),
                                                      size(scratch.size), ctypes.byref(info))
    rows = []
    if status != OK:
        return status, rows
    for _ in range(info.height):
        row = np.zeros(info.width, dtype)
        status = getattr(LIB, f"tsr_{kind}_decode_rows")(pointer(state), pointer(row), size(info.width), 1)
        if status < 0:
            break
        rows.append(row.tolist())
    return status, rows


def make_reference(rng, kind, pixels, info):
    """A map of the same shape, its rows apart; "other" has another step and other disparities."""
    height, width = pixels.shape
    noise = vector_pictures.synthetic_map(rng, "noise", width, height, info.disparities, info.step_log2)
    result = np.zeros((height, width + int(rng.integers(0, 4))), np.uint16)[:, :width]
    result[:] = {"equal": pixels,
                 "shifted": np.roll(pixels, (int(rng.integers(0, 2)), 1), (0, 1)),
                 "changed": np.where(rng.random((height, width)) < 0.1, noise, pixels),
                 "noise": noise,
                 "other": vector_pictures.synthetic_map(rng, "noise", width, height, 128, 0),
                 "invalid": reference.INVALID}[kind]
    return result


def check_rewritten(decoder, data, rows):
    """1.4: the bytes that the decisions in them say."""
    start = data[:len(data) - len(decoder.coder.data)]
    decoder.coder = Encoder(decoder.coder)
    assert decoder.decode() == rows
    assert start + decoder.coder.finish() == data


def check_chosen(rng, kind, start, dtype, make_info, make_decoder, against=None):
    """Decisions by chance: whether they are refused."""
    decoder = make_decoder(start)
    decoder.coder = Encoder(Decisions(rng))
    try:
        rows = decoder.decode()
    except reference.FormatError as error:
        rows = error.rows
    data = start + decoder.coder.finish()

    def decode_again(bytes_):
        again = make_decoder(bytes_)
        found = again.decode()
        assert found == rows
        return again, found

    return check_bytes(kind, data, dtype, make_info(), against, decode_again)


def check_map(rng, kind, reference_kind, info, counts):
    where = (kind, reference_kind, [getattr(info, field) for field, _ in info._fields_])
    pixels = vector_pictures.synthetic_map(rng, kind, info.width, info.height, info.disparities, info.step_log2)
    name = int(rng.integers(0, 65536))
    against = rows_against = None
    if reference_kind is not None:
        array = make_reference(rng, reference_kind, pixels, info)
        against, rows_against = MapReference(array, name), array.tolist()
    data = encode("map", info, pixels, against)

    header, rows = reference.decode_map(data, rows_against, name)
    decoded = np.array(rows, int)
    assert ((decoded == reference.INVALID) == (pixels == reference.INVALID)).all(), where
    assert np.abs(decoded - pixels).max() <= info.near << info.step_log2, where
    for field in ("disparities", "step_log2", "near", "d0_q4"):
        assert getattr(header, field) == getattr(info, field), (where, field)
    assert header.reference_id == (None if against is None else name), where
    found = MapInfo()
    assert decode("map", data, np.uint16, found, against) == (OK, rows), where
    assert (found.near, found.has_reference) == (info.near, against is not None), where
    if against is not None:
        assert found.reference_id == name, where
        for other, other_rows in ((None, None), (MapReference(array, name ^ 1), rows_against)):
            assert check_bytes("map", data, np.uint16, MapInfo(), other,
                               lambda bytes_, rows_=other_rows: reference.decode_map(bytes_, rows_, name ^ 1)), where
    counts["map"] += 1
    more = int(rng.integers(4)) if info.width * info.height < SLOW_PIXELS else None
    if more == 0:
        check_rewritten(reference.MapDecoder(data, rows_against, name), data, rows)
        counts["rewritten"] += 1
    elif more == 1:
        counts["refused"] += check_chosen(rng, "map", data[:9 if against is None else 11], np.uint16, MapInfo,
                                          lambda bytes_: reference.MapDecoder(bytes_, rows_against, name), against)
        counts["chosen"] += 1
    # Not the bytes of the shape: a larger map takes long.
    counts["refused"] += check_damaged(rng, "map", data, np.uint16, MapInfo,
                                       lambda bytes_: reference.decode_map(bytes_, rows_against, name),
                                       9 if against is None else 11, (0, 1, 2, 7, 8, 9, 10), against)
    counts["damaged"] += 1


def check_gray(rng, pixels, near, counts):
    height, width = pixels.shape
    data = encode("gray", GrayInfo(width, height, near), pixels)
    header, rows = reference.decode_gray(data)
    error = np.abs(np.array(rows, int) - pixels).max()
    assert error <= (4 if near == 8 else near) and header.near == near, (width, height, near, error)
    status, decoded = decode("gray", data, np.uint8, GrayInfo())
    assert status == OK and decoded == rows
    counts["gray"] += 1
    if width * height < SLOW_PIXELS:
        check_rewritten(reference.GrayDecoder(data), data, rows)
        counts["rewritten"] += 1
        check_chosen(rng, "gray", data[:6], np.uint8, GrayInfo, reference.GrayDecoder)
        counts["chosen"] += 1
    counts["refused"] += check_damaged(rng, "gray", data, np.uint8, GrayInfo, reference.decode_gray, 6)
    counts["damaged"] += 1


def check_gray_headers():
    for first in range(256):
        for second in (0, 7, 8, 9, 15, 16, 25):
            for size in (b"", b"\1\0\1", b"\1\0\1\0", b"\0\0\1\0", b"\1\0\0\0", b"\x81\2\1\0", b"\1\0\xe1\1"):
                check_bytes("gray", bytes((first, second)) + size, np.uint8, GrayInfo(), None, reference.decode_gray)


def check_damaged(rng, kind, data, dtype, make_info, decode_reference, header_len, header_bytes=(0,), against=None):
    damaged = bytearray(data)
    for _ in range(int(rng.integers(1, 4))):
        in_header = len(damaged) == header_len or rng.random() < 0.1
        at = int(rng.choice(header_bytes) if in_header else rng.integers(header_len, len(damaged)))
        damaged[min(at, len(damaged) - 1)] ^= int(rng.integers(1, 256))
    damaged = bytes(damaged[:int(rng.integers(0, len(damaged) + 1))]) if rng.random() < 0.3 else bytes(damaged)
    return check_bytes(kind, damaged, dtype, make_info(), against, decode_reference)


def check_bytes(kind, data, dtype, info, against, decode_reference):
    """Whether both refuse the bytes; that they say the same."""
    status, rows = decode(kind, data, dtype, info, against)
    try:
        _, expected = decode_reference(data)
        expected_status = OK
    except reference.FormatError as error:
        expected, expected_status = list(error.rows), ERR_FORMAT
    except reference.VersionError:
        expected, expected_status = [], ERR_VERSION
    except reference.NoReferenceError:
        expected, expected_status = [], ERR_REFERENCE
    assert status == expected_status, (kind, status, expected_status)
    assert rows == expected, kind
    return status != OK


def main():
    seed = int(os.environ.get("SEED", "1"))
    print(f"replay: SEED={seed} python3 tests/vectors/test_codec_decoder.py")
    rng = np.random.default_rng(seed)
    counts = dict.fromkeys(("map", "gray", "real gray", "rewritten", "chosen", "damaged", "refused"), 0)
    sizes = [(1, 1), (1, 9), (2, 3), (3, 2), (5, 7), (17, 11), (64, 24)]
    variants = [(near, reference_kind) for near in (0, 1) for reference_kind in REFERENCES]
    for step_log2 in range(5):
        for kind in ("noise", "slope", "blocks", "zero", "empty"):
            maps = [(size, variant) for size in sizes[:-1] for variant in variants]
            maps += [(size, variants[int(rng.integers(len(variants)))])
                     for size in 4 * sizes[-1:] + ([(160, 120)] if step_log2 in (0, 2) else [])]
            if kind == "noise":  # literal, also in rows that end within 16 pixels
                maps += [((75, 30), variants[int(rng.integers(len(variants)))]) for _ in range(2)]
            for (width, height), (near, reference_kind) in maps:
                disparities = int(rng.choice([1, 2, 16, 31, 48, 64, 128]))
                info = MapInfo(width, height, disparities, step_log2, near, int(rng.integers(-32768, 32768)))
                check_map(rng, kind, reference_kind, info, counts)
    for near in range(9):
        for kind in vector_pictures.KINDS:
            for width, height in sizes + ([(160, 120)] if near in (0, 2, 8) else []):
                check_gray(rng, vector_pictures.synthetic(rng, kind, width, height), near, counts)
    for _, left, _ in vector_pictures.pairs(157, 117, 2):
        for near in (0, 1, 4, 8):
            check_gray(rng, left, near, counts)
            counts["real gray"] += 1
    check_gray_headers()
    print(", ".join(f"{value} {name}" for name, value in counts.items()))


if __name__ == "__main__":
    main()
