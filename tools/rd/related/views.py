# SPDX-License-Identifier: Apache-2.0
"""Codecs that keep the colours that cameras saw at the points: layers of textures, and RAHT-KLT of the cameras' planes."""
import numpy as np

from blend import Blend
from planes import to_opponent, to_rgb


def colours_of_cameras(scene, seen=None):
    """([P, N, 3], [P, N] seen): a column for each fitted camera."""
    seen, column = seen or scene.fitted, np.zeros(len(scene.cameras), int)
    column[scene.fitted_cameras] = np.arange(len(scene.fitted_cameras))
    shape = len(scene.positions), len(scene.fitted_cameras)
    colours, valid = np.zeros((*shape, 3), np.float32), np.zeros(shape, bool)
    colours[seen.point, column[seen.camera]] = seen.colour
    valid[seen.point, column[seen.camera]] = True
    return colours, valid


class Volino:
    """Volino, Casas, Collomosse, Hilton 2014, "Optimal representation of multi-view video": layers of textures.

    Layer i has at each point the colour of its i-th best camera; a view blends the layers by angle (`Blend`). Best is the
    camera that sees a point most frontally (`frontal`, as published), or the farthest from those chosen before, which start with
    that one (`spread`). A decoder knows the cameras and what they see, so that the choice costs nothing. Layers are planes on the
    points (RAHT), transformed across layers by `slf pack --klt functions`, where theirs are video."""
    MOST = 8

    def __init__(self, scene, packer, way="frontal"):
        self.name, self.packer, self.scene = f"Volino, {way}", packer, scene
        self.colours, self.seen = colours_of_cameras(scene)
        direction = np.array([scene.cameras[c].centre for c in scene.fitted_cameras], np.float32)[None] - scene.world.astype(np.float32)[:, None]
        direction /= np.linalg.norm(direction, axis=2, keepdims=True)
        frontal = np.where(self.seen, np.einsum("pnc,pc->pn", direction, scene.normals.astype(np.float32)), -2)
        if way == "frontal":
            self.best = np.argsort(-frontal, axis=1)[:, :self.MOST]
        else:
            self.best = spread_out(direction, frontal, min(self.MOST, self.seen.shape[1]))
        self.valid = np.take_along_axis(self.seen, self.best, 1)
        mean = self.colours.sum(1) / np.maximum(self.seen.sum(1), 1)[:, None]
        self.layers = np.where(self.valid[:, :, None], np.take_along_axis(self.colours, self.best[:, :, None], 1), mean[:, None])
        self.colours = self.seen = None
        self.blends = {}

    def coded(self, step, layers):
        if layers not in self.blends:
            cameras = np.array(self.scene.fitted_cameras)[self.best[:, :layers]]
            self.blends = {layers: {s: Blend(self.scene, s, cameras, self.valid[:, :layers])
                                    for s in (self.scene.fitted, self.scene.held_out)}}
        size, kept = self.packer.pack(to_opponent(self.layers[:, :layers]), step, "functions" if layers > 1 else "off")
        return size, lambda seen: self.blends[layers][seen].colours(to_rgb(kept))


def spread_out(direction, frontal, count):
    """[P, count] cameras: the most frontal one, then always the one with the largest angle to the nearest chosen."""
    chosen = [frontal.argmax(1)]
    nearest = np.full(frontal.shape, -1, np.float32)
    for _ in range(count - 1):
        last = np.take_along_axis(direction, chosen[-1][:, None, None], 1)
        nearest = np.maximum(nearest, np.einsum("pnc,pkc->pn", direction, last))
        chosen.append(np.where(frontal > -2, nearest, 2).argmin(1))
    return np.stack(chosen, 1)


class RahtKlt:
    """Sandri, de Queiroz, Chou 2019, of as many views as cameras were fitted: per channel a KLT across cameras, RAHT of its planes.

    What a camera does not see is filled by the point's mean, then three times by the projection on the `FILL` strongest
    vectors. Planes below half a step in the root of their mean square are left out; a vector that is kept takes 10 bits an entry."""
    name, FILL, BITS = "RAHT-KLT", 12, 10

    def __init__(self, scene, packer):
        self.packer, self.scene = packer, scene
        colours, seen = colours_of_cameras(scene)
        self.columns = np.zeros(len(scene.cameras), int)
        self.columns[scene.fitted_cameras] = np.arange(len(scene.fitted_cameras))
        self.blend = Blend(scene, scene.held_out, scene.fitted_cameras, seen)
        colours = to_opponent(colours)
        self.channels = [self.transformed(colours[:, :, c], seen) for c in range(3)]

    def transformed(self, values, seen):
        """(mean [N], vectors [N, N] by descending variance, coefficients [P, N])."""
        own = (values * seen).sum(1) / np.maximum(seen.sum(1), 1)
        full = np.where(seen, values, own[:, None])
        for sweep in range(4):
            mean = full.mean(0)
            centred = full - mean
            vectors = np.linalg.eigh((centred.T @ centred).astype(np.float64))[1][:, ::-1].astype(np.float32)
            if sweep < 3:
                some = vectors[:, :self.FILL]
                full = np.where(seen, values, mean + (centred @ some) @ some.T)
        scale = (1 << (self.BITS - 1)) - 1
        vectors = np.round(vectors * scale) / scale
        return mean, vectors, np.linalg.solve(vectors.T @ vectors + 1e-6 * np.eye(len(vectors)), vectors.T @ centred.T).T.astype(np.float32)

    def coded(self, step):
        kept = [int(((values ** 2).mean(0) > step ** 2 / 4).sum()) for _, _, values in self.channels]
        planes = np.zeros((len(self.scene.positions), max(max(kept), 1), 3), np.float32)
        for c, (_, _, values) in enumerate(self.channels):
            planes[:, :kept[c], c] = values[:, :kept[c]]
        size, planes = self.packer.pack(planes, step)
        cameras = len(self.scene.fitted_cameras)
        size += sum(kept) * cameras * self.BITS / 8 + 3 * cameras
        back = np.stack([mean + planes[:, :n, c] @ vectors[:, :n].T
                         for c, ((mean, vectors, _), n) in enumerate(zip(self.channels, kept))], 2)
        back = to_rgb(back.astype(np.float32))

        def colours(seen):
            if seen is self.scene.fitted:
                return back[seen.point, self.columns[seen.camera]]
            return self.blend.colours(back)
        return size, colours
