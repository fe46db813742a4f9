"""Decoder of pictures, written from docs/codec.md, chapter 5, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import FormatError, RangeDecoder, VersionError, contexts, klass, read_prior, shaped, trained

BLOCK = 8
MEAN, PLANE, VERTICAL, HORIZONTAL = range(4)
LAST_ENDS = (0, 1, 2, 4, 6, 8, 12, 16, 24, 32, 48)  # of the classes but the last
LAST_FIRSTS = (0, 1, 2, 3, 5, 7, 9, 13, 17, 25, 33, 49)
LAST_BITS = (0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 4, 4)
STEPS = (64, 70, 76, 83, 91, 99, 108, 117)
K = (2048, 1814, 3277, 1814, 2048, 1814, 3277, 1814)
ZIGZAG = (0, 1, 8, 16, 9, 2, 3, 10, 17, 24, 32, 25, 18, 11, 4, 5,
          12, 19, 26, 33, 40, 48, 41, 34, 27, 20, 13, 6, 7, 14, 21, 28,
          35, 42, 49, 56, 57, 50, 43, 36, 29, 22, 15, 23, 30, 37, 44, 51,
          58, 59, 52, 45, 38, 31, 39, 46, 53, 60, 61, 54, 47, 55, 62, 63)
PLACE = ((0, 1, 4, 9, 9, 9, 9, 9), (2, 3, 6, 7, 7, 8, 8, 8), (5, 6, 7, 7, 8, 8, 8, 8), (10, 7, 7, 8, 8, 8, 8, 8),
         (10, 7, 8, 8, 8, 8, 8, 8), (10, 8, 8, 8, 8, 8, 8, 8), (10, 8, 8, 8, 8, 8, 8, 8), (10, 8, 8, 8, 8, 8, 8, 8))
SCALE = ((64, 61, 83, 63, 68, 65, 88, 66), (61, 58, 79, 60, 65, 62, 84, 63), (83, 79, 108, 82, 88, 84, 114, 86),
         (63, 60, 82, 62, 66, 63, 86, 65), (68, 65, 88, 66, 71, 68, 93, 70), (65, 62, 84, 63, 68, 65, 88, 66),
         (88, 84, 114, 86, 93, 88, 120, 90), (66, 63, 86, 65, 70, 66, 90, 68))


def clamp(value, low, high):
    return min(max(value, low), high)


def forward(x):
    """5.5"""
    s0, s1, s2, s3 = x[0] + x[7], x[1] + x[6], x[2] + x[5], x[3] + x[4]
    d0, d1, d2, d3 = x[0] - x[7], x[1] - x[6], x[2] - x[5], x[3] - x[4]
    a0, a1, a2, a3 = s0 + s3, s1 + s2, s0 - s3, s1 - s2
    b0, b1 = d1 + d2 + d0 + (d0 >> 1), d0 - d3 - d2 - (d2 >> 1)
    b2, b3 = d0 + d3 - d1 - (d1 >> 1), d1 - d2 + d3 + (d3 >> 1)
    return (a0 + a1, b0 + (b3 >> 2), a2 + (a3 >> 1), b1 + (b2 >> 2),
            a0 - a1, b2 - (b1 >> 2), (a2 >> 1) - a3, (b0 >> 2) - b3)


def inverse(w):
    """5.5"""
    a0, a1, a2, a3 = w[0] + w[4], w[0] - w[4], (w[2] >> 1) - w[6], w[2] + (w[6] >> 1)
    e0, e1, e2, e3 = a0 + a3, a1 + a2, a1 - a2, a0 - a3
    b0, b1 = w[5] - w[3] - w[7] - (w[7] >> 1), w[1] + w[7] - w[3] - (w[3] >> 1)
    b2, b3 = w[7] - w[1] + w[5] + (w[5] >> 1), w[3] + w[5] + w[1] + (w[1] >> 1)
    o0, o1, o2, o3 = b0 + (b3 >> 2), b1 + (b2 >> 2), (b1 >> 2) - b2, b3 - (b0 >> 2)
    return [e0 + o3, e1 + o2, e2 + o1, e3 + o0, e3 - o0, e2 - o1, e1 - o2, e0 - o3]


def predict(mode, X, Y):
    """5.5: w by rows."""
    P = [(t * k + 128) >> 8 for t, k in zip(forward(X), K)]
    Q = [(t * k + 128) >> 8 for t, k in zip(forward(Y), K)]
    w = [[0] * BLOCK for _ in range(BLOCK)]
    if mode == MEAN:
        w[0][0] = (P[0] + Q[0]) >> 1
    elif mode == VERTICAL:
        w[0] = P
    elif mode == HORIZONTAL:
        for u in range(BLOCK):
            w[u][0] = Q[u]
    else:
        for i in range(2, BLOCK):
            w[0][i], w[1][i] = (7 * P[i]) >> 5, (17 * P[i]) >> 7
            w[i][0], w[i][1] = (7 * Q[i]) >> 5, (17 * Q[i]) >> 7
        w[0][0] = ((7 * (P[0] + Q[0])) >> 5) + 18 * (X[7] + Y[7])
        w[0][1] = ((7 * P[1]) >> 5) + ((17 * (Q[0] - 64 * X[7])) >> 7)
        w[1][0] = ((7 * Q[1]) >> 5) + ((17 * (P[0] - 64 * Y[7])) >> 7)
        w[1][1] = (17 * (P[1] + Q[1])) >> 7
    return w


class Block:
    def __init__(self):
        self.mode = MEAN
        self.last = 0
        self.activity = None
        self.limit = None


class PictureDecoder:
    """Chapter 5."""

    PRIOR = read_prior("picture", 381)

    def __init__(self, data):
        if len(data) < 6:
            raise FormatError
        self.step, self.prior = data[1] & 63, data[1] >> 6
        if data[0] != 1 or self.prior > 1:
            raise VersionError
        self.width = data[2] | data[3] << 8
        self.height = data[4] | data[5] << 8
        if not 1 <= self.width <= 640 or not 1 <= self.height <= 480:
            raise FormatError
        self.first_step = self.step
        self.coder = RangeDecoder(data[6:])
        starts = iter([trained(number) for number in self.PRIOR] if self.prior else contexts(381))
        self.C, self.D, self.L, self.H = (shaped(starts, *shape) for shape in ((2,), (16, 3), (6, 11), (9,)))
        self.A, self.N, self.G, self.M = (shaped(starts, *shape) for shape in ((5, 4, 4), (11, 6), (3, 6), (4, 23)))
        self.across, self.down = -(-self.width // BLOCK), -(-self.height // BLOCK)
        self.blocks = [[] for _ in range(self.down)]
        self.pixels = [[0] * (BLOCK * self.across) for _ in range(BLOCK * self.down)]

    def unary(self, cells, most):
        ones = 0
        while ones < most and self.coder.bit(cells[ones]):
            ones += 1
        return ones

    def change_step(self):
        """5.2"""
        if self.coder.bit(self.C[0]):
            down = self.coder.bit(self.C[1])
            s = 1 + self.coder.direct(3)
            self.step = clamp(self.step - s if down else self.step + s, 0, 63)

    def last(self, last_class):
        """5.3, 2"""
        kind = self.unary(self.L[last_class >> 1], 11)
        b = LAST_BITS[kind]
        place = 0
        if b:
            place = self.coder.bit(self.H[kind - 3]) << (b - 1)
            if b > 1:
                place += self.coder.direct(b - 1)
        return LAST_FIRSTS[kind] + place

    def levels(self, last):
        """5.3, 4: rows of levels."""
        coder = self.coder
        levels = [[0] * (BLOCK + 2) for _ in range(BLOCK + 2)]
        for k in range(last - 1, -1, -1):
            u, v = divmod(ZIGZAG[k], BLOCK)
            around = (levels[u][v + 1], levels[u][v + 2], levels[u + 1][v], levels[u + 1][v + 1], levels[u + 2][v])
            total = sum(min(abs(level), 15) for level in around)
            if k < last - 1 and not coder.bit(self.N[PLACE[u][v]][min(total, 5)]):
                continue
            magnitude = 1
            if coder.bit(self.G[0 if k == 0 else 1 if k <= 2 else 2][min(total, 5)]):
                kind = 0 if k == 0 else 1 if total < 3 else 2 if total < 8 else 3
                magnitude = 2 + coder.magnitude(self.M[kind])
            levels[u][v] = -magnitude if coder.direct(1) else magnitude
        return levels

    def block(self, left, above):
        """5.3: (block, its levels)"""
        block = Block()
        left_mode, above_mode = (other.mode if other else MEAN for other in (left, above))
        left, above = left or above, above or left
        if left:
            last_class = (klass(left.last, LAST_ENDS) + klass(above.last, LAST_ENDS) + 1) >> 1
            activity_near = (left.activity + above.activity + 1) >> 1
        else:
            last_class, activity_near = 5, 2
        literal = 8 * self.coder.spent > self.allowed
        self.allowed += 512
        levels = None
        if not literal:
            cells = self.D[4 * left_mode + above_mode]
            high = self.coder.bit(cells[0])
            block.mode = 2 * high + self.coder.bit(cells[2 if high else 1])
            block.last = self.last(last_class)
        block.activity = activity_near
        if block.last:
            size = klass(block.last, (1, 5, 20))
            block.activity = self.unary(self.A[activity_near][size], 4)
            levels = self.levels(block.last)
        index = self.step + 4 * block.activity
        block.S = STEPS[index & 7] << (index >> 3)
        block.limit = (block.S + 128) >> 8
        return block, levels

    def reconstruct(self, block, levels, x, y):
        """5.5"""
        X = self.pixels[y - 1][x:x + BLOCK] if y else None
        Y = [row[x - 1] for row in self.pixels[y:y + BLOCK]] if x else None
        if X is None and Y is None:
            X = Y = [128] * BLOCK
        X, Y = X or [Y[0]] * BLOCK, Y or [X[0]] * BLOCK
        w = predict(block.mode, X, Y)
        for u in range(BLOCK if levels else 0):
            for v in range(BLOCK):
                q = levels[u][v]
                if q:
                    e = 0 if u == v == 0 else 1 if q > 0 else -1
                    w[u][v] += (clamp((8 * q + e) * block.S, -2**21, 2**21) * SCALE[u][v] + 2048) >> 12
        columns = zip(*[inverse(row) for row in w])
        for i, column in enumerate(columns):
            for j, value in enumerate(inverse(column)):
                self.pixels[y + j][x + i] = clamp((value + 32) >> 6, 0, 255)

    def smoothed(self, x, y):
        """5.6"""
        c = self.pixels[y][x]
        limit = self.blocks[y // BLOCK][x // BLOCK].limit
        total = 4
        for i, j in ((x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)):
            if 0 <= i < self.width and 0 <= j < self.height:
                most = limit if (i // BLOCK, j // BLOCK) == (x // BLOCK, y // BLOCK) else 4 * limit
                total += clamp(2 * (self.pixels[j][i] - c), -most, most)
        return c + (total >> 3)

    def decode(self):
        self.allowed = 2048
        for j in range(self.down):
            self.change_step()
            for i in range(self.across):
                left = self.blocks[j][i - 1] if i else None
                above = self.blocks[j - 1][i] if j else None
                block, levels = self.block(left, above)
                self.blocks[j].append(block)
                self.reconstruct(block, levels, BLOCK * i, BLOCK * j)
        return [[self.smoothed(x, y) for x in range(self.width)] for y in range(self.height)]


def decode_picture(data):
    """(decoder with the header's fields, rows of pixels)"""
    decoder = PictureDecoder(data)
    return decoder, decoder.decode()
