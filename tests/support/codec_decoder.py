"""Decoders of coded disparity maps and gray images, written from docs/codec.md, not from the C.

Section numbers below are those of docs/codec.md. decode_map and decode_gray take the bytes of one message and raise
FormatError or VersionError where the document says that a decoder stops. The trained numbers of maps are read from
firmware/codec/map_prior.c, which the document names as a part of itself.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import re

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
INVALID = 0xFFFF


class FormatError(Exception):
    """Bytes that do not follow the format; `rows` holds the rows decoded before."""

    def __init__(self, rows=()):
        super().__init__("format")
        self.rows = rows


class VersionError(Exception):
    """A version, mode or prior that the document does not have."""


class NoReferenceError(Exception):
    """A map coded against a reference, and none or another is at hand."""


class RangeDecoder:
    """Chapter 1. `shift` is that of fixed-rate bits (1.6): 6, but 5 in packets (2a.2)."""

    def __init__(self, data, shift=6):
        self.data = data
        self.shift = shift
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

    def decide(self, p):
        """A bit that is 1 with probability p / 2^16."""
        bound = (self.range >> 16) * p
        if self.offset < bound:
            bit = 1
            self.range = bound
        else:
            bit = 0
            self.offset -= bound
            self.range -= bound
        self._renormalise()
        return bit

    def bit(self, context):
        p, n = context
        rate = 655360 // (10 * n + 16)
        bit = self.decide(p)
        context[0] = p + (((65504 - p) * rate) >> 16) if bit else p - (((p - 32) * rate) >> 16)
        context[1] = min(n + 1, 60)
        return bit

    def fixed_rate_bit(self, cells, i):
        p = cells[i]
        bit = self.decide(p)
        cells[i] = p + ((65536 - p) >> self.shift) if bit else p - (p >> self.shift)
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
        return self.magnitude_by(lambda i: self.bit(c[i]))

    def magnitude_by(self, bit):
        """bit(i) decodes one bit with context i of the 23."""
        k = 0
        while k < 13 and bit(k):
            k += 1
        if k < 4:
            return k
        first = {4: 4, 5: 6, 6: 10, 7: 18, 8: 34, 9: 66, 10: 130, 11: 258, 12: 514, 13: 1026}[k]
        upper = bit(13 + k - 4)
        return first + upper * 2 ** (k - 4) + (self.direct(k - 4) if k > 4 else 0)


def contexts(*shape):
    if not shape:
        return [32768, 0]
    return [contexts(*shape[1:]) for _ in range(shape[0])]


def read_prior(name, count):
    """The numbers of an array of firmware/codec/NAME_prior.c that starts adaptive bits."""
    body = (SOURCE / f"firmware/codec/{name}_prior.c").read_text("ascii").partition("= {")[2].partition("}")[0]
    numbers = [int(number, 0) for number in re.findall(r"\w+", body)]
    if len(numbers) != count:
        raise ValueError(f"{name}_prior.c does not hold what the document says")
    return numbers


def trained(number):
    """1.2: the context that a number of a prior says."""
    return [number & 0xFFF0, (0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 33, 40, 48, 54, 60)[number % 16]]


def median(a, b, c):
    return sorted((a, b, c))[1]


def klass(value, lasts):
    """The number of the first class whose last value is not below value."""
    for i, last in enumerate(lasts):
        if value <= last:
            return i
    return len(lasts)


def shaped(numbers, *shape):
    """The next of the iterator `numbers` as nested lists."""
    if not shape:
        return next(numbers)
    return [shaped(numbers, *shape[1:]) for _ in range(shape[0])]


def read_map_prior():
    """T by kind and table, and the contexts' starts: alone, near, against a reference."""
    text = (SOURCE / "firmware/codec/map_prior.c").read_text("ascii")
    parts = re.findall(r"\.weights = (.*?)\.cells = (.*?)\n};", text, re.DOTALL)
    alone, against = ([[int(number) for number in re.findall(r"-?\d+", part)] for part in pair] for pair in parts)
    if [len(part) for part in alone + against] != [6 * 5 * 64, 2 * 466, 6 * 3 * 64, 466]:
        raise ValueError("map_prior.c does not hold what the document says")
    tables = [first + more for first, more in zip(shaped(iter(alone[0]), 6, 5, 64), shaped(iter(against[0]), 6, 3, 64))]
    return tables, shaped(iter(alone[1] + against[1]), 3, 466)


