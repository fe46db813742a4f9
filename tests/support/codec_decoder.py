"""Decoders of coded disparity maps and gray images, written from docs/codec.md, not from the C.

Section numbers below are those of docs/codec.md. decode_map and decode_gray take the bytes of one message and raise
FormatError or VersionError where the document says that a decoder stops.

SPDX-License-Identifier: Apache-2.0
"""

INVALID = 0xFFFF


class FormatError(Exception):
    """Bytes that do not follow the format; `rows` holds the rows decoded before."""

    def __init__(self, rows=()):
        super().__init__("format")
        self.rows = rows


class VersionError(Exception):
    """A version, mode or prior that version 1 does not have."""


class RangeDecoder:
    """Chapter 1."""

    def __init__(self, data):
        self.data = data
        self.next = 0
        self.range = 2**32 - 1
        self.offset = 0
        self.spent = 0
        for _ in range(4):
            self.offset = self.offset * 256 + self._byte()

    def _byte(self):
        self.next += 1
        return self.data[self.next - 1] if self.next <= len(self.data) else 0

    def _renormalise(self):
        while self.range < 2**24:
            self.offset = (self.offset * 256 + self._byte()) % 2**32
            self.range *= 256
            self.spent += 1

    def bit(self, context):
        p, n = context
        bound = (self.range >> 16) * p
        rate = 655360 // (10 * n + 16)
        if self.offset < bound:
            bit = 1
            self.range = bound
            context[0] = p + (((65504 - p) * rate) >> 16)
        else:
            bit = 0
            self.offset -= bound
            self.range -= bound
            context[0] = p - (((p - 32) * rate) >> 16)
        context[1] = min(n + 1, 60)
        self._renormalise()
        return bit

    def direct(self, b):
        self.range >>= b
        value = 0
        for i in range(b - 1, -1, -1):
            value *= 2
            if self.offset >= self.range * 2**i:
                self.offset -= self.range * 2**i
                value += 1
        self._renormalise()
        return value

    def magnitude(self, c):
        k = 0
        while k < 13 and self.bit(c[k]):
            k += 1
        if k < 4:
            return k
        first = {4: 4, 5: 6, 6: 10, 7: 18, 8: 34, 9: 66, 10: 130, 11: 258, 12: 514, 13: 1026}[k]
        upper = self.bit(c[13 + k - 4])
        return first + upper * 2 ** (k - 4) + (self.direct(k - 4) if k > 4 else 0)


def contexts(*shape):
    if not shape:
        return [32768, 0]
    return [contexts(*shape[1:]) for _ in range(shape[0])]


def median(a, b, c):
    return sorted((a, b, c))[1]


def klass(value, lasts):
    """The number of the first class whose last value is not below value."""
    for i, last in enumerate(lasts):
        if value <= last:
            return i
    return len(lasts)


