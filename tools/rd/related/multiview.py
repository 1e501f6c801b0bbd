# SPDX-License-Identifier: Apache-2.0
"""Magnor, Girod 2000, "Data compression for light-field rendering", on free cameras: photographs, each predicted from decoded ones.

Cameras are coded in a walk, always the one nearest to those before. Where the geometry covers a pixel, its place in the world is
looked up in the up to four nearest decoded photographs that see it; their colours, weighted by angle, predict it. Blocks of
SIZE x SIZE that show the object are coded: the difference to the prediction or, where that leaves more energy, to the background
or to the prediction's mean; DCT, one step with a dead zone, magnitudes in contexts of frequency and of the coefficients before.
Blocks without a surface cost nothing: a decoder draws the background's colour. Held-out colours are blended (`Blend`), or
those of our fit to the decoded photographs (refit.py)."""
import numpy as np

from blend import Blend
from entropy import adaptive_bits, bits_of, magnitude_class
from miller import dct_matrix
from observations import bilinear
from planes import to_opponent, to_rgb
from views import colours_of_cameras

REFERENCES = 4
ROUNDING = 0.35         # of a step: dead zone
COST = 1, 1.2, 1.2      # of the energy that is left: predicted, background, mean of the prediction
REACH = 2               # pixels about the surface that are coded, for bilinear samples at its edge


class Surface:
    """What a camera sees of the points: places in the world for each pixel, and which pixels have one."""

    def __init__(self, scene, number):
        camera, self.buffer = scene.cameras[number], scene.buffers[number]
        self.camera, width, height = camera, camera.width, camera.height
        u, v, z = camera.project(scene.occluders)
        seen = (z > 0) & (u >= 0) & (u < width) & (v >= 0) & (v < height)
        u, v, z = u[seen], v[seen], z[seen]
        seen = ~self.buffer.hides(u, v, z, np.full(len(z), 0.7))
        u, v, z = u[seen], v[seen], z[seen]
        apart = scene.spacing * self.buffer.focal / np.median(z)      # of points, in pixels
        reach = int(np.ceil(max(1.0, 1.5 * apart)))
        sums, weights, covered = np.zeros(width * height), np.zeros(width * height), np.zeros(width * height, bool)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                x, y = np.floor(u).astype(int) + dx, np.floor(v).astype(int) + dy
                inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
                square = ((x + 0.5 - u) ** 2 + (y + 0.5 - v) ** 2)[inside]
                near, at = np.exp(-square / (0.3 * reach ** 2)), (y * width + x)[inside]
                covered[at[square <= max(0.5, (0.7 * apart) ** 2)]] = True
                sums += np.bincount(at, near / z[inside], width * height)
                weights += np.bincount(at, near, width * height)
        self.covered = covered.reshape(height, width)
        self.rows, self.columns = np.nonzero(self.covered)
        depth = (weights / np.maximum(sums, 1e-12)).reshape(height, width)[self.covered]
        x = (self.columns + 0.5 - camera.k[0, 2]) / camera.k[0, 0] * depth
        y = (self.rows + 0.5 - camera.k[1, 2]) / camera.k[1, 1] * depth
        self.world = (np.stack([x, y, depth], 1) - camera.translation) @ camera.rotation

    def predicted(self, references):
        """(picture [H, W, 3], known [H, W]) from (surface, decoded picture) of others."""
        shape = self.camera.height, self.camera.width
        sums, weights = np.zeros((len(self.world), 3), np.float32), np.zeros(len(self.world), np.float32)
        to_eye = self.camera.centre - self.world
        to_eye /= np.linalg.norm(to_eye, axis=1, keepdims=True)
        for other, picture in references:
            there = other.camera.centre - self.world
            there /= np.linalg.norm(there, axis=1, keepdims=True)
            u, v, z = other.camera.project(self.world)
            seen = (z > 0) & (u >= 0) & (u < other.camera.width) & (v >= 0) & (v < other.camera.height)
            at = np.flatnonzero(seen)
            at = at[~other.buffer.hides(u[at], v[at], z[at], np.full(len(at), 0.7))]
            weight = 1 / (np.arccos(np.clip((there * to_eye).sum(1)[at], -1, 1)) + 1e-2) ** 2
            sums[at] += weight[:, None].astype(np.float32) * bilinear(picture, u[at], v[at])
            weights[at] += weight
        known, out = np.zeros(shape, bool), np.zeros((*shape, 3), np.float32)
        known[self.rows, self.columns] = weights > 0
        out[self.rows, self.columns] = sums / np.maximum(weights, 1e-12)[:, None]
        return out, known


def walk(cameras, middle):
    """Order of cameras, and for each its nearest earlier ones, the nearest first."""
    away = np.array([c.centre for c in cameras]) - middle
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    cosine = away @ away.T
    order, near = [0], [[]]
    while len(order) < len(cameras):
        left = [c for c in range(len(cameras)) if c not in order]
        best = max(left, key=lambda c: cosine[c, order].max())
        near.append(sorted(order, key=lambda c: -cosine[best, c])[:REFERENCES])
        order.append(best)
    return order, near


def grown(mask, reach):
    for _ in range(reach):
        wide = np.pad(mask, 1)
        mask = wide[1:-1, 1:-1] | wide[:-2, 1:-1] | wide[2:, 1:-1] | wide[1:-1, :-2] | wide[1:-1, 2:]
    return mask


