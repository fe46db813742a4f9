"""Decoders of packets of images, written from docs/codec.md, chapters 3a to 5a, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
import re

import codec_decoder
import codec_decoder_picture
import codec_decoder_view
from codec_decoder import FormatError, NoReferenceError, RangeDecoder, VersionError, klass, median, shaped

GROUP = 8
STRIP = 16
BLOCK, PICTURE_STRIP = 8, 4
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


class ViewPacketDecoder(PacketDecoder):
    """Chapter 4a; info: width, height, cap, coarse."""

    PRIORS = read_packet_prior("view", 2, 392)
    level = codec_decoder_view.ViewDecoder.level

    def __init__(self, info, packet_id, data):
        self.width, self.height, self.cap, self.coarse = info
        super().__init__(data, packet_id, self.width * self.height, GROUP, 17)
        self.level_of = codec_decoder_view.COARSE_LEVEL_OF if self.coarse else range(8)
        self.value_of = codec_decoder_view.COARSE_VALUE_OF if self.coarse else range(8)
        self.L = 4 if self.coarse else self.cap
        self.contexts = shaped(iter([list(context) for context in self.PRIORS[self.coarse]]), 8, 6, 8)

    def value(self, level):
        return -self.value_of[-level] if level < 0 else self.value_of[level]

    def literal_value(self):
        v = min(self.coder.direct(4), 2 * self.cap) - self.cap
        return self.value(-self.level_of[-v] if v < 0 else self.level_of[v])

    def decode(self):
        """(x, y, P) of each of the packet's."""
        values, errors, result = {}, {}, []
        for number in self.numbers:
            start, strip_width, x, y = place(number, self.width, self.height, STRIP)
            if x == y == 0:
                values, errors = {}, {}

            def at(dx, dy):
                i, j = x + dx, y + dy
                if j < 0:
                    return 0
                if i < 0:
                    return values.get((0, j - 1), 0)
                return values.get((min(i, strip_width - 1), j), 0)

            def error_at(dx, dy):
                return errors.get((x + dx, y + dy), 0)

            if self.literal:
                v = self.literal_value()
            else:
                W, WW, N, NW, NE, NN, NWW = at(-1, 0), at(-2, 0), at(0, -1), at(-1, -1), at(1, -1), at(0, -2), at(-2, -1)
                m = 6 * W - 2 * WW + 15 * N - 2 * NW + 2 * NE - 5 * NN + NWW
                e = min((abs(m) + 8) >> 4, self.cap)
                activity = klass(2 * error_at(-1, 0) + 2 * error_at(0, -1) + error_at(-2, 0) + error_at(1, -1) +
                                 abs(W - NW) + abs(N - NW) + abs(NE - N), (2, 6, 11, 18, 27))
                v = self.value(self.level(e, activity))
                errors[x, y] = abs(v - e)
                v = -v if m < 0 else v
            values[x, y] = v
            result.append((start + x, y, v + self.cap))
        return result


class PicturePacketDecoder(PacketDecoder):
    """Chapter 5a; info: width, height, step."""

    PRIOR = codec_decoder_picture.PictureDecoder.PRIOR

    def __init__(self, info, packet_id, data):
        self.width, self.height, step = info[:3]
        self.across, self.down = -(-self.width // BLOCK), -(-self.height // BLOCK)
        super().__init__(data, packet_id, self.across * self.down, 1, 13)
        header = bytes([1, 0x40 | min(step + 4 * self.coarser, 63), 2 * BLOCK, 0, 2 * BLOCK, 0])
        self.corner = codec_decoder_picture.PictureDecoder(header)  # with prior 1; of a block and its neighbours
        self.corner.coder = self.coder
        self.corner.allowed = 1 << 60

    def block(self, blocks, x, y):
        """Decode block (x, y) of the strip, given those of the packet in it: (block, rows of pixels)."""
        (left, left_pixels), (above, above_pixels) = (blocks.get(at, (None, None)) for at in ((x - 1, y), (x, y - 1)))
        block, levels = self.corner.block(left, above)
        first_x, first_y, pixels = BLOCK if left else 0, BLOCK if above else 0, self.corner.pixels
        for i in range(BLOCK):
            if left:
                pixels[first_y + i][BLOCK - 1] = left_pixels[i][-1]
            if above:
                pixels[BLOCK - 1][first_x + i] = above_pixels[-1][i]
        self.corner.reconstruct(block, levels, first_x, first_y)
        return block, [row[first_x:first_x + BLOCK] for row in pixels[first_y:first_y + BLOCK]]

    def decode(self):
        """(x, y, pixel) of each of the packet's before smoothing; self.limits of its blocks."""
        blocks, result, self.limits = {}, [], {}
        for number in self.numbers:
            start, _, x, y = place(number, self.across, self.down, PICTURE_STRIP)
            if x == y == 0:
                blocks = {}
            if self.literal:
                mean, limit = self.coder.direct(8), 59
                pixels = [[mean] * BLOCK] * BLOCK
            else:
                block, pixels = blocks[x, y] = self.block(blocks, x, y)
                limit = block.limit
            self.limits[start + x, y] = limit
            result += [(BLOCK * (start + x) + j, BLOCK * y + i, pixels[i][j]) for i in range(BLOCK) for j in range(BLOCK)
                       if BLOCK * (start + x) + j < self.width and BLOCK * y + i < self.height]
        return result
