"""Gray images against held ones as Python calls, of the shared library of the build in TSR_BUILD.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes

import numpy as np
from view_library import TILE, ViewChange
from vision_library import ANY, LIB, OK, SIZE, U8, U16, pointer

STATE_LEN = 4096  # more than a coder


class Info(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("near", U8), ("against_held", ctypes.c_bool)]


class HeldStruct(ctypes.Structure):
    _fields_ = [("pixels", ANY), ("pixels_cap", SIZE), ("width", U16), ("height", U16), ("check", U16),
                ("full", ctypes.c_bool)]


START, ROWS = [ANY, ANY, ANY, ANY, ANY, SIZE, ANY, SIZE], [ANY, ANY, SIZE, U16]
LIB.tsr_gray_history_encoded_len_max.restype = SIZE
LIB.tsr_gray_history_encode_start.argtypes = START
LIB.tsr_gray_history_encode_rows.argtypes = LIB.tsr_gray_history_decode_rows.argtypes = ROWS
LIB.tsr_gray_history_decode_start.argtypes = [ANY, ANY, SIZE, ANY, ANY, SIZE, ANY]
LIB.tsr_gray_history_compare.argtypes = [ANY, ANY, SIZE, U16, U16, ANY]


class Held:
    """A held image and its memory."""

    def __init__(self, width, height):
        self.pixels = np.zeros((height, width), np.uint8)
        self.struct = HeldStruct(pointer(self.pixels), self.pixels.size)

    @property
    def at(self):
        return ctypes.byref(self.struct)


def choose_tiles(image, held):
    """Which tiles have changed; the threshold is found."""
    height, width = image.shape
    tiles = np.zeros(-(-width // TILE) * -(-height // TILE), np.uint8)
    change = ViewChange(pointer(tiles), tiles.size)
    assert LIB.tsr_gray_history_compare(held.at, pointer(image), width, 0, height, ctypes.byref(change)) == OK
    LIB.tsr_view_choose(ctypes.byref(change), tiles.size, 0)
    return tiles


def encode(image, near, held, tiles=None):
    """The bytes of an image, against what is held if tiles are given."""
    height, width = image.shape
    info = Info(width, height, near, tiles is not None)
    out = np.zeros(LIB.tsr_gray_history_encoded_len_max(ctypes.byref(info)), np.uint8)
    state, scratch, length = np.zeros(STATE_LEN, np.uint8), np.zeros(4 * width + 8, np.uint8), SIZE()
    assert LIB.tsr_gray_history_encode_start(pointer(state), ctypes.byref(info), held.at,
                                             pointer(tiles) if tiles is not None else None, pointer(out), out.size,
                                             pointer(scratch), scratch.size) == OK
    assert LIB.tsr_gray_history_encode_rows(pointer(state), pointer(image), width, height) == OK
    assert LIB.tsr_gray_history_encode_finish(pointer(state), ctypes.byref(length)) == OK
    return out[:length.value].tobytes()


def try_decode(data, held):
    """The image of these bytes; a status instead if they are refused."""
    state, scratch, info = np.zeros(STATE_LEN, np.uint8), np.zeros(8192, np.uint8), Info()
    status = LIB.tsr_gray_history_decode_start(pointer(state), data, len(data), held.at, pointer(scratch), scratch.size,
                                               ctypes.byref(info))
    if status != OK:
        return status
    image = np.zeros((info.height, info.width), np.uint8)
    assert LIB.tsr_gray_history_decode_rows(pointer(state), pointer(image), info.width, info.height) == OK
    return image


def decode(data, held):
    image = try_decode(data, held)
    assert not isinstance(image, int), image
    return image
