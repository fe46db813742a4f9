"""What a wing sends, as Python calls: prefilter, view and gray codec of the shared library of the build in TSR_BUILD.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes

import numpy as np
from vision_library import AGAIN, ANY, LIB, OK, SIZE, U8, U16, U32, Gray, pointer, view

STATE_LEN = 4096  # more than a coder of views
TILE = 8


class ViewInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("cap", U8), ("coarse", ctypes.c_bool), ("against_held", ctypes.c_bool)]


class ViewHeld(ctypes.Structure):
    _fields_ = [("packed", ANY), ("packed_cap", SIZE), ("info", ViewInfo), ("check", U16), ("full", ctypes.c_bool)]


class ViewModel(ctypes.Structure):
    """How a coder's state begins, for what no bytes bring about."""
    _fields_ = [("info", ViewInfo), ("held", ANY), ("scratch", ANY), ("level_of", ANY), ("value_of", ANY), ("row", U16),
                ("check", U16), ("level_max", U8), ("allowed_bits", U32)]


LIB.tsr_prefilter_start.argtypes = [ANY, Gray, U8, ANY, SIZE]
LIB.tsr_prefilter_run.argtypes = [ANY, U16]
LIB.tsr_view_encoded_len_max.restype = SIZE
LIB.tsr_view_compare.argtypes = [ANY, ANY, SIZE, U16, U16, ANY]
LIB.tsr_view_choose.argtypes = [ANY, SIZE, U8]
LIB.tsr_view_choose.restype = SIZE
LIB.tsr_view_encode_start.argtypes = [ANY, ANY, ANY, ANY, ANY, SIZE, ANY, SIZE]
LIB.tsr_view_encode_rows.argtypes = LIB.tsr_view_decode_rows.argtypes = [ANY, ANY, SIZE, U16]
LIB.tsr_view_decode_start.argtypes = [ANY, ANY, SIZE, ANY, ANY, SIZE, ANY]


class GrayInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("near", U8)]


LIB.tsr_gray_encode_start.argtypes = [ANY, ANY, ANY, SIZE, ANY, SIZE]
LIB.tsr_gray_encode_rows.argtypes = LIB.tsr_gray_decode_rows.argtypes = [ANY, ANY, SIZE, U16]
LIB.tsr_gray_decode_start.argtypes = [ANY, ANY, SIZE, ANY, SIZE, ANY]


class ViewChange(ctypes.Structure):
    _fields_ = [("tiles", ANY), ("tiles_cap", SIZE), ("stronger", U16), ("weaker", U16)]


class Held:
    """A held view and its memory."""

    def __init__(self, width, height):
        self.packed = np.zeros(((width + 1) // 2) * height, np.uint8)
        self.struct = ViewHeld(pointer(self.packed), self.packed.size)

    @property
    def at(self):
        return ctypes.byref(self.struct)


def prefilter(picture, cap=7):
    """A filtered copy."""
    filtered = picture.copy()
    scratch, state = np.zeros(4 * picture.shape[1] + 4, np.uint8), np.zeros(STATE_LEN, np.uint8)
    assert LIB.tsr_prefilter_start(pointer(state), view(filtered), cap, pointer(scratch), scratch.size) == OK
    assert LIB.tsr_prefilter_run(pointer(state), 65535) == OK
    return filtered


def choose_tiles(filtered, held, threshold=0):
    height, width = filtered.shape
    tiles = np.zeros(-(-width // TILE) * -(-height // TILE), np.uint8)
    change = ViewChange(pointer(tiles), tiles.size)
    assert LIB.tsr_view_compare(held.at, pointer(filtered), width, 0, height, ctypes.byref(change)) == OK
    LIB.tsr_view_choose(ctypes.byref(change), tiles.size, threshold)
    return tiles


def encode(filtered, cap=7, coarse=True, held=None, tiles=None):
    """The bytes of a view, against what is held if tiles are given."""
    height, width = filtered.shape
    info = ViewInfo(width, height, cap, coarse, tiles is not None)
    out = np.zeros(LIB.tsr_view_encoded_len_max(ctypes.byref(info)), np.uint8)
    state, scratch, length = np.zeros(STATE_LEN, np.uint8), np.zeros(5 * width + 16, np.uint8), SIZE()
    assert LIB.tsr_view_encode_start(pointer(state), ctypes.byref(info), held.at if held else None,
                                     pointer(tiles) if tiles is not None else None, pointer(out), out.size,
                                     pointer(scratch), scratch.size) == OK
    assert LIB.tsr_view_encode_rows(pointer(state), pointer(filtered), width, height) == OK
    assert LIB.tsr_view_encode_finish(pointer(state), ctypes.byref(length)) == OK
    return out[:length.value].tobytes()


def decode(data, held=None, after_row=None):
    """The view of these bytes; a status instead if it is refused. after_row(y, ViewModel) may change the decoder."""
    state, scratch, info = np.zeros(STATE_LEN, np.uint8), np.zeros(8192, np.uint8), ViewInfo()
    status = LIB.tsr_view_decode_start(pointer(state), data, len(data), held.at if held else None, pointer(scratch),
                                       scratch.size, ctypes.byref(info))
    if status != OK:
        return status
    filtered = np.zeros((info.height, info.width), np.uint8)
    if after_row is None:
        assert LIB.tsr_view_decode_rows(pointer(state), pointer(filtered), info.width, info.height) == OK
        return filtered
    for y in range(info.height):
        status = LIB.tsr_view_decode_rows(pointer(state), pointer(filtered[y]), info.width, 1)
        assert status == (AGAIN if y + 1 < info.height else OK), status
        after_row(y, ViewModel.from_buffer(state))
    return filtered


def code_gray(picture, near):
    """Bytes of a gray view, and the view as it is decoded."""
    height, width = picture.shape
    info, length, picture = GrayInfo(width, height, near), SIZE(), np.ascontiguousarray(picture)
    out, decoded = np.zeros(picture.size + 512, np.uint8), np.zeros_like(picture)
    state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(3 * width, np.uint8)
    assert LIB.tsr_gray_encode_start(pointer(state), ctypes.byref(info), pointer(out), out.size, pointer(scratch),
                                     scratch.size) == OK
    assert LIB.tsr_gray_encode_rows(pointer(state), pointer(picture), width, height) == OK
    assert LIB.tsr_gray_encode_finish(pointer(state), ctypes.byref(length)) == OK
    assert LIB.tsr_gray_decode_start(pointer(state), pointer(out), length.value, pointer(scratch), scratch.size,
                                     ctypes.byref(info)) == OK
    assert LIB.tsr_gray_decode_rows(pointer(state), pointer(decoded), width, height) == OK
    return length.value, decoded
