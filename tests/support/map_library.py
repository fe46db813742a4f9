"""What happens to a map around its coding, as Python calls of the build in TSR_BUILD: quantising, the codec, restoring.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes

import codec_library
import numpy as np
from vision_library import ANY, LIB, OK, SIZE, U8, U16, pointer

LIB.tsr_quantise.argtypes = [ANY, SIZE, U8, U16]
LIB.tsr_map_restore.argtypes = [ANY, ANY, SIZE, ANY, SIZE]
LIB.tsr_map_hold.argtypes = [ANY, ANY, ANY, SIZE, ANY, SIZE, ANY]
CODEC = codec_library.Codec(LIB)


def info_of(disparity_map, disparities, step_log2, near=0):
    height, width = disparity_map.shape
    return codec_library.Info(width, height, disparities, step_log2, near)


def quantise(disparity_map, disparities, step_log2):
    """A quantised copy."""
    quantised = disparity_map.copy()
    assert LIB.tsr_quantise(pointer(quantised), quantised.size, step_log2, disparities) == OK
    return quantised


def restore(decoded, info, noise=None):
    """A restored copy. With noise (a random generator) the scratch is not zero."""
    restored = np.ascontiguousarray(decoded).copy()
    scratch = np.zeros(2 * info.width * (info.height + 1), np.uint16)
    if noise is not None:
        scratch[:] = noise.integers(0, 65536, scratch.size)
    status = LIB.tsr_map_restore(ctypes.byref(info), pointer(restored), restored.size, pointer(scratch), scratch.size)
    assert status == OK, status
    return restored


def hold(disparity_map, earlier):
    """A copy held to an earlier map of the same shape and step, and how many of its pixels differ from that still."""
    held, earlier = np.ascontiguousarray(disparity_map).copy(), np.ascontiguousarray(earlier)
    height, width = held.shape
    info, reference = codec_library.Info(width, height), codec_library.Reference(earlier.ctypes.data, width, 0)
    scratch, changed = np.zeros(width, np.uint16), ctypes.c_uint32()
    status = LIB.tsr_map_hold(ctypes.byref(info), ctypes.byref(reference), pointer(held), width, pointer(scratch), width,
                              ctypes.byref(changed))
    assert status == OK, status
    return held, changed.value
