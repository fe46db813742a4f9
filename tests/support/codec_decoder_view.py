"""Decoder of prefiltered views, written from docs/codec.md, chapter 4, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import (FormatError, NoReferenceError, RangeDecoder, VersionError, contexts, klass, read_prior,
                           trained)

TILE = 8
COARSE_LEVEL_OF = (0, 1, 2, 2, 3, 3, 4, 4)
COARSE_VALUE_OF = (0, 1, 2, 4, 7)


class Held:
    """The view decoded last: its rows, and the header's fields of it; rows are None while nothing is held."""

    def __init__(self):
        self.rows = None
        self.shape = None

    def check(self):
        """4.1: CRC-16 of the packed rows."""
        crc = 0xFFFF
        for row in self.rows:
            for x in range(0, len(row), 2):
                crc ^= row[x] | (row[x + 1] << 4 if x + 1 < len(row) else 0)
                for _ in range(8):
                    crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
        return crc


class ViewDecoder:
    """Chapter 4."""

    PRIOR = read_prior("view", 392)

    def __init__(self, data, held):
        if len(data) < 6:
            raise FormatError
        self.mode = data[0] >> 4
        self.cap = data[1] & 7
        self.coarse = data[1] >> 3 & 1
        if data[0] & 15 != 1 or self.mode > 1 or data[1] >> 4 != self.coarse:
            raise VersionError
        self.width = data[2] | data[3] << 8
        self.height = data[4] | data[5] << 8
        header_len = 8 if self.mode else 6
        if (len(data) < header_len or not self.cap or (self.coarse and self.cap != 7) or not 1 <= self.width <= 640
                or not 1 <= self.height <= 480):
            raise FormatError
        self.shape = self.width, self.height, self.cap, self.coarse
        self.held_rows = None
        if self.mode:
            if held.rows is None or held.shape != self.shape or held.check() != (data[6] | data[7] << 8):
                raise NoReferenceError
            self.held_rows = held.rows
        self.held = held
        self.coder = RangeDecoder(data[header_len:])
        self._begin()

    def _begin(self):
        self.level_of = COARSE_LEVEL_OF if self.coarse else range(8)
        self.value_of = COARSE_VALUE_OF if self.coarse else range(8)
        self.L = 4 if self.coarse else self.cap
        if self.coarse:
            flat = [trained(number) for number in self.PRIOR]
        else:
            flat = contexts(392)
        self.contexts = [[flat[8 * (6 * e + activity):][:8] for activity in range(6)] for e in range(8)]
        self.T = flat[384:]

    def tiles(self, above):
        """4.4: the flags of a row of tiles."""
        count = -(-self.width // TILE)
        flags = []
        for i in range(count):
            west = flags[i - 1] if i else 0
            north_east = above[i + 1] if i + 1 < count else 0
            flags.append(self.coder.bit(self.T[west + 2 * above[i] + 4 * north_east]))
        return flags

    def level(self, e, activity):
        """4.5, 1 to 4: l'."""
        bit = self.coder.bit
        D, B, *far = self.contexts[e][activity]
        r, L = self.level_of[e], self.L
        if not bit(D):
            return r
        below = bit(B) if r < L else 1
        longest = r + L if below else L - r
        k = 1
        while k < longest and bit(far[min(k - 1, 2) + (0 if below else 3)]):
            k += 1
        return r - k if below else r + k

    def row(self, y, values, errors_above, flags):
        """The values of row y, and their errors. `values` holds the rows before."""
        width, cap = self.width, self.cap
        north = values[y - 1] if y else [0] * width
        north_2 = values[y - 2] if y > 1 else [0] * width
        west_of = north[0]
        row, errors = [], []
        N_border = [north_2[0] if y else 0] * 2 + north + north[-1:]
        for x in range(width):
            NWW, NW, N, NE = N_border[x:x + 4]
            W = row[x - 1] if x else west_of
            WW = row[x - 2] if x > 1 else west_of
            m = 6 * W - 2 * WW + 15 * N - 2 * NW + 2 * NE - 5 * north_2[x] + NWW
            flip = m < 0
            e = min((abs(m) + 8) >> 4, cap)
            if flags is not None and not flags[x // TILE]:
                row.append(self.held_rows[y][x] - cap)
                errors.append(0)
            else:
                E_W = errors[x - 1] if x else 0
                E_WW = errors[x - 2] if x > 1 else 0
                E_NE = errors_above[x + 1] if x + 1 < width else 0
                activity = klass(2 * E_W + 2 * errors_above[x] + E_WW + E_NE + abs(W - NW) + abs(N - NW) + abs(NE - N),
                                 (2, 6, 11, 18, 27))
                if 8 * self.coder.spent > self.allowed:
                    level = min(self.coder.direct(4), 2 * self.L) - self.L
                else:
                    level = self.level(e, activity)
                value = -self.value_of[-level] if level < 0 else self.value_of[level]
                errors.append(abs(value - e))
                row.append(-value if flip else value)
            self.allowed += 4
        return row, errors

    def decode(self):
        self.held.rows = None
        self.allowed = 2048
        count = -(-self.width // TILE)
        flags = [0] * count if self.mode else None
        values, errors = [], [0] * self.width
        for y in range(self.height):
            if self.mode and y % TILE == 0:
                flags = self.tiles(flags)
                self.allowed += 12 * count
            row, errors = self.row(y, values, errors, flags)
            values.append(row)
        rows = [[value + self.cap for value in row] for row in values]
        self.held.rows, self.held.shape = rows, self.shape
        return rows


def decode_view(data, held=None):
    """(decoder with the header's fields, rows of pixels 0 .. 2 cap); `held` (a Held) takes the view."""
    decoder = ViewDecoder(data, held if held is not None else Held())
    return decoder, decoder.decode()
