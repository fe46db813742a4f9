"""Packets of gray images, views and pictures as Python calls, of any library that has the codec.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes

import numpy as np

OK, AGAIN = 0, 1
STATE_LEN = 8192  # more than any encoder of packets
U8, U16, SIZE, ANY = ctypes.c_uint8, ctypes.c_uint16, ctypes.c_size_t, ctypes.c_void_p


class GrayInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("near", U8)]


class ViewInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("cap", U8), ("coarse", ctypes.c_bool), ("against_held", ctypes.c_bool)]


class PictureInfo(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("step", U8), ("prior", U8)]


class Packet(ctypes.Structure):
    _fields_ = [("id", U8), ("coarser", U8), ("is_literal", ctypes.c_bool), ("first", ctypes.c_uint32),
                ("count", ctypes.c_uint32)]


INFOS = {"gray": GrayInfo, "view": ViewInfo, "picture": PictureInfo}


def pointer(array):
    return array.ctypes.data_as(ANY)


class Sender:
    """Encoder of one image; `how` are the fields of its info after width and height."""

    def __init__(self, library, name, image, how, image_id=0):
        self.library, self.name, self.more = library, name, True
        self.image = np.ascontiguousarray(image)
        height, width = image.shape
        self.info = INFOS[name](width, height, *how)
        self.state = np.zeros(STATE_LEN, np.uint8)
        status = getattr(library, f"tsr_{name}_packets_start")(
            pointer(self.state), ctypes.byref(self.info), pointer(self.image), SIZE(width), U8(image_id))
        assert status == OK, status

    def next(self, cap):
        out, length = np.zeros(cap, np.uint8), SIZE()
        status = getattr(self.library, f"tsr_{self.name}_packets_next")(pointer(self.state), pointer(out), SIZE(cap),
                                                                         ctypes.byref(length))
        assert status in (OK, AGAIN), status
        self.more = status == AGAIN
        return out[:length.value].tobytes()

    def all(self, cap):
        packets = []
        while self.more:
            packets.append(self.next(cap))
        return packets


class Receiver:
    """Decodes packets of one image, in any order."""

    def __init__(self, library, name, width, height, how, image_id=0):
        self.library, self.name, self.image_id = library, name, image_id
        self.info = INFOS[name](width, height, *how)
        self.image = np.zeros((height, width), np.uint8)
        blocks = -(-width // 8) * -(-height // 8)
        self.arrived = np.zeros(blocks if name == "picture" else (width * height + 63) // 64, np.uint8)
        self.state = np.zeros(STATE_LEN, np.uint8)

    def take(self, packet):
        """(status, what the packet says)"""
        told = Packet()
        status = getattr(self.library, f"tsr_{self.name}_packet_decode")(
            pointer(self.state), ctypes.byref(self.info), U8(self.image_id), packet, SIZE(len(packet)), ctypes.byref(told),
            pointer(self.image), SIZE(self.image.shape[1]), pointer(self.arrived), SIZE(self.arrived.size))
        return status, told

    def missing(self):
        """Pixels, or blocks of a picture."""
        if self.name == "picture":
            call, words = self.library.tsr_picture_packets_missing, (ctypes.byref(self.info), pointer(self.arrived))
        else:
            height, width = self.image.shape
            call, words = self.library.tsr_packets_missing, (pointer(self.arrived), U16(width), U16(height))
        call.restype = SIZE
        return call(*words)

    def result(self):
        """The image as it is handed out."""
        if self.name != "picture":
            return self.image
        out = np.zeros_like(self.image)
        width = SIZE(out.shape[1])
        assert self.library.tsr_picture_packets_smooth(ctypes.byref(self.info), pointer(self.image), width,
                                                       pointer(self.arrived), pointer(out), width) == OK
        return out
