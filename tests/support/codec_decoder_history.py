"""Decoder of gray images against held ones, written from docs/codec.md, 3.7, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import FormatError, GrayDecoder, NoReferenceError, RangeDecoder, VersionError, contexts, klass, median

TILE = 8


def check_of(rows):
    """CRC-16 of 4.1 over the pixels."""
    crc = 0xFFFF
    for pixel in (pixel for row in rows for pixel in row):
        crc ^= int(pixel)
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc


class HistoryDecoder:
    """held: rows of pixels, or None."""

    pixel = GrayDecoder.pixel

    def __init__(self, data, held):
        if len(data) < 6:
            raise FormatError
        self.mode = data[0] >> 4
        if data[0] & 15 != 1 or self.mode > 1 or data[1] >> 4:
            raise VersionError
        self.near, self.width, self.height = data[1], data[2] | data[3] << 8, data[4] | data[5] << 8
        header_len = 8 if self.mode else 6
        if (self.near > 8 or not 1 <= self.width <= 640 or not 1 <= self.height <= 480 or len(data) < header_len):
            raise FormatError
        if self.mode and (held is None or (len(held), len(held[0])) != (self.height, self.width) or
                          check_of(held) != (data[6] | data[7] << 8)):
            raise NoReferenceError
        self.held = held
        self.coder = RangeDecoder(data[header_len:])
        self.Z, self.S, self.M, self.T = contexts(9), contexts(27), contexts(9, 23), contexts(8)
        self.allowed = 2048
        self.flags = [0] * (-(-self.width // TILE))

    def read_flags(self):
        above, count = self.flags, len(self.flags)
        self.flags = []
        for i in range(count):
            west, north_east = self.flags[i - 1] if i else 0, above[i + 1] if i + 1 < count else 0
            self.flags.append(self.coder.bit(self.T[west + 2 * above[i] + 4 * north_east]))
        self.allowed += 12 * count

    def coded(self, P, W, N, NE, energy):
        if 8 * self.coder.spent > self.allowed:
            return self.coder.direct(8)
        return self.pixel(P, W, N, NE, energy)

    def decode(self):
        above, errors_above, rows, last = [128] * self.width, [0] * self.width, [], self.width - 1
        for y in range(self.height):
            if self.mode and y % TILE == 0:
                self.read_flags()
            row, errors = [], []
            for x in range(self.width):
                if self.mode and not self.flags[x // TILE]:
                    R, E = int(self.held[y][x]), 0
                else:
                    N = above[x]
                    W, NW = (row[-1], above[x - 1]) if x else (N, N)
                    NE = above[x + 1] if x < last else N
                    P = median(W, N, W + N - NW)
                    energy = klass(abs(NE - N) + abs(N - NW) + abs(NW - W) + 2 * (errors[-1] if x else 0) +
                                   2 * errors_above[x] + (errors_above[x + 1] if x < last else 0),
                                   (2, 5, 9, 14, 21, 31, 47, 79))
                    R = self.coded(P, W, N, NE, energy)
                    E = abs(R - P)
                self.allowed += 8
                row.append(R)
                errors.append(E)
            rows.append(row)
            above, errors_above = row, errors
        return rows
