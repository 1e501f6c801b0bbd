# SPDX-License-Identifier: Apache-2.0
"""Miller, Rubin, Ponceleon 1998, "Lazy decompression of surface light fields": view maps as images, block by block a DCT.

A map of SIDE x SIDE covers the hemisphere about a point's normal (equal area). A cell is the mean of what cameras saw in it, holes
are filled from coarser cells, a decoder looks up bilinearly. 8 x 8 blocks, an orthonormal DCT, one step (the measure is squared
error). Two ways of coding the same coefficients: each point by itself, its magnitudes in contexts of the point
before it (as published), or each coefficient as a plane on the points by our RAHT (`spatial`)."""
import numpy as np

from directions import filled_maps, local, looked_up, map_corners, tangent_frames
from entropy import bits_of, magnitude_class
from planes import to_opponent, to_rgb

BLOCK = 8


def dct_matrix(n):
    k, x = np.arange(n)[:, None], np.arange(n)[None, :]
    matrix = np.sqrt(2 / n) * np.cos(np.pi * (2 * x + 1) * k / (2 * n))
    matrix[0] /= np.sqrt(2)
    return matrix.astype(np.float32)


def transform(maps, side, inverse=False):
    """Coefficients [P, blocks * 64, C] of maps [P, side^2, C], or back."""
    n, count, channels = side // BLOCK, len(maps), maps.shape[2]
    d = dct_matrix(BLOCK)
    if inverse:
        blocks = maps.reshape(count, n, n, BLOCK, BLOCK, channels)
        return np.einsum("ku,lv,pabklc->paubvc", d, d, blocks, optimize=True).reshape(count, side * side, channels)
    blocks = maps.reshape(count, n, BLOCK, n, BLOCK, channels)
    return np.einsum("ku,lv,paubvc->pabklc", d, d, blocks, optimize=True).reshape(count, side * side, channels)


class Miller:
    name = "Miller"

    def __init__(self, scene, packer, side=8, spatial=False):
        self.packer, self.side, self.spatial, self.points = packer, side, spatial, len(scene.positions)
        frames = tangent_frames(scene.normals)
        self.corners = {s: map_corners(local(frames, s), side) for s in (scene.fitted, scene.held_out)}
        maps = filled_maps(self.points, scene.fitted, local(frames, scene.fitted), side)
        self.coefficients = transform(to_opponent(maps), side)

    def coded(self, step):
        """(bytes, colours of a set of observations)."""
        if self.spatial:
            size, kept = self.packer.pack(self.coefficients, step)
        else:
            integers = np.rint(self.coefficients / max(step, 1e-3)).astype(np.int32)
            size, kept = self.alone(integers) / 8, integers * np.float32(max(step, 1e-3))
        maps = to_rgb(transform(kept, self.side, inverse=True))
        return size, lambda seen: looked_up(maps, seen.point, self.corners[seen])

    def alone(self, integers):
        """Bits: of the first coefficient of a block the difference to the point before. Points are in Morton order."""
        before = np.zeros_like(integers)
        before[1:] = integers[:-1]
        first = np.zeros(integers.shape[1], bool)
        first[::BLOCK * BLOCK] = True
        values = np.where(first[None, :, None], integers - before, integers)
        coefficient = np.tile((np.arange(integers.shape[1]) % (BLOCK * BLOCK))[None, :, None], (self.points, 1, 3))
        channel = np.arange(3)[None, None, :]
        past = np.zeros_like(integers)
        past[1:] = values[:-1]
        return bits_of(values, (coefficient * 3 + channel) * 5 + magnitude_class(past))