class MapDecoder:
    """Chapter 2."""

    TABLES, CELLS = read_map_prior()

    def __init__(self, data, reference=None, reference_id=None):
        if len(data) < 9:
            raise FormatError
        if data[0] & 15 != 2 or data[0] >> 4 > 1 or data[1] >> 4 != 1:
            raise VersionError
        self.mode = data[0] >> 4
        self.step_log2 = data[1] & 7
        self.near = data[1] >> 3 & 1
        self.disparities = data[2] + 1
        self.width = data[3] | data[4] << 8
        self.height = data[5] | data[6] << 8
        self.d0_q4 = int.from_bytes(data[7:9], "little", signed=True)
        header_len = 11 if self.mode else 9
        if (len(data) < header_len or self.step_log2 > 4 or self.disparities > 128 or not 1 <= self.width <= 640
                or not 1 <= self.height <= 480):
            raise FormatError
        self.reference_id = data[9] | data[10] << 8 if self.mode else None
        if self.mode and (reference is None or reference_id != self.reference_id):
            raise NoReferenceError
        self.coder = RangeDecoder(data[header_len:])
        self._begin()
        self.reference = {(x, y): self.reference_label(reference[y][x]) for y in range(self.height)
                          for x in range(self.width)} if self.mode else {}

    def _begin(self):
        """What the fields of the header decide."""
        self.labels = (16 * self.disparities) >> self.step_log2
        self.label_bits = self.labels.bit_length()
        self.none = self.label_of(INVALID)
        self.last = self.labels // 4
        self.map = {}
        cells = iter(self.CELLS[2 if self.mode else self.near])
        self.flat, self.candidate, self.invalid = shaped(cells, 48), shaped(cells, 6, 32), shaped(cells, 16, 6)
        self.predicted, self.sign = shaped(cells, 6, 6), shaped(cells, 27)
        self.nearer, self.farther, self.half = shaped(cells, 4, 12), shaped(cells, 9), shaped(cells, 10)

    def reference_label(self, value):
        label = self.label_of(value)
        return label if label < self.labels else self.none

    def label_of(self, d_q4):
        return (d_q4 >> self.step_log2) & 0x7FFF

    def pixel(self, x, y, run):
        """2.3, 2.5 to 2.7"""
        none, bit = self.none, self.coder.fixed_rate_bit

        def at(dx, dy, labels=self.map):
            return labels.get((x + dx, y + dy), none)

        def at_reference(dx, dy):
            return at(dx, dy, self.reference)

        def diff(a, b):
            return abs(a - b)

        WWW, WW, W = at(-3, 0), at(-2, 0), at(-1, 0)
        NWW, NW, N, NE, NEE = at(-2, -1), at(-1, -1), at(0, -1), at(1, -1), at(2, -1)
        NNW, NN, NNE = at(-1, -2), at(0, -2), at(1, -2)
        gap = klass(diff(W, N), (0, 1, 3, 8, 2047))
        activity = klass(diff(W, N) + diff(N, NE) + diff(W, NW) + diff(NW, N), (0, 2, 5, 12, 2047))
        if self.mode:
            R, RE, RS, RSE = at_reference(0, 0), at_reference(1, 0), at_reference(0, 1), at_reference(1, 1)
            RW, RN, RNE, RNW = at_reference(-1, 0), at_reference(0, -1), at_reference(1, -1), at_reference(-1, -1)
            changed = (W != RW) + 2 * (N != RN) + 4 * (NE != RNE) + 8 * (NW != RNW)
        if self.mode and R != none and (W == RW or N == RN):
            P = R
        elif none not in (W, N, NW):
            P = median(W, N, W + N - NW)
        else:
            P = next((v for v in (W, N, NE, NW) if v != none), self.last)
        # 2.5
        asked = []
        flat = N == NE == NW == WW == NN == W
        if flat:
            if self.mode:
                f = (W == none) + 2 * (R == W) + 4 * (RE == W) + 8 * (RS == W) + 16 * (changed != 0)
            else:
                f = (W == none) + 2 * klass(run, (0, 1, 3, 7, 15)) + 12 * (NEE == W) + 24 * (NNE == W)
            if bit(self.flat, f):
                return W
            asked.append(W)
        # 2.6
        candidates = []
        if not flat and N != W and NW == W:
            candidates += [(N, 1), (W, 4)]
        elif not flat:
            candidates += [(W, 0 if W == N else 2), (N, 3)]
        if self.mode:
            candidates.append((R, 5))
        if not flat:
            candidates += [(C, 5) for C in (NE, NW, NEE) if diff(C, P) > 3]
        for C, kind in candidates:
            if C in asked:
                continue
            asked.append(C)

            def pair(a, b, C=C):
                return min(max(a - C, -4), 3) % 8 + 8 * (min(max(b - C, -4), 3) % 8)

            T = self.TABLES[kind]
            total = (T[0][pair(NE, NEE)] + T[1][pair(NWW, NW)] + T[2][pair(NN, NNE)] + T[3][pair(WWW, WW)]
                     + T[4][pair(N if C == W else W, NNW)])
            if self.mode:
                total += T[5][pair(R, RE)] + T[6][pair(RS, RSE)] + T[7][changed + 16 * (R == C) + 32 * (RE == R)]
            if bit(self.candidate[kind], min(max((total + 2) // 4 + 16, 0), 31)):
                return C
        # 2.7
        if none not in asked:
            if bit(self.invalid[(NE == none) + 2 * (NW == none) + 4 * (WW == none) + 8 * (NN == none)], gap):
                return none
        if P not in asked:
            if bit(self.predicted[gap], activity):
                return P

        def side(v):
            return 1 if v in (none, P) else 2 if v > P else 0

        below = bit(self.sign, side(W) + 3 * side(N) + 9 * side(NE))
        c = 2 * activity + (P in asked)
        magnitude = self.coder.magnitude_by(lambda i: bit(self.nearer[i], c) if i < 4 else bit(self.farther, i - 4)
                                            if i < 13 else bit(self.half, i - 13))
        label = P - 1 - magnitude if below else P + 1 + magnitude
        if not 0 <= label < self.labels:
            raise FormatError
        return label

    def literal(self):
        """2.4"""
        label = self.coder.direct(self.label_bits)
        if label > self.labels:
            raise FormatError
        return self.none if label == self.labels else label

    def decode(self):
        rows = []
        allowed = 2048
        for y in range(self.height):
            run = 0
            for x in range(self.width):
                if x % 16 == 0:
                    literal = 8 * self.coder.spent > allowed
                    allowed += min(16, self.width - x) * self.label_bits
                try:
                    label = self.literal() if literal else self.pixel(x, y, run)
                except FormatError:
                    raise FormatError(rows) from None
                self.map[x, y] = label
                run = run + 1 if label == self.map.get((x - 1, y), self.none) else 0
                self.last = label if label != self.none else self.last
            rows.append([INVALID if label == self.none else label << self.step_log2
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


def decode_map(data, reference=None, reference_id=None):
    """(decoder with the header's fields, rows of UQ12.4 disparities); reference: such rows of the same shape"""
    decoder = MapDecoder(data, reference, reference_id)
    return decoder, decoder.decode()


def decode_gray(data):
    """(decoder with the header's fields, rows of pixels)"""
    decoder = GrayDecoder(data)
    return decoder, decoder.decode()
