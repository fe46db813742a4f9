"""The map codec as Python calls: whole maps, packets, and a library of its own for another prior.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import subprocess

import numpy as np

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
OK, AGAIN = 0, 1
MISSING = 65534
STATE_LEN = 16384  # more than any coder's state
PACKET_SCRATCH_COUNT = 3 * (40 + 5)
U8, U16, I16, SIZE, ANY = ctypes.c_uint8, ctypes.c_uint16, ctypes.c_int16, ctypes.c_size_t, ctypes.c_void_p


class Info(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("disparities", U16), ("step_log2", U8), ("near", U8), ("d0_q4", I16),
                ("has_reference", ctypes.c_bool), ("reference_id", U16)]


class Reference(ctypes.Structure):
    _fields_ = [("map", ANY), ("stride", SIZE), ("id", U16)]


def pointer(array):
    return array.ctypes.data_as(ANY)


def build(prior_source, library):
    """The codec with this map_prior.c in the place of the shipped one, as a shared library."""
    sources = [path for layer in ("codec", "base") for path in sorted((SOURCE / "firmware" / layer).glob("*.c"))
               if path.name != "map_prior.c"]
    includes = [SOURCE / "firmware/codec", *(SOURCE / "firmware" / layer / "include" for layer in ("codec", "base"))]
    subprocess.run(["cc", "-std=c11", "-O2", "-shared", "-fPIC", *[f"-I{path}" for path in includes], *sources,
                    prior_source, "-o", library], check=True)
    return Codec(library)


class Codec:
    """Of a shared library, given by its path or as loaded."""

    def __init__(self, library):
        self.lib = library if isinstance(library, ctypes.CDLL) else ctypes.CDLL(str(library))
        self.lib.tsr_map_encoded_len_max.restype = SIZE

    def encode(self, disparity_map, disparities, step_log2, near=0, reference=None):
        """Bytes of a map [height, width], quantised."""
        height, width = disparity_map.shape
        info = Info(width, height, disparities, step_log2, near)
        state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(3 * (width + 5), np.uint16)
        out = np.zeros(self.lib.tsr_map_encoded_len_max(ctypes.byref(info)), np.uint8)
        buffers = pointer(out), SIZE(out.size), pointer(scratch), SIZE(scratch.size)
        if reference is None:
            status = self.lib.tsr_map_encode_start(pointer(state), ctypes.byref(info), *buffers)
        else:
            against = Reference(reference.ctypes.data, width, 1)
            status = self.lib.tsr_map_encode_start_against(pointer(state), ctypes.byref(info), ctypes.byref(against),
                                                           *buffers)
        assert status == OK, status
        rows = np.ascontiguousarray(disparity_map)
        length = SIZE(0)
        assert self.lib.tsr_map_encode_rows(pointer(state), pointer(rows), SIZE(width), U16(height)) == OK
        assert self.lib.tsr_map_encode_finish(pointer(state), ctypes.byref(length)) == OK
        return out[:length.value]

    def decode(self, data, shape, reference=None):
        height, width = shape
        info, against = Info(), None
        if reference is not None:
            against = ctypes.byref(Reference(reference.ctypes.data, width, 1))
        state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(3 * (width + 5), np.uint16)
        result = np.zeros(shape, np.uint16)
        assert self.lib.tsr_map_decode_start(pointer(state), pointer(data), SIZE(data.size), against, pointer(scratch),
                                             SIZE(scratch.size), ctypes.byref(info)) == OK
        assert self.lib.tsr_map_decode_rows(pointer(state), pointer(result), SIZE(width), U16(height)) == OK
        return result

    def packets(self, disparity_map, disparities, step_log2, cap):
        """A list of packets of at most cap bytes."""
        height, width = disparity_map.shape
        info = Info(width, height, disparities, step_log2)
        rows = np.ascontiguousarray(disparity_map)
        state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(PACKET_SCRATCH_COUNT, np.uint16)
        assert self.lib.tsr_map_packets_start(pointer(state), ctypes.byref(info), pointer(rows), SIZE(width), U8(0),
                                              pointer(scratch), SIZE(scratch.size)) == OK
        result, status = [], AGAIN
        while status == AGAIN:
            out, length = np.zeros(cap, np.uint8), SIZE(0)
            status = self.lib.tsr_map_packets_next(pointer(state), pointer(out), SIZE(cap), ctypes.byref(length))
            assert status in (OK, AGAIN), status
            result.append(out[:length.value])
        return result

    def decode_packets(self, packets, shape, disparities, step_log2):
        """The map, MISSING where no packet of the list has a pixel."""
        height, width = shape
        info = Info(width, height, disparities, step_log2)
        result, told = np.zeros(shape, np.uint16), np.zeros(16, np.uint8)
        state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(PACKET_SCRATCH_COUNT, np.uint16)
        assert self.lib.tsr_map_packets_clear(ctypes.byref(info), pointer(result), SIZE(width)) == OK
        for packet in packets:
            assert self.lib.tsr_map_packet_decode(pointer(state), ctypes.byref(info), U8(0), pointer(packet),
                                                  SIZE(packet.size), pointer(scratch), SIZE(scratch.size), pointer(told),
                                                  pointer(result), SIZE(width)) == OK
        return result
