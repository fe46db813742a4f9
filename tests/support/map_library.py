"""The codec of disparity maps as Python calls: bytes of a map, the map of bytes, and restoring, of the build in TSR_BUILD.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes

import numpy as np
from vision_library import ANY, I16, LIB, OK, SIZE, U8, U16, pointer

STATE_LEN = 16384  # more than a coder of maps


class MapInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("disparities", U16), ("step_log2", U8), ("near", U8), ("d0_q4", I16),
                ("has_reference", ctypes.c_bool), ("reference_id", U16)]


LIB.tsr_map_encoded_len_max.restype = SIZE
LIB.tsr_quantise.argtypes = [ANY, SIZE, U8, U16]
LIB.tsr_map_encode_start.argtypes = [ANY, ANY, ANY, SIZE, ANY, SIZE]
LIB.tsr_map_encode_rows.argtypes = LIB.tsr_map_decode_rows.argtypes = [ANY, ANY, SIZE, U16]
LIB.tsr_map_decode_start.argtypes = [ANY, ANY, SIZE, ANY, ANY, SIZE, ANY]
LIB.tsr_map_restore.argtypes = [ANY, ANY, SIZE, ANY, SIZE]


def info_of(disparity_map, disparities, step_log2, near=0):
    height, width = disparity_map.shape
    return MapInfo(width, height, disparities, step_log2, near)


def quantise(disparity_map, disparities, step_log2):
    """A quantised copy."""
    quantised = disparity_map.copy()
    assert LIB.tsr_quantise(pointer(quantised), quantised.size, step_log2, disparities) == OK
    return quantised


def encode(quantised, info):
    """The bytes of a map coded alone."""
    out = np.zeros(LIB.tsr_map_encoded_len_max(ctypes.byref(info)), np.uint8)
    state, scratch, length = np.zeros(STATE_LEN, np.uint8), np.zeros(3 * (info.width + 5), np.uint16), SIZE()
    assert LIB.tsr_map_encode_start(pointer(state), ctypes.byref(info), pointer(out), out.size, pointer(scratch),
                                    scratch.size) == OK
    assert LIB.tsr_map_encode_rows(pointer(state), pointer(quantised), info.width, info.height) == OK
    assert LIB.tsr_map_encode_finish(pointer(state), ctypes.byref(length)) == OK
    return out[:length.value].tobytes()


def decode(data):
    """(map, its MapInfo) of the bytes of a map coded alone."""
    data, info = np.frombuffer(data, np.uint8), MapInfo()
    state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(3 * (640 + 5), np.uint16)
    assert LIB.tsr_map_decode_start(pointer(state), pointer(data), data.size, None, pointer(scratch), scratch.size,
                                    ctypes.byref(info)) == OK
    decoded = np.zeros((info.height, info.width), np.uint16)
    assert LIB.tsr_map_decode_rows(pointer(state), pointer(decoded), info.width, info.height) == OK
    return decoded, info


def restore(decoded, info, noise=None):
    """A restored copy. With noise (a random generator) the scratch is not zero."""
    restored = np.ascontiguousarray(decoded).copy()
    scratch = np.zeros(2 * info.width * (info.height + 1), np.uint16)
    if noise is not None:
        scratch[:] = noise.integers(0, 65536, scratch.size)
    status = LIB.tsr_map_restore(ctypes.byref(info), pointer(restored), restored.size, pointer(scratch), scratch.size)
    assert status == OK, status
    return restored
