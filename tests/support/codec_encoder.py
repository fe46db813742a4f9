"""The range coder's other side, written from docs/codec.md, 1.4: bytes for decisions that another makes.

An Encoder stands in the place of a decoder's coder, takes each decision from its source and writes it. From a
RangeDecoder as the source the bytes are again those that it reads, if their encoder kept to 1.4; from Decisions they
are a stream that reaches what no picture does.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import RangeDecoder


class Decisions:
    """Decisions of a numpy generator: as likely as contexts say, but at random in a share `wild` of them."""

    def __init__(self, rng, wild):
        self.rng = rng
        self.wild = wild

    def decide(self, p):
        if self.rng.random() < self.wild:
            return int(self.rng.random() < 0.5)
        return int(65536 * self.rng.random() < p)

    def direct(self, b):
        return int(self.rng.integers(0, 2**b))


class Encoder(RangeDecoder):
    def __init__(self, source, shift=6):
        super().__init__(b"", shift)
        self.source = source
        self.low = 0
        self.bytes = bytearray()

    def _add(self, number):
        self.low += number
        if self.low >= 2**32:
            self.low -= 2**32
            self._carry()

    def _carry(self):
        i = len(self.bytes) - 1
        while self.bytes[i] == 255:
            self.bytes[i] = 0
            i -= 1
        self.bytes[i] += 1

    def _renormalise(self):
        while self.range < 2**24:
            self.bytes.append(self.low >> 24)
            self.low = self.low * 256 % 2**32
            self.range *= 256
            self.spent += 1

    def decide(self, p):
        bound = (self.range >> 16) * p
        bit = self.source.decide(p)
        if bit:
            self.range = bound
        else:
            self._add(bound)
            self.range -= bound
        self._renormalise()
        return bit

    def direct(self, b):
        self.range >>= b
        value = self.source.direct(b)
        self._add(value * self.range)
        self._renormalise()
        return value

    def finish(self):
        """The stream."""
        zero_bytes = next(n for n in (4, 3, 2, 1, 0)
                          if -(-self.low // 256**n) * 256**n < self.low + self.range)
        self._add(-self.low % 256**zero_bytes)
        data = bytes(self.bytes) + self.low.to_bytes(4, "big")
        return data.rstrip(b"\0")
