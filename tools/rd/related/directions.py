# SPDX-License-Identifier: Apache-2.0
"""Discretisations of direction: square maps of the hemisphere, and the lumisphere on an octahedron."""
import numpy as np

EPSILON = 1e-12


def tangent_frames(normals):
    """[P, 3, 3]: rows tangent, bitangent, normal. The tangent lies in the plane of the normal and +z (+x near the poles)."""
    up = np.where(np.abs(normals[:, 2:]) < 0.95, [[0.0, 0, 1]], [[1.0, 0, 0]])
    tangent = np.cross(up, normals)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    return np.stack([tangent, np.cross(normals, tangent), normals], 1)


def local(frames, observations):
    """Directions in the frame of their point."""
    return np.einsum("oij,oj->oi", frames.astype(np.float32)[observations.point], observations.direction)


def reflected(normals, observations):
    """Directions mirrored at the surface."""
    n = normals.astype(np.float32)[observations.point]
    d = observations.direction
    return 2 * (n * d).sum(1, keepdims=True) * n - d


def hemisphere_to_square(directions):
    """[O, 2] in 0 .. 1: the equal-area disc of a hemisphere about +z, and the disc to a square (Shirley, Chiu 1997)."""
    x, y, z = directions.T
    radius = np.sqrt(np.maximum(1 - np.clip(z, 0, 1), 0))
    angle = np.arctan2(y, x)
    quarter = np.floor((angle + np.pi / 4) / (np.pi / 2)).astype(int) % 4      # 0: +x, 1: +y, 2: -x, 3: -y
    within = (angle - quarter * (np.pi / 2) + np.pi) % (2 * np.pi) - np.pi     # -pi/4 .. pi/4
    along, across = radius, radius * within / (np.pi / 4)
    a = np.choose(quarter, [along, -across, -along, across])
    b = np.choose(quarter, [across, along, -across, -along])
    return np.clip(np.stack([a, b], 1) / 2 + 0.5, 0, 1)


def map_corners(directions, side):
    """Bilinear samples of a map of side^2 cells: (cells [O, 4], shares [O, 4]); centres at + 0.5, edges repeated."""
    at = hemisphere_to_square(directions) * side - 0.5
    low = np.floor(at).astype(int)
    share = (at - low).astype(np.float32)
    column, row = ([np.clip(low[:, i] + k, 0, side - 1) for k in (0, 1)] for i in (0, 1))
    cells = np.stack([row[j] * side + column[i] for j in (0, 1) for i in (0, 1)], 1).astype(np.int32)
    parts = [(share[:, i], 1 - share[:, i]) for i in (0, 1)]
    return cells, np.stack([parts[0][1 - i] * parts[1][1 - j] for j in (0, 1) for i in (0, 1)], 1)


def looked_up(maps, points, corners):
    """Colours [O, C] of maps [P, cells, C] at (cells, shares)."""
    cells, shares = corners
    out = np.zeros((len(points), maps.shape[2]), np.float32)
    for i in range(cells.shape[1]):
        out += shares[:, i:i + 1] * maps[points, cells[:, i]]
    return out


def filled_maps(points, observations, directions, side):
    """Maps [P, side^2, 3]: a cell is the mean of what falls into it; cells without anything by push-pull."""
    at = np.minimum((hemisphere_to_square(directions) * side).astype(int), side - 1)
    cell = observations.point.astype(np.int64) * side * side + at[:, 1] * side + at[:, 0]
    size = points * side * side
    weight = np.bincount(cell, minlength=size).astype(np.float32)
    sums = np.stack([np.bincount(cell, observations.colour[:, c], size) for c in range(3)], 1).astype(np.float32)
    return push_pull(sums.reshape(points, side, side, 3), weight.reshape(points, side, side, 1)).reshape(points, side * side, 3)


def push_pull(sums, weight):
    """Means where there is a weight; else those of the coarser level."""
    mean = sums / np.maximum(weight, EPSILON)
    if sums.shape[1] == 1:
        return np.where(weight > 0, mean, 128)
    here = np.minimum(weight, 1)

    def coarser(v):
        return v[:, ::2, ::2] + v[:, 1::2, ::2] + v[:, ::2, 1::2] + v[:, 1::2, 1::2]
    below = push_pull(coarser(mean * here), coarser(here)).repeat(2, 1).repeat(2, 2)
    return np.where(weight > 0, mean, below)


class Lumisphere:
    """An octahedron whose edges are halved `splits` times, on the unit sphere: 258 vertices for three. Linear inside triangles."""

    def __init__(self, splits=3):
        self.n = n = 1 << splits
        keys = [(i, j, k) for i in range(-n, n + 1) for j in range(-n, n + 1) for k in range(-n, n + 1) if abs(i) + abs(j) + abs(k) == n]
        self.vertices = np.array(keys, float) / n
        self.vertices /= np.linalg.norm(self.vertices, axis=1, keepdims=True)
        self.number = np.full((2 * n + 1,) * 3, -1)
        self.number[tuple(np.array(keys).T + n)] = np.arange(len(keys))
        grid = np.array(keys)
        steps = np.array([s for s in np.ndindex(3, 3, 3)]) - 1
        steps = steps[np.abs(steps).sum(1) == 2]      # vertices that share an edge
        self.edges = np.array([(a, self.number[tuple(b + n)]) for a, key in enumerate(grid) for b in key + steps
                               if np.abs(b).max() <= n and self.number[tuple(b + n)] >= 0])
        self.degree = np.bincount(self.edges[:, 0], minlength=len(keys))

    def corners(self, directions):
        """(vertices [O, 3], shares [O, 3]) of the triangle that a direction meets."""
        n = self.n
        flat = directions / np.abs(directions).sum(1, keepdims=True) * n
        sign = np.where(flat < 0, -1, 1)
        flat = np.abs(flat)
        a, b = np.minimum(np.floor(flat[:, 0]), n).astype(int), np.minimum(np.floor(flat[:, 1]), n).astype(int)
        over = np.maximum(a + b - n, 0)                # rounding at an edge
        b -= over
        fa, fb = flat[:, 0] - a, flat[:, 1] - b
        upper = (fa + fb > 1) & (a + b <= n - 2)
        at = [(a + upper, b + upper), (a + 1, b), (a, b + 1)]
        shares = [np.where(upper, fa + fb - 1, 1 - fa - fb), np.where(upper, 1 - fb, fa), np.where(upper, 1 - fa, fb)]
        numbers = []
        for i, j in at:
            i, j = np.clip(i, 0, n), np.clip(j, 0, n)
            j = np.minimum(j, n - i)
            numbers.append(self.number[sign[:, 0] * i + n, sign[:, 1] * j + n, sign[:, 2] * (n - i - j) + n])
        shares = np.clip(np.stack(shares, 1), 0, 1).astype(np.float32)
        return np.stack(numbers, 1), shares / np.maximum(shares.sum(1, keepdims=True), 1e-6)

    def neighbour_mean(self, values):
        """Means over neighbours of values [V, ...]."""
        out = np.zeros_like(values)
        np.add.at(out, self.edges[:, 0], values[self.edges[:, 1]])
        return out / self.degree.reshape(-1, *[1] * (values.ndim - 1))
