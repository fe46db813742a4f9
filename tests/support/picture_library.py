"""The picture codec of the shared library of the build in TSR_BUILD, as Python calls.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes

import numpy as np
from vision_library import ANY, LIB, OK, SIZE, U8, U16, U32, pointer

STATE_LEN = 4096  # more than a coder of pictures
BLOCK = 8
PRIOR_NONE, PRIOR_TRAINED = 0, 1


class PictureInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("step", U8), ("prior", U8)]


LIB.tsr_picture_encoded_len_max.restype = SIZE
LIB.tsr_picture_encode_start.argtypes = [ANY, ANY, U32, ANY, SIZE, ANY, SIZE]
LIB.tsr_picture_encode_rows.argtypes = LIB.tsr_picture_decode_rows.argtypes = [ANY, ANY, SIZE, U16]
LIB.tsr_picture_decode_start.argtypes = [ANY, ANY, SIZE, ANY, SIZE, ANY]


def encode(picture, step, prior=PRIOR_TRAINED, target_len=0):
    """The bytes of a picture."""
    height, width = picture.shape
    info, length, picture = PictureInfo(width, height, step, prior), SIZE(), np.ascontiguousarray(picture)
    out = np.zeros(LIB.tsr_picture_encoded_len_max(ctypes.byref(info)), np.uint8)
    state, scratch = np.zeros(STATE_LEN, np.uint8), np.zeros(11 * (width + BLOCK), np.uint8)
    assert LIB.tsr_picture_encode_start(pointer(state), ctypes.byref(info), target_len, pointer(out), out.size,
                                        pointer(scratch), scratch.size) == OK
    assert LIB.tsr_picture_encode_rows(pointer(state), pointer(picture), width, height) == OK
    assert LIB.tsr_picture_encode_finish(pointer(state), ctypes.byref(length)) == OK
    return out[:length.value].tobytes()


def decode(data):
    """The picture of these bytes; a status instead if they are refused."""
    info, state, scratch = PictureInfo(), np.zeros(STATE_LEN, np.uint8), np.zeros(11 * (640 + BLOCK), np.uint8)
    status = LIB.tsr_picture_decode_start(pointer(state), data, len(data), pointer(scratch), scratch.size,
                                          ctypes.byref(info))
    if status != OK:
        return status
    decoded = np.zeros((info.height, info.width), np.uint8)
    assert LIB.tsr_picture_decode_rows(pointer(state), pointer(decoded), info.width, info.height) == OK
    return decoded