def blocks_of(picture, size):
    """[rows, columns, size, size, C], edges repeated to whole blocks."""
    height, width = picture.shape[:2]
    padded = np.pad(picture, ((0, -height % size), (0, -width % size), *[(0, 0)] * (picture.ndim - 2)), mode="edge")
    h, w = padded.shape[0] // size, padded.shape[1] // size
    return np.moveaxis(padded.reshape(h, size, w, size, -1), 2, 1)


class Multiview:
    name = "multi-view, predicted"

    def __init__(self, scene, packer=None):
        self.scene, numbers = scene, scene.fitted_cameras
        self.order, self.near = walk([scene.cameras[n] for n in numbers], scene.world.mean(0))
        self.surfaces = [Surface(scene, n) for n in numbers]
        self.photographs = [scene.cameras[n].photograph().astype(np.float32) for n in numbers]
        self.blend, self.decoded = None, {}

    def coded(self, step, size):
        """One step for all coefficients, blocks of size^2."""
        decoded, parts = {}, []
        for here, near in zip(self.order, self.near):
            decoded[here], part = self.picture(here, [(self.surfaces[n], decoded[n]) for n in near], step, size)
            parts.append(part)
        bits = self.bits(parts, size) + 24 * len(self.order)
        numbers = self.scene.fitted_cameras

        self.decoded = {numbers[i]: p for i, p in decoded.items()}
        fitted = self.scene.fitted.with_colours(self.decoded)

        def colours(seen):
            if seen is self.scene.fitted:
                return fitted.colour
            kept, valid = colours_of_cameras(self.scene, fitted)
            self.blend = self.blend or Blend(self.scene, seen, numbers, valid)
            return self.blend.colours(kept)
        return bits / 8, colours

    def picture(self, number, references, step, size):
        """(decoded picture, (integers [B, size, size, 3], modes [B]))."""
        photograph, surface = self.photographs[number], self.surfaces[number]
        height, width = photograph.shape[:2]
        shown = grown(surface.covered, REACH)
        outside = photograph[~shown]
        background = np.round(np.median(outside, axis=0)) if len(outside) else np.full(3, 128.0)
        guess, known = surface.predicted(references)
        flat = guess[known].mean(0) if known.any() else background
        guess = np.where(known[..., None], guess, np.where(surface.covered[..., None], flat, background)).astype(np.float32)
        mask = blocks_of(shown, size)[..., 0]
        coded = mask.any((2, 3))
        there, mask = blocks_of(photograph, size)[coded], mask[coded][..., None]
        guesses = [np.broadcast_to(np.asarray(g, np.float32), there.shape) for g in (blocks_of(guess, size)[coded], background, flat)]
        rest = [to_opponent((there - g) * mask) for g in guesses]
        mode = np.argmin([COST[i] * (r ** 2).sum((1, 2, 3)) for i, r in enumerate(rest)], axis=0)
        rest, ahead = (np.choose(mode[:, None, None, None], some) for some in (rest, guesses))
        d = dct_matrix(size)
        values = np.einsum("ku,lv,nuvc->nklc", d, d, rest, optimize=True)
        integers = (np.sign(values) * np.floor(np.abs(values) / step + ROUNDING)).astype(np.int32)
        back = np.einsum("ku,lv,nklc->nuvc", d, d, (integers * step).astype(np.float32), optimize=True)
        result = np.clip(ahead + to_rgb(back), 0, 255)
        whole = blocks_of(guess, size).copy()
        whole[coded] = result
        whole = np.moveaxis(whole, 1, 2).reshape(whole.shape[0] * size, whole.shape[1] * size, 3)[:height, :width]
        return whole, (integers, mode)

    def bits(self, parts, size):
        """All pictures with one set of contexts."""
        integers, mode = (np.concatenate(p) for p in zip(*parts))
        empty = ~integers.any((1, 2))                               # [B, 3]
        before = np.concatenate([np.ones((1, 3), bool), empty[:-1]])
        context = np.arange(3) * 4 + before * 2 + np.concatenate([np.zeros((len(empty), 1), int), empty[:, :1]], 1)[:, [0, 1, 1]]
        total = adaptive_bits(empty.ravel().astype(float), context.ravel())
        total += bits_of(mode, np.zeros(len(mode), int)) - np.count_nonzero(mode)     # modes have no sign
        order = np.argsort([i + j for i in range(size) for j in range(size)], kind="stable")
        for c in range(3):
            flat = integers[:, :, :, c].reshape(len(integers), -1)[:, order][~empty[:, c]]
            past = np.pad(np.abs(flat), ((0, 0), (2, 0)))
            frequency = (np.arange(size)[:, None] + np.arange(size)[None, :]).ravel()[order]
            last = flat.shape[1] - np.argmax((flat != 0)[:, ::-1], axis=1)       # places up to the last that is not 0
            total += bits_of(last // (size // 4), np.zeros(len(last), int))
            sent = np.arange(flat.shape[1])[None, :] < (last // (size // 4) + 1)[:, None] * (size // 4)
            kind = np.minimum(frequency, 15)[None, :] * 5 + magnitude_class(past[:, 1:-1] + past[:, :-2])
            total += bits_of(flat[sent], kind[sent])
        return total
