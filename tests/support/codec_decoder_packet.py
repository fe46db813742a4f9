"""Decoder of disparity maps in packets, written from docs/codec.md, chapter 2a, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import INVALID, FormatError, MapDecoder, NoReferenceError, RangeDecoder, VersionError

STRIP_WIDTH = 32


class Strip:
    """Labels of a strip as a packet knows them: said by its pixels, else `rest`."""

    def __init__(self, rest):
        self.said = {}
        self.rest = rest

    def get(self, place, _=None):
        return self.said.get(place, self.rest)


class PacketDecoder(MapDecoder):
    """Of one packet; of `info` width, height, disparities, step_log2 and near are looked at."""

    mode = 0

    def __init__(self, info, map_id, data):
        if len(data) < 4:
            raise FormatError
        header = int.from_bytes(data[:4], "little")
        if header >> 30 != 1:
            raise VersionError
        self.width, self.height, self.disparities = info.width, info.height, info.disparities
        self.step_log2, self.near = info.step_log2, info.near
        self.is_literal = header >> 26 & 1
        self.first = 8 * (header & 0x1FFFF)
        self.count = 8 * ((header >> 17 & 0x1FF) + 1)
        total = self.width * self.height
        if self.first >= total or self.first + self.count >= total + 8:
            raise FormatError
        if header >> 27 & 7 != map_id:
            raise NoReferenceError
        self.count = min(self.count, total - self.first)
        self.coder = RangeDecoder(data[4:], shift=5)
        self._begin()

    def places(self):
        """(x, y, column within the strip, width of the strip) of the packet's pixels."""
        for number in range(self.first, self.first + self.count):
            strip = number // (STRIP_WIDTH * self.height)
            width = min(STRIP_WIDTH, self.width - STRIP_WIDTH * strip)
            y, column = divmod(number - STRIP_WIDTH * self.height * strip, width)
            yield STRIP_WIDTH * strip + column, y, column, width

    def decode(self):
        """[(x, y, disparity)]; a FormatError has those before in `rows`."""
        found = []
        self.map = Strip(self.none)
        run = 0
        for x, y, column, width in self.places():
            said = self.map.said
            if found and column == 0:
                if y == 0:
                    self.map = Strip(self.last)
                    said = self.map.said
                for border in (-3, -2, -1):
                    said[border, y] = self.map.get((0, y - 1))
            if column == 0:
                run = 0
            try:
                label = self.literal() if self.is_literal else self.pixel(column, y, run)
            except FormatError:
                raise FormatError(found) from None
            run = run + 1 if label == self.map.get((column - 1, y)) else 0
            said[column, y] = label
            if not found:
                self.map.rest = label
            if column == width - 1:
                said[width, y] = said[width + 1, y] = label
            self.last = label if label != self.none else self.last
            found.append((x, y, INVALID if label == self.none else label << self.step_log2))
        return found


def decode_packet(info, map_id, data):
    """(decoder with the header's fields, [(x, y, UQ12.4 disparity)])"""
    decoder = PacketDecoder(info, map_id, data)
    return decoder, decoder.decode()
