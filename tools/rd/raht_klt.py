# SPDX-License-Identifier: Apache-2.0
"""RAHT-KLT as published: Sandri, de Queiroz, Chou, "Compression of plenoptic point clouds", TIP 28(3), 2019.

Per channel (Y, U, V) the N colours of a point are a vector; the N x N Karhunen-Loeve transform of the cloud's covariance is
sent; every plane that it gives is transformed by RAHT (de Queiroz, Chou 2016); one uniform step; adaptive run-length
Golomb-Rice coding (Malvar 2006), one plane after the other, coefficients by ascending depth. Details that we had no paper for,
and chose: the covariance is about the mean, matrices have 16 bits an entry, coefficients of a depth are in Morton order.
Geometry is not coded here."""
import numpy as np

BITS_OF_ENTRY = 16
YUV = np.array([[0.2126, 0.7152, 0.0722],
                [-0.2126 / 1.8556, -0.7152 / 1.8556, (1 - 0.0722) / 1.8556],
                [(1 - 0.2126) / 1.5748, -0.7152 / 1.5748, -0.0722 / 1.5748]])


def morton(positions):
    """Codes of positions [P, 3], x least significant."""
    codes = np.zeros(len(positions), np.uint64)
    for bit in range(21):
        for axis in range(3):
            codes |= ((positions[:, axis].astype(np.uint64) >> np.uint64(bit)) & np.uint64(1)) << np.uint64(3 * bit + axis)
    return codes


def merges(codes):
    """Steps of sorted distinct codes from the leaves to the root, each (rows of left nodes, rows of right ones, c, s), where a
    node's values stand in its first row."""
    rows, weights, codes = np.arange(len(codes)), np.ones(len(codes)), codes.copy()
    steps = []
    while len(rows) > 1:
        codes >>= np.uint64(1)
        left = np.flatnonzero(codes[:-1] == codes[1:])
        if not len(left):
            continue
        a, b = weights[left], weights[left + 1]
        steps.append((rows[left], rows[left + 1], np.sqrt(a / (a + b)), np.sqrt(b / (a + b))))
        weights[left] += b
        rows, weights, codes = (np.delete(v, left + 1) for v in (rows, weights, codes))
    return steps


def raht(values, steps, inverse=False):
    """The transform of values [P, planes], in place. Forward: of the two of a node the sum stays in the left row."""
    for left, right, c, s in reversed(steps) if inverse else steps:
        a, b = values[left], values[right]
        c, s = c[:, None].astype(values.dtype), s[:, None].astype(values.dtype)
        values[left], values[right] = (c * a - s * b, s * a + c * b) if inverse else (c * a + s * b, c * b - s * a)
    return values


def coding_order(count, steps):
    """Rows from the root to the leaves."""
    root = steps[-1][0] if steps else np.zeros(count, int)
    return np.concatenate([root[:1]] + [right for _, right, _, _ in reversed(steps)])


class Rlgr:
    """Bits of adaptive run-length Golomb-Rice coding; the decoder needs nothing beside them."""
    L, UP_0, DOWN_0, UP_1, DOWN_1, TOP = 4, 3, 5, 2, 3, 80

    def __init__(self):
        self.kp, self.krp, self.bits = 2, 2 * self.L, 0

    def rice(self, u):
        k = self.krp // self.L
        p = u >> k
        self.bits += (p + 1 + k) if p < 32 else 32 + 32
        if p == 0:
            self.krp = max(self.krp - 2, 0)
        elif p > 1:
            self.krp = min(self.krp + p + 1, self.TOP)

    def zeros(self, count, ends):
        """A stretch of zeros, with a value after it or not."""
        while count and self.kp < self.L:          # no runs: each is a value
            self.rice(0)
            self.kp = min(self.kp + self.UP_0, self.TOP)
            count -= 1
        while self.kp >= self.L:
            k = self.kp // self.L
            if count < 1 << k:
                break
            self.bits += 1
            count -= 1 << k
            self.kp = min(self.kp + self.UP_1, self.TOP)
        if self.kp >= self.L and (count or ends):  # the run is broken
            self.bits += 1 + self.kp // self.L

    def value(self, v):
        u = 2 * v - 1 if v > 0 else -2 * v
        if self.kp < self.L:
            self.rice(u)
            self.kp = max(self.kp - self.DOWN_0, 0)
        else:                                       # after a run: a sign, and what is above 1
            self.bits += 1
            self.rice(abs(v) - 1)
            self.kp = max(self.kp - self.DOWN_1, 0)

    def code(self, values):
        places = np.flatnonzero(values)
        gaps = np.diff(places, prepend=-1) - 1
        for gap, v in zip(gaps.tolist(), values[places].tolist()):
            self.zeros(gap, True)
            self.value(v)
        left = len(values) - (places[-1] + 1 if len(places) else 0)
        self.zeros(int(left), False)
        return self.bits


class RahtKlt:
    """Prepared for one cloud: colours [P, N, 3] of positions [P, 3]."""

    def __init__(self, positions, colours):
        codes = morton(positions)
        self.order = np.argsort(codes)
        self.steps = merges(codes[self.order])
        self.points, self.views = colours.shape[:2]
        yuv = np.einsum("cd,pnd->pnc", YUV.astype(np.float32), colours[self.order].astype(np.float32))
        self.matrices = []
        planes = np.empty((3, self.points, self.views), np.float32)
        for c in range(3):
            matrix = np.linalg.eigh(np.cov(yuv[:, :, c].astype(np.float64).T))[1][:, ::-1]
            half = 1 << (BITS_OF_ENTRY - 1)
            matrix = np.round(matrix * (half - 1)) / (half - 1)
            self.matrices.append(matrix)
            planes[c] = yuv[:, :, c] @ matrix.astype(np.float32)
        self.planes = [raht(p, self.steps) for p in planes]
        self.rows = coding_order(self.points, self.steps)

    def coded(self, step, count_bits=True):
        """Bits, and the colours of a decoder, [P, N, 3] bytes in the order they were given. step 0: no quantiser."""
        bits = 3 * self.views ** 2 * BITS_OF_ENTRY
        back = np.empty((self.points, self.views, 3), np.float32)
        for c in range(3):
            values = self.planes[c].copy()
            if step > 0:
                quantised = np.rint(values / step).astype(np.int32)
                if count_bits:
                    bits += sum(Rlgr().code(quantised[self.rows, k]) for k in range(self.views))
                values = (quantised * np.float32(step)).astype(np.float32)
            matrix = np.linalg.inv(self.matrices[c]).astype(np.float32)
            back[:, :, c] = raht(values, self.steps, inverse=True) @ matrix
        rgb = np.einsum("cd,pnd->pnc", np.linalg.inv(YUV).astype(np.float32), back)
        out = np.empty((self.points, self.views, 3), np.uint8)
        out[self.order] = np.clip(np.rint(rgb), 0, 255)
        return bits, out
