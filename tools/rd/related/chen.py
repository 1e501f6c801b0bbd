# SPDX-License-Identifier: Apache-2.0
"""Chen et al. 2002, "Light field mapping": cell by cell and channel by channel, a sum of K products of a surface map and a view map.

Cells are nodes of the octree (theirs: the ring of triangles about a vertex, blended over it). The matrix of a cell is its points
by the 16 x 16 cells of the square of directions in the points' own frames, holes filled as Miller's are. `pca`: rank-1 terms by
SVD, in the opponent channels; `nmf`: non-negative factors by multiplicative updates, in R, G and B. A view map has a mean
square of 1, so that the surface map carries the grey levels: it is planes on the points (RAHT). View maps are coded by a DCT with
a step that makes an error of the size of the surface maps' (theirs: 8 bits, then vector quantisation)."""
import numpy as np

from directions import filled_maps, local, looked_up, map_corners, tangent_frames
from entropy import bits_of, magnitude_class
from miller import dct_matrix
from planes import to_opponent, to_rgb

SIDE = 16
MOST_TERMS = 5
NMF_SWEEPS = 100


def cells_of(positions, side):
    """Number of the cell of each point, 0 .. cells - 1."""
    return np.unique(positions // side, axis=0, return_inverse=True)[1].ravel()


def pca_terms(matrix, terms):
    """(surface [n, K], view [K, m]) of [n, m] by SVD."""
    u, s, v = np.linalg.svd(matrix, full_matrices=False)
    k = min(terms, len(s))
    return u[:, :k] * s[:k], v[:k]


def nmf_terms(matrix, terms):
    """The same, both non-negative: multiplicative updates (Lee, Seung 2001) from the SVD's parts of one sign (NNDSVD)."""
    matrix = np.maximum(matrix, 0)
    left, right = pca_terms(matrix, terms)
    surfaces, views = np.empty_like(left), np.empty_like(right)
    for k in range(left.shape[1]):
        parts = [(np.maximum(s * left[:, k], 0), np.maximum(s * right[k], 0)) for s in (1, -1)]
        surfaces[:, k], views[k] = max(parts, key=lambda p: np.linalg.norm(p[0]) * np.linalg.norm(p[1]))
    u, v = surfaces + 1e-3 * np.abs(left).mean(0), views + 1e-3 * np.abs(right).mean(1, keepdims=True)
    for _ in range(NMF_SWEEPS):
        u *= (matrix @ v.T) / np.maximum(u @ (v @ v.T), 1e-6)
        v *= (u.T @ matrix) / np.maximum((u.T @ u) @ v, 1e-6)
    return u, v


class Chen:
    def __init__(self, scene, packer, way="pca", cell=16, side=SIDE):
        self.name, self.packer, self.way, self.side, self.points = f"Chen, {way.upper()}", packer, way, side, len(scene.positions)
        frames = tangent_frames(scene.normals)
        self.corners = {s: map_corners(local(frames, s), side) for s in (scene.fitted, scene.held_out)}
        maps = filled_maps(self.points, scene.fitted, local(frames, scene.fitted), side)
        self.maps = to_opponent(maps) if way == "pca" else maps
        self.cell = cells_of(scene.positions, cell)
        order = np.argsort(self.cell, kind="stable")
        self.members = np.split(order, np.flatnonzero(np.diff(self.cell[order])) + 1)
        self.found = {}

    def factors(self, terms):
        """Surface maps [P, K, 3] and view maps [cells, K, side^2, 3]. PCA's first K terms are those of any larger K."""
        key = MOST_TERMS if self.way == "pca" else terms
        if key not in self.found:
            surface = np.zeros((self.points, key, 3), np.float32)
            view = np.zeros((len(self.members), key, self.side ** 2, 3), np.float32)
            make = pca_terms if self.way == "pca" else nmf_terms
            for i, some in enumerate(self.members):
                for c in range(3):
                    u, v = make(self.maps[some, :, c], key)
                    scale = np.sqrt((v ** 2).mean(1)) * np.where(v.sum(1) < 0, -1, 1)
                    scale = np.where(scale == 0, 1, scale)
                    surface[some, :u.shape[1], c], view[i, :u.shape[1], :, c] = u * scale, v / scale[:, None]
            self.found[key] = surface, view
        surface, view = self.found[key]
        return surface[:, :terms], view[:, :terms]

    def coded(self, step, terms):
        surface, view = self.factors(terms)
        size, kept = self.packer.pack(surface, step)
        strength = np.zeros((len(self.members), terms, 3), np.float32)
        np.add.at(strength, self.cell, kept ** 2)
        strength = np.sqrt(strength / np.bincount(self.cell)[:, None, None])
        bits, view = self.coded_views(view, step, strength)

        def colours(seen):
            out = np.zeros((len(seen), 3), np.float32)
            for k in range(terms):
                out += kept[seen.point, k] * looked_up(view[:, k], self.cell[seen.point], self.corners[seen])
            return to_rgb(out) if self.way == "pca" else out
        return size + bits / 8, colours

    def coded_views(self, view, step, strength):
        """(bits, decoded). The step of a view map, a power of two, comes from the decoded surface maps' root mean square `strength`."""
        d, n = dct_matrix(self.side), self.side
        tiles = view.reshape(*view.shape[:2], n, n, 3)
        coefficients = np.einsum("ku,lv,nmuvc->nmklc", d, d, tiles, optimize=True)
        steps = 2.0 ** np.round(np.log2(max(step, 1e-3) / np.maximum(strength, 1e-3)))[:, :, None, None, :]
        integers = np.where(strength[:, :, None, None, :] > 0, np.rint(coefficients / steps), 0).astype(np.int32)
        before = np.zeros_like(integers)
        before[1:] = integers[:-1]
        frequency = np.minimum(np.arange(n)[:, None] + np.arange(n)[None, :], 15)[None, None, :, :, None]
        term, channel = np.arange(view.shape[1])[None, :, None, None, None], np.arange(3)
        context = ((term * 3 + channel) * 16 + frequency) * 5 + magnitude_class(before)
        bits = bits_of(integers, np.broadcast_to(context, integers.shape))
        back = np.einsum("ku,lv,nmklc->nmuvc", d, d, (integers * steps).astype(np.float32), optimize=True)
        return bits, back.reshape(view.shape)
