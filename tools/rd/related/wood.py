# SPDX-License-Identifier: Apache-2.0
"""Wood et al. 2000, "Surface light fields for 3D photography": lumispheres on 258 directions, reflected at the surface, less a median.

Observations count at the three vertices of their triangle by their shares, so that a point has a weight and a mean at every vertex.
The paper's pairs of a median and a residual: the median colour of a point is a plane (RAHT), the rest is either one of K prototypes
(`Quantised`: function quantisation, entropy-constrained) or a sum of q (`Principal`: principal functions, alternating least
squares). Bases are fitted to decoded medians."""
import numpy as np

from directions import Lumisphere, reflected
from entropy import bits_of, index_bits
from planes import to_opponent, to_rgb

SMOOTH = 0.3          # share of the mean number of observations of a vertex: pull to the mean of its neighbours
SWEEPS = 6
PROTOTYPE_STEP = 4    # grey levels


def medians(points, seen):
    """[P, 3], channel by channel; 128 where nothing is seen."""
    out = np.full((points, 3), 128, np.float32)
    count = np.bincount(seen.point, minlength=points)
    first = np.cumsum(count) - count
    for c in range(3):
        values = seen.colour[np.lexsort((seen.colour[:, c], seen.point)), c]
        some = count > 0
        at = first[some] + count[some] // 2
        out[some, c] = values[at]
    return out


class Lumispheres:
    """Weights [P, V] and sums [P, V * 3] of residuals, and how to look a lumisphere up."""

    def __init__(self, scene):
        self.scene, self.sphere, self.points = scene, Lumisphere(), len(scene.positions)
        self.count = len(self.sphere.vertices)
        self.corners = {s: self.sphere.corners(reflected(scene.normals, s)) for s in (scene.fitted, scene.held_out)}
        vertices, shares = self.corners[scene.fitted]
        self.cell = scene.fitted.point.astype(np.int64)[:, None] * self.count + vertices
        self.weights = self.gathered(shares)
        self.median = medians(self.points, scene.fitted)

    def gathered(self, values):
        out = np.zeros(self.points * self.count, np.float32)
        for i in range(3):
            out += np.bincount(self.cell[:, i], values[:, i], len(out)).astype(np.float32)
        return out.reshape(self.points, self.count)

    def residuals(self, median):
        """Sums over observations of share times colour less median: [P, V * 3]."""
        seen, (_, shares) = self.scene.fitted, self.corners[self.scene.fitted]
        rest = seen.colour - median[seen.point]
        return np.stack([self.gathered(shares * rest[:, c:c + 1]) for c in range(3)], 2).reshape(self.points, -1)

    def sampled(self, seen, functions, weights):
        """Sum over k of weights[p, k] * functions[k] along observations; functions [K, V, 3], weights [P, K]."""
        vertices, shares = self.corners[seen]
        out = np.zeros((len(seen), 3), np.float32)
        for k in range(len(functions)):
            value = sum(shares[:, i:i + 1] * functions[k][vertices[:, i]] for i in range(3))
            out += weights[seen.point, k][:, None] * value
        return out

    def smoothed(self, function, total):
        """The least squares of sums [V, 3] and weights [V] that lean on their neighbours."""
        pull = SMOOTH * max(float(total.mean()), 1e-6)
        value = function / np.maximum(total, 1e-6)[:, None] * (total > 0)[:, None]
        for _ in range(20):
            value = (function + pull * self.sphere.neighbour_mean(value)) / (total[:, None] + pull)
        return value.astype(np.float32)


def basis_bits(functions, step, sphere):
    """(bits, decoded) of [K, V, 3]: in order of the vertices, each less the one before, per channel and function."""
    integers = np.rint(functions / step).astype(np.int32)
    change = np.diff(integers, axis=1, prepend=0)
    context = np.broadcast_to(np.arange(3)[None, None, :], change.shape)
    return bits_of(change, context), (integers * step).astype(np.float32)