class MapDecoder:
    """Chapter 2."""

    def __init__(self, data):
        if len(data) < 9:
            raise FormatError
        if data[0] != 1 or data[1] >> 4 != 0:
            raise VersionError
        self.step_log2 = data[1]
        self.disparities = data[2] + 1
        self.width = data[3] | data[4] << 8
        self.height = data[5] | data[6] << 8
        self.d0_q4 = int.from_bytes(data[7:9], "little", signed=True)
        if (self.step_log2 > 4 or self.disparities > 128 or not 1 <= self.width <= 640
                or not 1 <= self.height <= 480):
            raise FormatError
        self.labels = 1 + ((16 * self.disparities) >> self.step_log2)
        self.label_bits = (self.labels - 1).bit_length()
        self.coder = RangeDecoder(data[9:])
        self.F, self.K, self.I = contexts(24), contexts(38, 16), contexts(16, 6)
        self.Z, self.S, self.M = contexts(6, 6), contexts(27, 2), contexts(12, 23)
        self.last = 1 + (self.labels - 1) // 4
        self.map = {}

    def at(self, x, y):
        return self.map.get((x, y), 0)

    @staticmethod
    def diff(a, b):
        if a == 0 or b == 0:
            return 0 if a == b else 16384
        return abs(a - b)

    def pixel(self, x, y, run):
        at, diff, bit = self.at, self.diff, self.coder.bit
        W, WW, N, NW, NE = at(x - 1, y), at(x - 2, y), at(x, y - 1), at(x - 1, y - 1), at(x + 1, y - 1)
        NEE, NN, NNE = at(x + 2, y - 1), at(x, y - 2), at(x + 1, y - 2)
        gap = klass(diff(W, N), (0, 1, 3, 8, 16383))
        activity = klass(diff(W, N) + diff(N, NE) + diff(W, NW) + diff(NW, N), (0, 2, 5, 12, 16383))
        if W and N and NW:
            P = median(W, N, W + N - NW)
        else:
            P = W or N or NE or NW or self.last
        # 2.5
        swap = N != W and NW == W
        asked = []
        for number, C in enumerate((N if swap else W, W if swap else N, NE, NW, NEE), 1):
            if C in asked or (number >= 3 and diff(C, P) <= 3):
                continue
            if number == 1 and N == NE == NW == WW == NN == W:
                r = klass(run, (0, 1, 3, 7, 15))
                context = self.F[(W == 0) + 2 * r + 12 * (NEE == W and NNE == W)]
            else:
                m = (NE == C) + 2 * (NW == C) + 4 * (WW == C) + 8 * (NN == C)
                if len(asked) >= 2 or (len(asked) == 1 and W == N):
                    g = 26 + gap + 6 * (C == 0)
                elif W == N:
                    g = int(C == 0)
                else:
                    g = 2 + 12 * len(asked) + 6 * (C == N) + (gap - 1) + (C == 0)
                context = self.K[g][m]
            if bit(context):
                return C
            asked.append(C)
        # 2.6
        if 0 not in asked:
            if bit(self.I[(NE == 0) + 2 * (NW == 0) + 4 * (WW == 0) + 8 * (NN == 0)][gap]):
                return 0
        if P not in asked:
            if bit(self.Z[gap][activity]):
                return P

        def side(v):
            return 1 if v == 0 or v == P else 2 if v > P else 0

        e = int(P in asked)
        below = bit(self.S[side(W) + 3 * side(N) + 9 * side(NE)][e])
        magnitude = self.coder.magnitude(self.M[2 * activity + e])
        label = P - 1 - magnitude if below else P + 1 + magnitude
        if not 1 <= label < self.labels:
            raise FormatError
        return label

    def decode(self):
        rows = []
        allowed = 2048
        for y in range(self.height):
            run = 0
            for x in range(self.width):
                try:
                    if 8 * self.coder.spent > allowed:
                        label = self.coder.direct(self.label_bits)
                        if label >= self.labels:
                            raise FormatError
                    else:
                        label = self.pixel(x, y, run)
                except FormatError:
                    raise FormatError(rows) from None
                allowed += self.label_bits
                self.map[x, y] = label
                run = run + 1 if label == self.at(x - 1, y) else 0
                self.last = label or self.last
            rows.append([INVALID if label == 0 else (label - 1) << self.step_log2
                         for label in (self.map[x, y] for x in range(self.width))])
        return rows


class GrayDecoder:
    """Chapter 3."""

    def __init__(self, data):
        if len(data) < 6:
            raise FormatError
        if data[0] != 1 or data[1] >> 4 != 0:
            raise VersionError
        self.near = data[1]
        self.width = data[2] | data[3] << 8
        self.height = data[4] | data[5] << 8
        if self.near > 8 or not 1 <= self.width <= 640 or not 1 <= self.height <= 480:
            raise FormatError
        self.coder = RangeDecoder(data[6:])
        self.Z, self.S, self.M = contexts(9), contexts(27), contexts(9, 23)

    def pixel(self, P, W, N, NE, energy):
        if not self.coder.bit(self.Z[energy]):
            return P

        def side(v):
            return 2 if v > P else 1 if v == P else 0

        below = self.coder.bit(self.S[side(W) + 3 * side(N) + 9 * side(NE)])
        q = 1 + self.coder.magnitude(self.M[energy])
        near = (0, 0, 0, 0, 0, 0, 1, 2, 4)[energy] if self.near == 8 else self.near
        R = P + (-q if below else q) * (2 * near + 1)
        return min(max(R, 0), 255)

    def decode(self):
        rows = []
        errors_above = [0] * self.width
        above = [128] * self.width
        allowed = 2048
        last = self.width - 1
        for _ in range(self.height):
            row, errors = [], []
            for x in range(self.width):
                N = above[x]
                W = row[x - 1] if x > 0 else N
                NW = above[x - 1] if x > 0 else N
                NE = above[x + 1] if x < last else N
                E_W = errors[x - 1] if x > 0 else 0
                E_NE = errors_above[x + 1] if x < last else 0
                P = median(W, N, W + N - NW)
                energy = klass(abs(NE - N) + abs(N - NW) + abs(NW - W) + 2 * E_W + 2 * errors_above[x] + E_NE,
                               (2, 5, 9, 14, 21, 31, 47, 79))
                R = self.coder.direct(8) if 8 * self.coder.spent > allowed else self.pixel(P, W, N, NE, energy)
                allowed += 8
                row.append(R)
                errors.append(abs(R - P))
            rows.append(row)
            above, errors_above = row, errors
        return rows


def decode_map(data):
    """(decoder with the header's fields, rows of UQ12.4 disparities)"""
    decoder = MapDecoder(data)
    return decoder, decoder.decode()


def decode_gray(data):
    """(decoder with the header's fields, rows of pixels)"""
    decoder = GrayDecoder(data)
    return decoder, decoder.decode()
