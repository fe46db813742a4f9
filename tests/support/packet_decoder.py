"""A decoder of maps in packets and of files of them, written from docs/codec.md, chapters 2a and 2b, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import INVALID, FormatError, MapDecoder, RangeDecoder, VersionError, shaped

STRIP_WIDTH = 32


class PacketRange(RangeDecoder):
    """2a.2: contexts learn faster."""

    RATE = 5


class Strip(dict):
    """Labels by place in the strip, and what stands for those that no pixel of the packet has said."""

    def __init__(self, unknown):
        super().__init__()
        self.unknown = unknown

    def get(self, place, _none=None):
        return super().get(place, self.unknown)


class File:
    """2b: the header's fields, and the packets that are intact."""

    def __init__(self, data):
        if len(data) < 17 or data[:4] != b"PTDM" or crc16(data[:15]) != int.from_bytes(data[15:17], "little"):
            raise FormatError
        if data[4] != 1:
            raise VersionError
        self.step_log2, self.near, self.map_id = data[5] & 7, data[5] >> 3 & 1, data[5] >> 4 & 7
        self.disparities = data[6] + 1
        self.width, self.height = int.from_bytes(data[7:9], "little"), int.from_bytes(data[9:11], "little")
        self.d0_q4 = int.from_bytes(data[11:13], "little", signed=True)
        self.count = int.from_bytes(data[13:15], "little")
        self.packets, self.damaged, at = [], 0, 17
        while at < len(data):
            end = at + 4 + int.from_bytes(data[at:at + 2], "little")
            if 4 <= end - at - 4 <= 1280 and end <= len(data) and crc16(
                    data[at:at + 2] + data[at + 4:end]) == int.from_bytes(data[at + 2:at + 4], "little"):
                self.packets.append(data[at + 4:end])
                at = end
            else:
                self.damaged += 1
                at += 1


class PacketDecoder(MapDecoder):
    """2a; shape is a File, or anything with its fields."""

    def __init__(self, data, shape):
        word = int.from_bytes(data[:4], "little")
        if word >> 30 != 1:
            raise VersionError
        if word >> 27 & 7 != shape.map_id:
            raise FormatError
        self.literal_packet = word >> 26 & 1
        self.first, pixels = 8 * (word & 0x1FFFF), shape.width * shape.height
        self.count = 8 * ((word >> 17 & 0x1FF) + 1)
        if self.first >= pixels or self.first + self.count >= pixels + 8:
            raise FormatError
        self.count = min(self.count, pixels - self.first)
        self.mode, self.step_log2, self.shape = 0, shape.step_log2, shape
        self.coder = PacketRange(data[4:])
        self.labels = (16 * shape.disparities) >> shape.step_log2
        self.label_bits = self.labels.bit_length()
        self.none, self.last = self.label_of(INVALID), self.labels // 4
        cells = iter(self.CELLS[shape.near])
        self.flat, self.candidate, self.invalid = shaped(cells, 48), shaped(cells, 6, 32), shaped(cells, 16, 6)
        self.predicted, self.sign = shaped(cells, 6, 6), shaped(cells, 27)
        self.nearer, self.farther, self.half = shaped(cells, 4, 12), shaped(cells, 9), shaped(cells, 10)

    def places(self):
        """Pixels of the packet as (strip's left column, its width, x in it, y)."""
        strip, within = divmod(self.first, STRIP_WIDTH * self.shape.height)
        left = strip * STRIP_WIDTH
        for _ in range(self.count):
            wide = min(STRIP_WIDTH, self.shape.width - left)
            yield left, wide, within % wide, within // wide
            within += 1
            if within == wide * self.shape.height:
                left, within = left + STRIP_WIDTH, 0

    def decode(self):
        """{(x, y): UQ12.4 disparity}"""
        values, self.map, run = {}, Strip(self.none), 0
        for i, (left, wide, x, y) in enumerate(self.places()):
            if i > 0 and x == 0:
                run = 0
                if y == 0:
                    self.map = Strip(self.last)
                for k in (1, 2, 3):
                    self.map[-k, y] = self.map.get((0, y - 1))
            label = self.literal() if self.literal_packet else self.pixel(x, y, run)
            run = run + 1 if label == self.map.get((x - 1, y)) else 0
            self.map[x, y] = label
            self.last = label if label != self.none else self.last
            if i == 0:
                self.map.unknown = label
            if x == wide - 1:
                self.map[wide, y] = self.map[wide + 1, y] = label
            values[left + x, y] = INVALID if label == self.none else label << self.step_log2
        return values


def crc16(data, crc=0xFFFF):
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc


def record(packet):
    """A packet as it stands in a file."""
    length = len(packet).to_bytes(2, "little")
    return length + crc16(length + packet).to_bytes(2, "little") + packet
