# SPDX-License-Identifier: Apache-2.0
"""Colours along any direction from those of some cameras at the same point, for codecs that keep colours of cameras."""
import numpy as np

NEAREST, SHARP = 4, 2   # the best of 3, 4, 8 and 1, 2 at the can's held-out cameras
CANDIDATES = 16         # cameras that are looked at for one wanted, by the angle from the middle of the object
CHUNK = 200000


class Blend:
    """The nearest cameras by angle, each by (1 / angle - 1 / that of the next)^SHARP (after the unstructured lumigraph)."""

    def __init__(self, scene, wanted, cameras, valid):
        """wanted: observations. cameras: numbers, [N] for all points or [P, L]; valid: [P, N], where there is a colour."""
        self.point, self.valid = wanted.point, valid
        self.slot, self.weight = np.empty((len(wanted), NEAREST), np.int32), np.empty((len(wanted), NEAREST), np.float32)
        centres = np.array([c.centre for c in scene.cameras])
        cameras, middle = np.asarray(cameras), scene.world.mean(0)
        groups = [(np.arange(len(wanted)), None)]
        if cameras.ndim == 1 and len(cameras) > CANDIDATES:
            away = centres - middle
            away /= np.linalg.norm(away, axis=1, keepdims=True)
            near = np.argsort(-(away @ away[cameras].T), axis=1)[:, :CANDIDATES]
            groups = [(np.flatnonzero(wanted.camera == c), near[c]) for c in np.unique(wanted.camera)]
        for rows, slots in groups:
            for low in range(0, len(rows), CHUNK):
                part = rows[low:low + CHUNK]
                chosen = slots if slots is not None else np.arange(cameras.shape[-1])
                there = centres[cameras[chosen]] if cameras.ndim == 1 else centres[cameras[wanted.point[part]]]
                found, self.weight[part] = nearest(scene, wanted, part, there, valid[wanted.point[part]][:, chosen])
                self.slot[part] = chosen[found]

    def colours(self, kept):
        """[O, 3] of colours [P, N, 3]."""
        out = np.zeros((len(self.point), 3), np.float32)
        for i in range(NEAREST):
            out += self.weight[:, i:i + 1] * kept[self.point, self.slot[:, i]]
        return out


def nearest(scene, wanted, rows, centres, valid):
    """(columns [O, NEAREST], weights) for some rows of `wanted`; centres [N, 3] or [O, N, 3]."""
    there = (centres - scene.world[wanted.point[rows]][:, None]).astype(np.float32)
    cosine = np.einsum("onc,oc->on", there, wanted.direction[rows]) / np.sqrt(np.einsum("onc,onc->on", there, there))
    cosine = np.where(valid, cosine, -2)
    cosine = np.pad(cosine, ((0, 0), (0, max(NEAREST + 1 - cosine.shape[1], 0))), constant_values=-2)
    best = np.argsort(-cosine, axis=1)[:, :NEAREST + 1]
    cosine = np.take_along_axis(cosine, best, 1)
    angle, seen = np.arccos(np.clip(cosine, -1, 1)) + 1e-4, cosine > -1.5
    farthest = np.where(seen, angle, 0).max(1, keepdims=True) * 1.0001 + 1e-3
    weight = (np.where(seen, np.maximum(1 / angle - 1 / farthest, 0), 0) ** SHARP)[:, :NEAREST]
    best = np.minimum(best[:, :NEAREST], centres.shape[-2] - 1)
    return best, weight / np.maximum(weight.sum(1, keepdims=True), 1e-12)
