"""Decoders of packets of images, written from docs/codec.md, chapters 3a to 5a, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
import re

import codec_decoder
from codec_decoder import FormatError, NoReferenceError, RangeDecoder, VersionError, klass, median, shaped

GROUP = 8
STRIP = 16
COUNTS = (0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 33, 40, 48, 54, 60)


def read_packet_prior(name, tables, count):
    """The tables of firmware/codec/<name>_packet_prior.c, each a list of contexts as 1.2 reads them."""
    text = (codec_decoder.SOURCE / f"firmware/codec/{name}_packet_prior.c").read_text("ascii")
    numbers = [int(number, 16) for number in re.findall(r"0x[0-9a-f]{4}", text)]
    if len(numbers) != tables * count:
        raise ValueError(f"{name}_packet_prior.c does not hold what the document says")
    return [[[number & 0xFFF0, COUNTS[number & 15]] for number in numbers[i * count:(i + 1) * count]]
            for i in range(tables)]


class PacketDecoder:
    """3a.1 and 5a.1: `units` of them in all, counted in groups."""

    def __init__(self, data, packet_id, units, group, first_bits):
        if len(data) < 4:
            raise FormatError
        word = int.from_bytes(data[:4], "little")
        if word >> 30 != 1:
            raise VersionError
        self.first = group * (word & ((1 << first_bits) - 1))
        self.coarser = (word & 0x1FFFF) >> first_bits
        end = self.first + group * ((word >> 17 & 511) + 1)
        if self.first >= units or end >= units + group:
            raise FormatError
        if word >> 27 & 7 != packet_id:
            raise NoReferenceError
        self.literal = word >> 26 & 1
        self.numbers = range(self.first, min(end, units))
        self.coder = RangeDecoder(data[4:])


def place(number, width, height, strip):
    """Column where the strip begins, its width, and the column and row in it of a unit."""
    start = number // (strip * height) * strip
    strip_width = min(strip, width - start)
    within = number % (strip * height)
    return start, strip_width, within % strip_width, within // strip_width


class GrayPacketDecoder(PacketDecoder):
    """Chapter 3a; info: width, height, near."""

    PRIORS = read_packet_prior("gray", 3, 243)
    pixel = codec_decoder.GrayDecoder.pixel

    def __init__(self, info, packet_id, data):
        self.width, self.height, self.near = info
        super().__init__(data, packet_id, self.width * self.height, GROUP, 17)
        table = iter([list(context) for context in self.PRIORS[0 if self.near == 0 else 1 if self.near < 8 else 2]])
        self.Z, self.S, self.M = shaped(table, 9), shaped(table, 27), shaped(table, 9, 23)

    def decode(self):
        """(x, y, pixel) of each of the packet's."""
        pixels, errors, unknown, result = {}, {}, None, []
        for number in self.numbers:
            start, strip_width, x, y = place(number, self.width, self.height, STRIP)
            if number == self.first or self.literal:
                R, E = self.coder.direct(8), 0
                unknown = R if number == self.first else unknown
            else:
                if x == y == 0:
                    pixels, errors, unknown = {}, {}, result[-1][2]
                N = pixels.get((x, y - 1), unknown)
                W = pixels.get((x - 1, y), unknown) if x else N
                NW = pixels.get((x - 1, y - 1), unknown) if x else N
                NE = pixels.get((x + 1, y - 1), unknown) if x + 1 < strip_width else N
                P = median(W, N, W + N - NW)
                energy = klass(abs(NE - N) + abs(N - NW) + abs(NW - W) + 2 * errors.get((x - 1, y), 0) +
                               2 * errors.get((x, y - 1), 0) + errors.get((x + 1, y - 1), 0),
                               (2, 5, 9, 14, 21, 31, 47, 79))
                R = self.pixel(P, W, N, NE, energy)
                E = abs(R - P)
            pixels[x, y], errors[x, y] = R, E
            result.append((start + x, y, R))
        return result