class Quantised:
    name = "Wood, function quantisation"

    def __init__(self, scene, packer, lumispheres=None):
        self.packer, self.of = packer, lumispheres or Lumispheres(scene)
        before = np.arange(self.of.points)
        self.neighbours = np.stack([np.maximum(before - k, 0) for k in (1, 2, 3)], 1)

    def coded(self, step, prototypes):
        size, kept = self.packer.pack(to_opponent(self.of.median)[:, None], step)
        median = to_rgb(kept[:, 0])
        sums, weights = self.of.residuals(median), self.of.weights
        index, functions = self.trained(sums, weights, prototypes, 0.35 * step ** 2)
        bits, functions = basis_bits(functions, PROTOTYPE_STEP, self.of.sphere)
        bits += index_bits(index, index[self.neighbours], prototypes)

        def colours(seen):
            vertices, shares = self.of.corners[seen]
            mine = index[seen.point]
            return median[seen.point] + sum(shares[:, i:i + 1] * functions[mine, vertices[:, i]] for i in range(3))
        return size + bits / 8, colours

    def trained(self, sums, weights, prototypes, price):
        """Entropy-constrained: sum of w |residual - prototype|^2 + price * bits of the index. Starts from points at even steps."""
        start = np.linspace(0, self.of.points - 1, prototypes).astype(int)
        functions = np.stack([self.of.smoothed(sums[p:p + 64].sum(0).reshape(-1, 3), weights[p:p + 64].sum(0)) for p in start])
        functions[0] = 0
        bits = np.full(prototypes, np.log2(prototypes))
        for _ in range(SWEEPS):
            flat = functions.reshape(prototypes, -1)
            cost = weights @ (functions ** 2).sum(2).T - 2 * (sums @ flat.T) + (price * bits).astype(np.float32)
            index = cost.argmin(1)
            used = np.bincount(index, minlength=prototypes)
            bits = -np.log2((used + 0.5) / (used.sum() + 0.5 * prototypes))
            order = np.argsort(index, kind="stable")
            edges = np.flatnonzero(np.diff(index[order], prepend=-1))
            for k, s, w in zip(index[order][edges], np.add.reduceat(sums[order], edges), np.add.reduceat(weights[order], edges)):
                functions[k] = self.of.smoothed(s.reshape(-1, 3), w)
        return index, functions


class Principal:
    name = "Wood, principal functions"

    def __init__(self, scene, packer, lumispheres=None):
        self.packer, self.of = packer, lumispheres or Lumispheres(scene)

    def coded(self, step, count):
        size, kept = self.packer.pack(to_opponent(self.of.median)[:, None], step)
        median = to_rgb(kept[:, 0])
        sums = self.of.residuals(median)
        functions, weights = self.trained(sums, self.of.weights, count)
        bits, functions = basis_bits(functions, 1 / 32, self.of.sphere)
        weights = self.solved(sums, self.of.weights, functions)
        more, weights = self.packer.pack_scalars(weights, step)
        return size + more + bits / 8, lambda seen: median[seen.point] + self.of.sampled(seen, functions, weights)

    def trained(self, sums, weights, count):
        """Functions [K, V, 3] of mean square 1, from random ones, and weights [P, K]."""
        functions = np.random.default_rng(1).normal(size=(count, self.of.count, 3)).astype(np.float32)
        for _ in range(SWEEPS):
            a = self.solved(sums, weights, functions)
            normal = np.einsum("pv,pi,pj->vij", weights, a, a, optimize=True)
            right = (sums.T @ a).reshape(self.of.count, 3, count)
            pull = SMOOTH * normal.mean(0) + 1e-3 * np.eye(count)
            for _ in range(5):
                lean = np.einsum("ij,vcj->vci", pull, self.of.sphere.neighbour_mean(functions.transpose(1, 2, 0)))
                functions = np.linalg.solve(normal[:, None] + pull, (right + lean)[..., None])[..., 0].transpose(2, 0, 1).astype(np.float32)
            flat = np.linalg.svd(functions.reshape(count, -1), full_matrices=False)[2]
            functions = (flat * np.sqrt(flat.shape[1])).reshape(functions.shape).astype(np.float32)
        return functions, self.solved(sums, weights, functions)

    def solved(self, sums, weights, functions, ridge=2.0):
        """Weights [P, K] by least squares; the ridge is in observations."""
        count = len(functions)
        outer = np.einsum("ivc,jvc->vij", functions, functions).reshape(self.of.count, -1)
        normal = (weights @ outer).reshape(-1, count, count) + ridge * np.eye(count, dtype=np.float32)
        return np.linalg.solve(normal, (sums @ functions.reshape(count, -1).T)[..., None])[..., 0].astype(np.float32)
